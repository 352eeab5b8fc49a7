#include "core/base/path_hint.h"

#include <algorithm>

namespace whit {

std::string path_hint(const std::string& path) {
  const bool control = std::any_of(path.begin(), path.end(), [](char c) { return c >= 0 && c < ' '; });
  if (control) return "write / between folders: in a string \\b, \\f, \\n, \\r and \\t are control characters";
  if (path.find('\\') != std::string::npos) return "write / between folders, not a backslash";
  return {};
}

}  // namespace whit
