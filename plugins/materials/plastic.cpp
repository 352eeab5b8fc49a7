// A diffuse base and a glossy Torrance-Sparrow coat with Trowbridge-Reitz facets.
#include "core/plugin/registry.h"
#include "plugins/shared/material_inputs.h"

namespace whit {
namespace {

/// The coat's index inside over that outside. pbrt-v3 has them this way round (1.5 outside), which makes the
/// gloss total beyond 42 degrees between light and facet; plastics in its scenes are tuned to that look.
constexpr float kCoatEta = 1 / 1.5f;

struct Plastic : Material {
  Tex<RGB> Kd, Ks;
  Tex<float> roughness;
  bool remaproughness = true;

  void lobes(const ShadingBatch& s, LobeSet& out) const override {
    if (!is_black(Kd)) {
      Lobe diffuse;
      diffuse.weight = weights(Kd, s);
      out.add(diffuse);
    }
    if (is_black(Ks)) return;
    Lobe gloss;
    gloss.type = LobeType::MicrofacetReflection;
    gloss.fresnel = FresnelType::Dielectric;
    gloss.weight = weights(Ks, s);
    gloss.a = gloss.b = alphas(roughness, remaproughness, s);
    gloss.eta = filled(s, kCoatEta);
    out.add(gloss);
  }

  std::vector<Ineffective> ineffective() const override {
    if (!is_black(Ks)) return {};
    return {{"roughness", "\"Ks\" is black"}, {"remaproughness", "\"Ks\" is black"}};
  }
};

const Register<Plastic> plastic{
    "plastic",
    "A diffuse base with a glossy coat.",
    param(&Plastic::Kd, "Kd", RGB(0.25f), Unit::None, "Reflectance of the diffuse base."),
    param(&Plastic::Ks, "Ks", RGB(0.25f), Unit::None, "Scale of the glossy reflection."),
    param(&Plastic::roughness, "roughness", 0.1f, Unit::None, "Roughness of the coat; see remaproughness.", kRoughness),
    param(&Plastic::remaproughness, "remaproughness", true, Unit::None,
          "Roughness is in 0..1 and mapped to the microfacets' alpha; otherwise it is alpha."),
    bumpmap_param()};

}  // namespace
}  // namespace whit
