// One scene file on its way to pictures.
#pragma once

#include <string>

#include "tools/whit/render_flags.h"
#include "tools/whit/render_stats.h"

namespace whit {

/// Parses, plans, builds, renders and writes, and reports after each. Returns the exit code.
int render_file(const RenderSettings& settings, const std::string& path, RenderStats& stats);

}  // namespace whit
