// What `whit render` says when a picture is done.
#pragma once

#include "core/render/render.h"
#include "core/scene/scene.h"
#include "core/session/output.h"

namespace whit {

/// What each step took.
struct StepTimes {
  Elapsed parse, plan, build, render, write;
};

/// A picture that was made, and what making it took.
struct RenderOutcome {
  const Scene& scene;
  const RenderResult& result;
  const OutputPlan& output;
  const TextureStore& textures;
  StepTimes times;
  size_t unread_files = 0;   ///< Files of objects that this world never places.
  double parsed_memory = 0;  ///< Resident after parsing, in bytes.
};

/// That there were samples without a valid radiance.
void report_invalid(const RenderStatistics& statistics);

/// The lines at the end of a render, with more figures if wanted (--stats).
void summarise(const RenderOutcome& outcome, bool with_statistics);

}  // namespace whit
