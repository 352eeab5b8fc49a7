// The names of all diagnostics: those of findings, and those of other warnings.
#pragma once

#include <string>
#include <vector>

#include "core/base/diagnostics.h"

namespace whit {

/// "error", "warning" or "note".
const char* severity_name(Severity severity);

/// What a diagnostic without a name of its own is called: "mistake", "file" or "warning".
const char* general_name(const Diagnostic& d);

/// The warnings that have a name and can be silenced, beside findings, each with a sentence.
struct NamedWarning {
  const char* name;
  const char* what;
};
const std::vector<NamedWarning>& named_warnings();

/// All names that can be allowed.
std::vector<std::string> names_that_can_be_allowed();

/// "" or why a name cannot be allowed.
std::string problem_of_allowing(const std::string& name);

}  // namespace whit
