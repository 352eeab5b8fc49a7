// The scene file that a command names.
#pragma once

#include <string>

#include "core/session/session.h"

namespace whit {

/// Reads a file, or standard input where the path is "" or "-".
ParsedFile read_scene(const std::string& path, const ReadOptions& options = {});

}  // namespace whit
