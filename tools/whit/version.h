// The program's version, which the build defines for version.cpp alone: all other files are compiled alike.
#pragma once

namespace whit {

/// "0.1.0"
const char* version();

}  // namespace whit
