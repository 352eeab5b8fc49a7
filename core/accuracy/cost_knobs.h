// What there is to turn at a scene: the settings of the knobs that are meaningful there, and the effects to leave out.
#pragma once

#include <string>
#include <vector>

#include "core/accuracy/cost_world.h"

namespace whit {

/// A setting other than the scene's.
struct CostAlternative {
  CostVariant variant;
  std::string from;         ///< The scene's own value of the knob; "" for effects.
  bool same_limit = false;  ///< With more and more samples its picture becomes that of the scene as it stands.
};

/// The most telling ones first.
std::vector<CostAlternative> knobs_of(const SceneDescription& world, const Scene& scene, bool all_samplers);

/// Each effect that the picture shows, left out.
std::vector<CostAlternative> effects_of(const EffectPlan& plan);

}  // namespace whit
