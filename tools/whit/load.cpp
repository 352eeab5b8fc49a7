#include "tools/whit/load.h"

#include <unistd.h>

#include <utility>

#include "parser/source.h"

namespace whit {

std::optional<std::string> read_standard_input(Diagnostics& said) {
  std::string problem;
  std::optional<std::string> text = read_pipe(STDIN_FILENO, problem);
  if (!text) said.file_error({}, "cannot read standard input: " + problem);
  return text;
}

ParsedFile read_scene(const std::string& path, const ReadOptions& options) {
  if (!path.empty() && path != "-") return read_scene_file(path, options);
  ParsedFile nothing;
  std::optional<std::string> text = read_standard_input(nothing.said);
  return text ? read_scene_text("<stdin>", std::move(*text), options) : std::move(nothing);
}

}  // namespace whit
