// The ray-cast floor of a scene: what a render costs beyond tracing its rays.
#pragma once

#include <array>
#include <string>

#include "core/accel/replay.h"
#include "core/scene/scene.h"
#include "tools/whit/spread.h"

namespace whit {

/// Rays of one kind, and bare Embree's best way of tracing them.
struct FloorOfKind {
  int64_t rays = 0;
  RayCall best_call = RayCall::Single;
  double seconds = 0;  ///< Median, on one thread.
};

struct Floor {
  std::array<FloorOfKind, 3> kinds;  ///< By RayKind.
  Spread ratio;                      ///< Seconds of the render loop over those of its rays, both on one thread.
};

/// Renders on one thread and traces the same rays again, `runs` times each in turns.
Floor measure_floor(const Scene& scene, int runs);

/// "single", "8", "16" or "16 coherent".
std::string call_name(RayCall call);

}  // namespace whit
