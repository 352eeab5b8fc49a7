// Which light is sampled at a point.
#pragma once

#include <memory>
#include <span>

#include "core/plugin/light.h"

namespace whit {

struct SceneLight;

/// Which light is sampled at a point: a distribution over the scene's lights.
class LightChoice {
 public:
  virtual ~LightChoice() = default;
  /// A light for each of n points (render space) by numbers u in [0,1), and the probability with which it was chosen (> 0).
  virtual void choose(int n, const Vec3Lanes& p, const float* u, int32_t* light, float* probability) const = 0;
  /// The probability of choosing light `light` (a number of Scene::lights) at p; the same function of p as choose() uses.
  virtual float probability(int light, const Vec3f& p) const = 0;
};
std::unique_ptr<LightChoice> make_light_choice(std::span<const SceneLight> lights, LightStrategy strategy,
                                               double scene_radius);

}  // namespace whit
