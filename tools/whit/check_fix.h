// `whit check --fix`: corrects in scene files what is beyond doubt.
#pragma once

#include <functional>
#include <string>

#include "core/base/diagnostics.h"
#include "core/session/session.h"

namespace whit {

/// Applies the corrections that diagnostics know of, until none is left: a correction may bring the next to light. `read`
/// reads the scene anew, `check` says what is wrong with it. Says on stderr what was changed. "" or why a file could not
/// be written; what was changed before stays.
std::string fix_slips(const std::function<ParsedFile()>& read,
                      const std::function<Diagnostics(const ParsedFile&)>& check);

}  // namespace whit
