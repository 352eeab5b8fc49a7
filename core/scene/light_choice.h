// Choosing one of many lights for each point.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "core/batch/lanes.h"
#include "core/plugin/light.h"

namespace whit {

struct SceneLight;

/// Which light is sampled at a point: a distribution over the scene's lights. Every light has a probability above 0
/// everywhere, so that dividing by it leaves nothing out; it depends on the point alone, so that a ray which meets an
/// emitter can ask for it with its origin.
class LightChoice {
 public:
  virtual ~LightChoice() = default;
  /// A light for each of n points (render space) by numbers u in [0,1), and the probability with which it was chosen.
  virtual void choose(int n, const Vec3Lanes& p, const float* u, int32_t* light, float* probability) const = 0;
  /// The probability of choosing light `light` (a number of Scene::lights) at p: to the bit that of choose().
  virtual float probability(int light, const Vec3f& p) const = 0;
};

/// Null when there are no lights. The radius is that of the scene in render space; it weighs lights at infinity against
/// others. The lights must stay where they are.
std::unique_ptr<LightChoice> make_light_choice(std::span<const SceneLight> lights, LightStrategy strategy,
                                               double scene_radius);

}  // namespace whit
