// What the renderer knows of a batch of points beside what integrators see of it.
#pragma once

#include <optional>

#include "core/lobe/eval.h"
#include "core/plugin/sampler.h"
#include "core/plugin/transport.h"

namespace whit {

/// Points of one material, contiguous in their batch.
struct MaterialRun {
  ShadingBatch points;
  LobeSet lobes;
  LobeFrame frame;
  int first = 0;
  bool scatters = false, mirrors = false, refracts = false;  ///< Which kinds of lobes it has.
};

/// What is found out about the points of a batch once, for all lights.
struct PointBounds {
  bool bounded = false;        ///< False when a coordinate is not finite, or so large that nothing can be said.
  bool only_reflects = false;  ///< Light from behind the side that is seen does nothing anywhere.
  Vec3f low{0, 0, 0}, high{0, 0, 0};
};

/// Kept with a batch of points once it has been asked for.
struct PointNotes {
  int rays = 0;           ///< In the batch in which the points' rays were.
  bool scatters = false;  ///< Whether some point has a lobe that is not specular.
  SampleKeys keys;        ///< Of the points; filled by the first draw.
  int32_t *px = nullptr, *py = nullptr;
  uint32_t* index = nullptr;
  std::optional<PointBounds> bounds;   ///< Once a light has been compared with them.
  std::optional<bool> finite;          ///< are_finite(), once asked.
  std::optional<Arena::Mark> scratch;  ///< Where the arrays of one light begin.
};

}  // namespace whit
