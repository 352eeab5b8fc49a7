// From a path to a planned scene: what render, check, explain and bench begin with.
#pragma once

#include <functional>
#include <string>

#include "core/scene/effect_plan.h"
#include "parser/parse.h"

namespace whit {

/// A parsed file (or standard input when the path is "" or "-"), with the time it took.
struct LoadedFile {
  ParseResult parsed;
  double parse_seconds = 0;
};
LoadedFile load_file(Sources& sources, const std::string& path, const ParseOptions& options = {});
LoadedFile load_text(Sources& sources, const std::string& name, std::string text, const ParseOptions& options = {});

/// One world of a file, bound and planned.
struct PlannedScene {
  BoundScene bound;
  EffectPlan plan;
  double seconds = 0;
};
PlannedScene plan_scene(const SceneDescription& description, const Sources& sources, Diagnostics& diagnostics,
                        const PlanOptions& options = {});

/// Everything wrong with a file: what parsing found, and what planning its worlds finds in addition, and what `further`
/// finds in each. For files with mistakes, where nothing else will be done with the worlds.
Diagnostics all_problems(const LoadedFile& file, const Sources& sources,
                         const std::function<Diagnostics(PlannedScene)>& further = {});

}  // namespace whit
