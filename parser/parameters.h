// The parameter list of a statement: `"float radius" 1 "rgb Kd" [ .5 .5 .5 ]`.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/parameter.h"
#include "parser/lexer.h"

namespace whit {

/// The type a scene file calls `name`, aliases included ("color" is Rgb, "point" is Point3).
std::optional<ParamType> find_param_type(std::string_view name);

/// All names of types that a scene file may use, aliases included.
std::vector<std::string> param_type_names();

/// How many numbers make one value of a type.
size_t numbers_a_value(ParamType type);

/// Reads parameters up to the first token that does not belong to the list. Texture names are kept unresolved.
/// A parameter with a mistake is reported and left out. False when the rest of the statement makes no sense
/// and reading has to resynchronise. Of duplicates the last is kept, with a warning if it differs.
bool read_parameters(Lexer& lexer, ParameterList& out);

/// Adds parameters to a list as if they stood behind it in the file.
void append_parameters(ParameterList& out, ParameterList&& more, Reporter& reporter);

}  // namespace whit
