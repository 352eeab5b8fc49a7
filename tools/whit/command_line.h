// CLI11 with this program's manners: exit code 2, one line, and a did-you-mean for misspelt flags.
#pragma once

#include <CLI/CLI.hpp>

#include "tools/whit/commands.h"

namespace whit {

/// Parses `args` into `app`. Returns true when the command should go on; otherwise `code` is what to exit with
/// (0 after --help, 2 after a mistake, which has been printed).
bool parse_arguments(CLI::App& app, const Arguments& args, int& code);

}  // namespace whit
