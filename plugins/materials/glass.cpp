// A dielectric boundary, smooth or rough. Smooth: reflection and refraction by Fresnel's equations, as two
// lobes. Rough: microfacets after Walter et al., Microfacet Models for Refraction through Rough Surfaces,
// 2007. Where a texture makes both roughnesses 0 the surface is smooth.
#include <cmath>

#include "core/plugin/material_inputs.h"
#include "core/plugin/registry.h"

namespace whit {
namespace {

struct Glass : Material {
  Tex<RGB> Kr, Kt;
  Tex<float> uroughness, vroughness, index, eta;
  bool remaproughness = true;

  /// "eta" is the newer name; 0 means that it is not given, because a given one is positive.
  const Tex<float>& relative_index() const { return eta.is_constant() && eta.value() == 0 ? index : eta; }

  bool constant_roughness() const { return uroughness.is_constant() && vroughness.is_constant(); }
  bool may_be_smooth() const { return !constant_roughness() || (uroughness.value() == 0 && vroughness.value() == 0); }
  bool may_be_rough() const { return !constant_roughness() || uroughness.value() != 0 || vroughness.value() != 0; }

  EffectSet effects() const override {
    EffectSet e = effects_of(*this, Kr, Kt, uroughness, vroughness, relative_index());
    if (may_be_smooth() && !is_black(Kr)) e.add(Effect::Mirror);
    if (may_be_smooth() && !is_black(Kt)) e.add(Effect::Refraction);
    if (may_be_rough() && !(is_black(Kr) && is_black(Kt))) e.add(Effect::Glossy);
    return e;
  }

  void lobes(const ShadingBatch& s, LobeSet& out) const override {
    Lobe lobe;
    lobe.fresnel = FresnelType::Dielectric;
    lobe.eta = indices(relative_index(), s);
    out.eta = lobe.eta;
    const float* const rough = constant_roughness() ? nullptr : rough_points(s);
    if (may_be_smooth()) {
      add(s, lobe, LobeType::SpecularReflection, Kr, rough, 0, out);
      add(s, lobe, LobeType::SpecularTransmission, Kt, rough, 0, out);
    }
    if (!may_be_rough()) return;
    lobe.a = alphas(uroughness, remaproughness, s);
    lobe.b = isotropic() ? lobe.a : alphas(vroughness, remaproughness, s);
    add(s, lobe, LobeType::MicrofacetReflection, Kr, rough, 1, out);
    add(s, lobe, LobeType::MicrofacetTransmission, Kt, rough, 1, out);
  }

 private:
  bool isotropic() const { return constant_roughness() && uroughness.value() == vroughness.value(); }

  /// 1 where a roughness is not 0, else 0.
  float* rough_points(const ShadingBatch& s) const {
    float* const rough = uroughness(s);
    const float* const v = vroughness(s);
    for_lanes(s.n, [&](int i) { rough[i] = std::abs(rough[i]) + std::abs(v[i]) > 0 ? 1.0f : 0.0f; });
    return rough;
  }

  /// Adds a lobe of a type and colour, black where `rough` (null: nowhere) is not `wanted`.
  static void add(const ShadingBatch& s, Lobe lobe, LobeType type, const Tex<RGB>& colour, const float* rough,
                  float wanted, LobeSet& out) {
    if (is_black(colour)) return;
    lobe.type = type;
    lobe.weight = weights(colour, s);
    if (rough) {
      for_lanes(s.n, [&](int i) {
        const float on = rough[i] == wanted ? 1.0f : 0.0f;
        lobe.weight.r[i] *= on, lobe.weight.g[i] *= on, lobe.weight.b[i] *= on;
      });
    }
    out.add(lobe);
  }
};

const Register<Glass> glass{
    "material",
    "glass",
    "A smooth or rough dielectric: reflects and refracts by Fresnel's equations.",
    param(&Glass::Kr, "Kr", RGB(1.0f), Unit::None, "Scale of the reflection."),
    param(&Glass::Kt, "Kt", RGB(1.0f), Unit::None, "Scale of the transmission."),
    param(&Glass::uroughness, "uroughness", 0.0f, Unit::None, "Roughness along u; 0 in both is smooth."),
    param(&Glass::vroughness, "vroughness", 0.0f, Unit::None, "Roughness along v."),
    param(&Glass::index, "index", 1.5f, Unit::None, "Index of refraction inside over that outside.", kPositive),
    param(&Glass::eta, "eta", Unit::None, "The same as index, which it overrides.", kPositive),
    param(&Glass::remaproughness, "remaproughness", true, Unit::None,
          "Roughness is in 0..1 and mapped to the microfacets' alpha; otherwise it is alpha."),
    bumpmap_param()};

}  // namespace
}  // namespace whit
