// The figures of a picture that was made: what it took, and what decided that.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/json.h"
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

/// What a build consists of, in order.
std::vector<StartPart> build_parts(const BuildTimes& build);

/// What StepTimes::ready consists of, in order; what is missing in the sum are messages.
std::vector<StartPart> start_parts(const StepTimes& times, const BuildTimes& build);

/// What was asked for beside what scene and outcome tell.
struct PictureSettings {
  std::string scene;           ///< Its path, as it was given.
  std::string command;         ///< The command line.
  std::string version;         ///< The program's.
  std::string traversal;       ///< "robust" or "fast".
  std::string texture_filter;  ///< "": as each texture says.
  double texture_memory = 0;   ///< MiB of decoded textures at most.
  uint32_t seed = 0;
};

/// Seconds by step, rays by kind, textures, memory in bytes, and the settings: what --stats FILE.json has of a picture.
Json::Object picture_stats(const PictureSettings& asked, const RenderOutcome& outcome);

}  // namespace whit
