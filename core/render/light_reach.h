// Lights that leave all points of a batch dark, known from where they shine, so that it need not sample them.
#pragma once

#include <span>

#include "core/plugin/light_reach.h"
#include "core/render/points.h"

namespace whit {

PointBounds bounds_of(const ShadingBatch& points, std::span<const MaterialRun> runs);

/// True when every sample of the light at every point is 0 in floating point too: its radiance over density, or what
/// lobes without numbers out of the ordinary reflect of it. Never true where that is in doubt.
bool cannot_reach(const LightReach& light, const PointBounds& bounds, const ShadingBatch& points);

/// True when what the lobes do is finite for any direction, so that no light times it is no light. Looks at every number
/// of every lobe, so it is asked last.
bool are_finite(const ShadingBatch& points, std::span<const MaterialRun> runs);

}  // namespace whit
