// `whit diff` of two folders.
#pragma once

#include "core/compare/policy.h"
#include "tools/whit/diff_flags.h"

namespace whit {

/// Compares, prints and writes what is asked for. Returns the exit code, by the worst: 0 the same, 1 some differ, 4 some
/// cannot be compared or are missing, or an output cannot be written. Pictures without a reference are named and change
/// nothing.
int diff_folders(const DiffFlags& flags, const Policy& policy);

}  // namespace whit
