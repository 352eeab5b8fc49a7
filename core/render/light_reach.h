// Lights that leave all points of a round dark, known from where they shine, so that the round need not sample them.
#pragma once

#include <span>

#include "core/plugin/light_reach.h"
#include "core/render/worker.h"

namespace whit {

/// What is found out about the points of a round once, for all lights.
struct PointBounds {
  bool bounded = false;        ///< False when a coordinate is not finite, or so large that nothing can be said.
  bool only_reflects = false;  ///< Light from behind the side that is seen does nothing anywhere.
  Vec3f low{0, 0, 0}, high{0, 0, 0};
};

PointBounds bounds_of(const ShadingBatch& points, std::span<const MaterialRun> runs);

/// True when every sample of the light at every point is 0 in floating point too: its radiance over density, or what
/// lobes without numbers out of the ordinary reflect of it. Never true where that is in doubt.
bool cannot_reach(const LightReach& light, const PointBounds& bounds, const ShadingBatch& points);

/// True when what the lobes do is finite for any direction, so that no light times it is no light. Looks at every number
/// of every lobe, so it is asked last.
bool are_finite(const ShadingBatch& points, std::span<const MaterialRun> runs);

}  // namespace whit
