// What may be wrong with the name of a file that cannot be opened.
#pragma once

#include <string>

namespace whit {

/// "" or a remedy, for a path with backslashes or with what a backslash and a letter stand for in a string.
std::string path_hint(const std::string& path);

}  // namespace whit
