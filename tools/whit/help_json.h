// What `whit help --json` prints for machines: everything that can stand in a scene file, and the program's words.
#pragma once

#include <string>

namespace whit {

std::string help_json();

}  // namespace whit
