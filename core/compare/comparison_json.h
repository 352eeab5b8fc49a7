// A comparison as JSON.
#pragma once

#include "core/base/json.h"
#include "core/compare/comparison.h"
#include "core/compare/limits.h"

namespace whit {

/// {"same", "cannot", "failed", "measures", "where", "layers", "nonfinite", "nonfinite_count", "differing_pixels", "noise",
/// "limits", "windows", "notes"}: see docs/diff.md. A value that is infinite is null.
Json::Object to_json(const Comparison& comparison, const Limits& limits);

}  // namespace whit
