// The effect plan: what a scene calls for, who called for it, and what can be left alone.
#pragma once

#include <string>
#include <vector>

#include "core/plugin/plugin.h"
#include "core/scene/bound_scene.h"

namespace whit {

/// Why an effect is live: the statement that called for it.
struct EffectCause {
  Effect effect;
  SourcePos where;
  std::string what;  ///< "mirror", "skybox", ...
};

/// Computed from the bound scene by reachability, before anything heavy is read or built.
struct EffectPlan {
  EffectSet effects;
  std::vector<EffectCause> causes;  ///< Every statement that called for an effect, in file order.

  // Which statements of the SceneDescription the picture needs.
  std::vector<uint8_t> object_live, shape_live, texture_live, light_live;
  std::vector<uint8_t> material_live;  ///< Index of BoundScene::materials.
  std::vector<std::string> ignored;    ///< Media, other integrators: accepted, not simulated.

  bool needs_differentials = false;  ///< A filtered texture or a bump map is visible.
  bool needs_time = false;           ///< Something moves.
  bool needs_lens = false;           ///< The camera's lens has a radius.

  bool live(Effect e) const { return effects.has(e); }
};

/// Plans a bound scene. Cheap: looks at parameters only.
EffectPlan plan_effects(const BoundScene& scene);

}  // namespace whit
