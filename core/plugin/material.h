// Materials: which lobes a surface has, and how strong, at the points of a batch.
#pragma once

#include "core/lobe/lobe.h"
#include "core/plugin/param.h"
#include "core/plugin/texture.h"

namespace whit {

/// A surface material. One batch function; the renderer does the rest (bump mapping, evaluation, sampling).
class Material : public Plugin {
 public:
  static constexpr const char* kCategory = "material";
  Tex<float> bump;  ///< Displacement along the normal, in scene units; constant means no bump.
  /// Shading normals around (dpdu, dpdv, ns), each component of a unit vector as 0.5 + 0.5 x.
  Tex<RGB> normalmap = Tex<RGB>(kFlatNormal);
  float normalscale = 1;  ///< Of the normals' first two components.

  /// The colour of normals that are not tilted: a map that has it everywhere is none.
  static constexpr RGB kFlatNormal{0.5f, 0.5f, 1};
  bool has_normal_map() const { return !normalmap.is_constant() || !(normalmap.value() == kFlatNormal); }

  /// Adds the lobes of the s.n points to `out`. Arrays come from s.arena. Weights are clamped to >= 0 by clamp0.
  /// It is also asked with no points, before prepare(): the lobes that it then adds, and the textures that it then
  /// evaluates, are all that it may have. What else it adds later is dropped.
  virtual void lobes(const ShadingBatch& s, LobeSet& out) const = 0;

  /// The lobes it may have, as effects.
  EffectSet effects() const final;
  std::vector<const Plugin*> textures_read() const final;

  /// True where pbrt-v3 lets light into the body below the surface, when paths are followed: shown is the surface alone.
  virtual bool scatters_below() const { return false; }

  /// True for a material that is not there (pbrt's "none"): rays pass on unchanged and nothing is shaded.
  virtual bool is_interface() const { return false; }
};

/// The bump map parameter, the same for every material that has one.
inline auto bumpmap_param() {
  return param(&Material::bump, "bumpmap", 0.0f, Unit::Length,
               "Displacement along the normal that tilts the shading normal.");
}

/// The normal map parameters, the same for every material that has one.
inline auto normalmap_param() {
  return param(&Material::normalmap, "normalmap", Material::kFlatNormal, Unit::None,
               "Shading normals around tangent, bitangent and normal, whose components -1 to 1 are colours 0 to 1.");
}
inline auto normalscale_param() {
  return param(&Material::normalscale, "normalscale", 1.0f, Unit::None,
               "Scale of the normal map's components along tangent and bitangent.");
}

/// Clamps colours from below at 0, in place, and returns them: pbrt clamps reflectances only there.
inline RGBLanes clamp0(int n, RGBLanes c) {
  for_lanes(n, [&](int i) {
    c.r[i] = c.r[i] > 0 ? c.r[i] : 0.0f;
    c.g[i] = c.g[i] > 0 ? c.g[i] : 0.0f;
    c.b[i] = c.b[i] > 0 ? c.b[i] : 0.0f;
  });
  return c;
}

}  // namespace whit
