#include "tools/whit/load.h"

#include <iostream>
#include <iterator>

namespace whit {

ParsedFile read_scene(const std::string& path, const ReadOptions& options) {
  if (!path.empty() && path != "-") return read_scene_file(path, options);
  return read_scene_text("<stdin>", std::string{std::istreambuf_iterator<char>(std::cin), {}}, options);
}

}  // namespace whit
