// Modules: libraries that are loaded when they are first needed, because linking or starting takes long with them.
#pragma once

#include <string>

namespace whit {

/// What the module NAME.so hands out under its own name. It lies beside the program, where the programs' run path points
/// (CMakeLists.txt). Throws std::runtime_error when it cannot be loaded.
const void* load_module(const std::string& name);

}  // namespace whit
