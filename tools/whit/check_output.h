// What `whit check` found, for machines.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/base/diagnostics.h"
#include "parser/source.h"

namespace whit {

/// The diagnostics of one file that was checked, with the texts their places are in.
struct Checked {
  const Sources* sources;
  Diagnostics found;
};

/// {"diagnostics": [...], "errors": n, "warnings": n, "notes": n}
std::string check_as_json(const std::vector<Checked>& all);
/// The same as SARIF 2.1.0, which code reviews show.
std::string check_as_sarif(const std::vector<Checked>& all);

}  // namespace whit
