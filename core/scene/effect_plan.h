// The effect plan: what a scene calls for, who called for it, and what can be left alone.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/base/effect.h"
#include "core/scene/bound_scene.h"

namespace whit {

/// A statement that called for an effect.
struct EffectCause {
  SourcePos where;
  std::string what;  ///< "mirror", "skybox", ...
};

/// Who called for an effect, and why it is off all the same.
struct EffectUse {
  static constexpr size_t kNamed = 3;
  size_t count = 0;                 ///< Of the statements that called for it.
  std::vector<EffectCause> causes;  ///< The first few of them, in file order.
  std::string why_off;              ///< Of an effect that is called for and off.
};

/// Something a scene file asks for and whit accepts, but does not do.
struct Ignored {
  std::string what;  ///< "participating media".
  SourcePos where;   ///< The first statement that asks for it.
  /// What is shown instead, where the picture looks otherwise than one might expect; "" where it hardly does, or where
  /// that has been said.
  std::string instead{};
};

struct PlanOptions {
  EffectSet off{};             ///< Switched off by hand.
  bool everything_on = false;  ///< All other stages run, for tests: the picture is the same.
};

/// Computed from the bound scene by reachability, before anything heavy is read or built.
struct EffectPlan {
  EffectSet called_for;        ///< By what is visible.
  EffectSet needed;            ///< The picture depends on these alone: called for, and not switched off.
  EffectSet off;               ///< PlanOptions::off, and what the integrator does not simulate.
  EffectSet off_by_hand;       ///< PlanOptions::off.
  bool everything_on = false;  ///< PlanOptions::everything_on.
  std::array<EffectUse, kEffects> uses;

  // Which statements of the SceneDescription the picture needs: not 0. (What else the number says of a texture is the
  // planner's.)
  std::vector<uint8_t> object_live, shape_live, texture_live, light_live;
  std::vector<uint8_t> material_live;  ///< Index of BoundScene::materials.
  MeshAttributes attributes;           ///< Of meshes, that live textures ask for.
  bool direct_light = false;           ///< A surface scatters, and a light can be sampled: there is direct light.
  std::vector<Ignored> ignored;

  /// Whether the stages of an effect run. Known at compile time where the build lacks the effect.
  bool live(Effect e) const { return compiled_in(e) && !off.has(e) && (everything_on || needed.has(e)); }
  bool needs_differentials() const {
    return live(Effect::TextureFiltering) || (live(Effect::Bump) && !off.has(Effect::TextureFiltering));
  }
  /// The effects whose lobes surfaces have.
  EffectSet lobes() const { return (everything_on ? EffectSet::all() : needed) - off - kCompiledOut; }
  const EffectUse& use(Effect e) const { return uses[static_cast<size_t>(e)]; }
};

/// Plans a bound scene. Cheap: looks at parameters only.
EffectPlan plan_effects(const BoundScene& scene, const PlanOptions& options = {});

}  // namespace whit
