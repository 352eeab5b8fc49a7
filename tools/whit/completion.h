// Scripts with which shells complete `whit`'s commands, flags and their values.
#pragma once

#include <string>
#include <vector>

namespace whit {

/// "bash", "zsh" and "fish".
std::vector<std::string> shells();

/// The script for one of these.
std::string completion_script(const std::string& shell);

}  // namespace whit
