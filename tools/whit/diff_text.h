// A comparison in words, for people.
#pragma once

#include <string>

#include "core/compare/comparison.h"
#include "core/compare/limits.h"

namespace whit {

/// "same: ..." or "differs: ..." with the worst failure; the further failures and regions, what was made alike, and the limits
/// that were in force, each on a line of its own. `verbose`: a table of all measures, with their limits. `colour`: with escapes.
std::string diff_text(const Comparison& comparison, const Limits& limits, bool verbose, bool colour);

}  // namespace whit
