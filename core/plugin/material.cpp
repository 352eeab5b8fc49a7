#include "core/plugin/material.h"

namespace whit {
namespace {

/// What a material asks for where there is nothing to shade: its lobes and its textures.
struct DryRun {
  EffectSet effects;
  std::vector<const Plugin*> textures;
};

DryRun run_dry(const Material& material) {
  DryRun run;
  Arena arena(ShadingBatch::kNoPoints);
  ShadingBatch no_points;
  no_points.arena = &arena;
  no_points.textures_asked = &run.textures;
  LobeSet lobes(arena);
  material.lobes(no_points, lobes);
  for (int i = 0; i < lobes.count; ++i) run.effects.add(effect_of(lobes.lobes[i].type));
  return run;
}

}  // namespace

EffectSet Material::effects() const { return is_interface() ? EffectSet{Effect::Interfaces} : run_dry(*this).effects; }

std::vector<const Plugin*> Material::textures_read() const {
  std::vector<const Plugin*> textures = run_dry(*this).textures;
  if (!bump.is_constant()) textures.push_back(bump.texture().get());
  if (!normalmap.is_constant()) textures.push_back(normalmap.texture().get());
  return textures;
}

}  // namespace whit
