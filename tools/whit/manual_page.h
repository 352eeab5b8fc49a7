// The manual page whit(1), from the tables behind --help.
#pragma once

#include <string>

namespace whit {

/// In the language of man(7).
std::string manual_page();

}  // namespace whit
