// `whit check --files`: the files that a scene would read and write.
#pragma once

#include <string>

#include "core/session/session.h"

namespace whit {

/// Prints them, one a line after "read" or "write", or as JSON; of models also what they name. Nothing but texts and models
/// is opened. What is wrong with the texts goes to stderr; returns the exit code.
int list_files(const std::string& scene, const ReadOptions& options, bool json);

}  // namespace whit
