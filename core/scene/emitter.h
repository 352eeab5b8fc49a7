// Emitting primitives of shapes, as lights: a triangle or an analytic shape with what it radiates.
#pragma once

#include <memory>

#include "core/scene/scene.h"

namespace whit {

/// What an area light gives a shape to radiate: the same in every direction of the emitting sides.
struct Emission {
  RGB radiance{0.0f};
  const Tex<RGB>* map = nullptr;  ///< Unless null, multiplies it, and
  RGB mean{1.0f};                 ///< is this on average.
  bool two_sided = false;
  int samples = 1;           ///< Light::sample_count().
  const std::string* group;  ///< Light::light_group(), the area light's.
};

/// A shape, or what is left of a mesh, that is seen to emit and never sampled.
std::unique_ptr<const Light> make_seen_emitter(const SceneShape& shape, const Emission& emission);

/// One emitting primitive of a shape as a light. Of a curve, which can be seen but not sampled, `prim` says nothing, nor
/// does it of a mesh that is only seen. What `shape` refers to must stay where it is.
std::unique_ptr<const Light> make_emitter(const SceneShape& shape, uint32_t prim, const Emission& emission);

}  // namespace whit
