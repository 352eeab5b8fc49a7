// JSON as commands print it. Only json.cpp knows the library that writes it, which takes long to compile.
#pragma once

#include <string>

#include "core/base/json.h"

namespace whit {

/// One line for each value, with an indentation of one space. Bytes that are not UTF-8 are replaced.
std::string to_text(const Json& json);

}  // namespace whit
