// A thin sheet that reflects and transmits, both diffusely and through rough dielectric facets. The facets are those
// of Walter et al., Microfacet Models for Refraction through Rough Surfaces, 2007, with an index of 1.5.
#include "core/plugin/registry.h"
#include "plugins/shared/material_inputs.h"

namespace whit {
namespace {

constexpr float kEta = 1.5f;

struct Translucent : Material {
  Tex<RGB> Kd, Ks, reflect, transmit;
  Tex<float> roughness;
  bool remaproughness = true;

  bool is_nothing() const { return is_black(reflect) && is_black(transmit); }

  void lobes(const ShadingBatch& s, LobeSet& out) const override {
    Lobe lobe;
    lobe.fresnel = FresnelType::Dielectric;
    lobe.eta = filled(s, kEta);
    out.eta = lobe.eta;
    add(s, lobe, LobeType::LambertReflection, Kd, reflect, out);
    add(s, lobe, LobeType::LambertTransmission, Kd, transmit, out);
    if (is_black(Ks) || is_nothing()) return;
    lobe.a = lobe.b = alphas(roughness, remaproughness, s);
    add(s, lobe, LobeType::MicrofacetReflection, Ks, reflect, out);
    add(s, lobe, LobeType::MicrofacetTransmission, Ks, transmit, out);
  }

  std::vector<Ineffective> ineffective() const override {
    std::vector<Ineffective> all;
    if (is_nothing()) {
      constexpr const char* why = "\"reflect\" and \"transmit\" are black";
      all = {{"Kd", why}, {"Ks", why}, {"roughness", why}, {"remaproughness", why}};
    } else if (is_black(Ks)) {
      all = {{"roughness", "\"Ks\" is black"}, {"remaproughness", "\"Ks\" is black"}};
    }
    if (is_black(Kd) && is_black(Ks)) {
      constexpr const char* why = "\"Kd\" and \"Ks\" are black";
      all.insert(all.end(), {{"reflect", why}, {"transmit", why}});
    }
    return all;
  }

 private:
  static void add(const ShadingBatch& s, Lobe lobe, LobeType type, const Tex<RGB>& colour, const Tex<RGB>& share,
                  LobeSet& out) {
    if (is_black(colour) || is_black(share)) return;
    lobe.type = type;
    lobe.weight = product(s, weights(colour, s), weights(share, s));
    out.add(lobe);
  }
};

const Register<Translucent> translucent{
    "translucent",
    "A thin sheet that reflects and transmits, diffusely and glossily.",
    param(&Translucent::Kd, "Kd", RGB(0.25f), Unit::None, "Scale of the diffuse scattering."),
    param(&Translucent::Ks, "Ks", RGB(0.25f), Unit::None, "Scale of the glossy scattering."),
    param(&Translucent::reflect, "reflect", RGB(0.5f), Unit::None, "Share that is reflected."),
    param(&Translucent::transmit, "transmit", RGB(0.5f), Unit::None, "Share that is transmitted."),
    param(&Translucent::roughness, "roughness", 0.1f, Unit::None, "Roughness of the glossy part; see remaproughness.",
          kRoughness),
    param(&Translucent::remaproughness, "remaproughness", true, Unit::None,
          "Roughness is in 0..1 and mapped to the microfacets' alpha; otherwise it is alpha."),
    bumpmap_param()};

}  // namespace
}  // namespace whit
