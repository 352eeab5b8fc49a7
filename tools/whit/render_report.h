// What `whit render` says when a picture is done.
#pragma once

#include <vector>

#include "core/render/render.h"
#include "core/scene/scene.h"
#include "core/session/output.h"

namespace whit {

/// What each step took. Steps that were taken before are nothing in the times of a second picture.
struct StepTimes {
  Elapsed program;  ///< From the start of the process to the start of the command: loading, mostly.
  Elapsed flags;    ///< Reading the command line.
  Elapsed parse, plan;
  Elapsed output;  ///< Where pictures go, and how light becomes display values.
  Elapsed build;
  Elapsed ready;  ///< All until rendering begins, measured as a whole.
  Elapsed render, write;
};

/// A part of StepTimes::ready.
struct StartPart {
  const char* key;    ///< In JSON.
  const char* words;  ///< "ray tracer built"
  Elapsed elapsed;
};

/// A picture that was made, and what making it took.
struct RenderOutcome {
  const Scene& scene;
  const RenderResult& result;
  const OutputPlan& output;
  const TextureStore& textures;
  StepTimes times;
  size_t unread_files = 0;     ///< Files of objects that this world never places.
  double parsed_memory = 0;    ///< Resident after parsing, in bytes.
  double memory_estimate = 0;  ///< At most in all, as it was told before (core/session/memory.h).
};

/// What StepTimes::ready consists of, in order; what is missing in the sum are messages.
std::vector<StartPart> start_parts(const StepTimes& times, const BuildTimes& build);

/// That there were samples without a valid radiance.
void report_invalid(const RenderStatistics& statistics);

/// The lines at the end of a render, with more figures if wanted (--stats).
void summarise(const RenderOutcome& outcome, bool with_statistics);

}  // namespace whit
