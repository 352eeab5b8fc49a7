// A diffuse base under a glossy coat that hides it towards grazing angles. Ashikhmin and Shirley, An Anisotropic
// Phong BRDF Model, Journal of Graphics Tools 5(2), 2000, with Trowbridge-Reitz facets, as in pbrt-v3.
#include "core/plugin/registry.h"
#include "plugins/shared/material_inputs.h"

namespace whit {
namespace {

struct Substrate : Material {
  Tex<RGB> Kd, Ks;
  Tex<float> uroughness, vroughness;
  bool remaproughness = true;

  bool is_nothing() const { return is_black(Kd) && is_black(Ks); }

  void lobes(const ShadingBatch& s, LobeSet& out) const override {
    if (is_nothing()) return;
    Lobe lobe;
    lobe.type = LobeType::FresnelBlend;
    lobe.colour1 = weights(Kd, s), lobe.colour2 = weights(Ks, s);
    float* const present = s.arena->floats(s.n);
    const RGBLanes d = lobe.colour1, g = lobe.colour2;
    // The coat turns white at grazing angles whatever its Ks; only where both colours are black there is no lobe.
    for_lanes(s.n, [&](int i) { present[i] = d.r[i] + d.g[i] + d.b[i] + g.r[i] + g.g[i] + g.b[i] > 0 ? 1.0f : 0.0f; });
    lobe.weight = {present, present, present};
    set_alphas(lobe, uroughness, vroughness, remaproughness, s);
    out.add(lobe);
  }

  std::vector<Ineffective> ineffective() const override {
    constexpr const char* why = "\"Kd\" and \"Ks\" are black";
    if (!is_nothing()) return {};
    return {{"uroughness", why}, {"vroughness", why}, {"remaproughness", why}};
  }
};

const Register<Substrate> substrate{
    "substrate",
    "A diffuse base under a glossy coat.",
    param(&Substrate::Kd, "Kd", RGB(0.5f), Unit::None, "Reflectance of the diffuse base."),
    param(&Substrate::Ks, "Ks", RGB(0.5f), Unit::None, "Reflectance of the coat at normal incidence."),
    param(&Substrate::uroughness, "uroughness", 0.1f, Unit::None, "Roughness of the coat along u.", kRoughness),
    param(&Substrate::vroughness, "vroughness", 0.1f, Unit::None, "Roughness of the coat along v.", kRoughness),
    param(&Substrate::remaproughness, "remaproughness", true, Unit::None,
          "Roughness is in 0..1 and mapped to the microfacets' alpha; otherwise it is alpha."),
    bumpmap_param()};

}  // namespace
}  // namespace whit
