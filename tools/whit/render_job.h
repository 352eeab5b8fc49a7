// One scene file on its way to pictures.
#pragma once

#include <string>

#include "core/base/stopwatch.h"
#include "tools/whit/render_flags.h"
#include "tools/whit/render_stats.h"

namespace whit {

/// What there was before a scene's turn: loading the program and reading the flags, nothing for a second scene.
struct BeforeScene {
  Elapsed program, flags;
};

/// Parses, plans, builds, renders and writes, and reports after each. Returns the exit code.
int render_file(const RenderSettings& settings, const std::string& path, const BeforeScene& before, RenderStats& stats);

/// All scenes of the settings, which have been read: with their threads, limits and statistics. Returns the exit code.
int render_scenes(const RenderSettings& settings, BeforeScene before);

}  // namespace whit
