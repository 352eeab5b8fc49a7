// The scene file that a command names.
#pragma once

#include <optional>
#include <string>

#include "core/session/session.h"

namespace whit {

/// Reads a file, or standard input where the path is "" or "-".
ParsedFile read_scene(const std::string& path, const ReadOptions& options = {});

/// All that comes through standard input; nothing, and an error, when it cannot be read or has no end.
std::optional<std::string> read_standard_input(Diagnostics& said);

}  // namespace whit
