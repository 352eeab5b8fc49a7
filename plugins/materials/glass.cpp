// A dielectric boundary, smooth or rough. Smooth: reflection and refraction by Fresnel's equations, as two
// lobes. Rough: microfacets after Walter et al., Microfacet Models for Refraction through Rough Surfaces,
// 2007. Where a texture makes both roughnesses 0 the surface is smooth.
#include "core/plugin/registry.h"
#include "plugins/shared/dielectric_surface.h"
#include "plugins/shared/material_inputs.h"

namespace whit {
namespace {

struct Glass : DielectricSurface {
  Tex<float> index, eta;

  /// "eta" is the newer name; 0 means that it is not given, because a given one is positive.
  const Tex<float>& relative_index() const { return eta.is_constant() && eta.value() == 0 ? index : eta; }

  void lobes(const ShadingBatch& s, LobeSet& out) const override {
    if (!is_nothing()) add_surface(s, indices(relative_index(), s), out);
  }

  std::vector<Ineffective> ineffective() const override {
    std::vector<Ineffective> all = DielectricSurface::ineffective();
    if (&relative_index() == &eta) all.push_back({"index", "\"eta\" goes before it"});
    return all;
  }
};

const Register<Glass> glass{
    "glass",
    "A smooth or rough dielectric: reflects and refracts by Fresnel's equations.",
    param(&Glass::Kr, "Kr", RGB(1.0f), Unit::None, "Scale of the reflection."),
    param(&Glass::Kt, "Kt", RGB(1.0f), Unit::None, "Scale of the transmission."),
    param(&Glass::uroughness, "uroughness", 0.0f, Unit::None, "Roughness along u; 0 in both is smooth.", kRoughness),
    param(&Glass::vroughness, "vroughness", 0.0f, Unit::None, "Roughness along v.", kRoughness),
    param(&Glass::index, "index", 1.5f, Unit::None, "Index of refraction inside over that outside.", kPositive),
    param(&Glass::eta, "eta", Unit::None, "The same as index, which it overrides.", kPositive),
    param(&Glass::remaproughness, "remaproughness", true, Unit::None,
          "Roughness is in 0..1 and mapped to the microfacets' alpha; otherwise it is alpha."),
    bumpmap_param()};

}  // namespace
}  // namespace whit
