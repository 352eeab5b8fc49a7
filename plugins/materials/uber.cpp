// The union of the simple materials: diffuse, glossy, mirror and refraction, under an opacity that lets rays pass
// straight on. The glossy part is Torrance-Sparrow with Trowbridge-Reitz facets. Shadow rays do not see the opacity,
// as in pbrt-v3.
#include <initializer_list>
#include <optional>
#include <vector>

#include "core/plugin/registry.h"
#include "plugins/shared/material_inputs.h"

namespace whit {
namespace {

struct Uber : Material {
  Tex<RGB> Kd, Ks, Kr, Kt, opacity;
  Tex<float> roughness, index;
  std::optional<Tex<float>> uroughness, vroughness, eta;
  bool remaproughness = true;

  const Tex<float>& along_u() const { return uroughness ? *uroughness : roughness; }
  const Tex<float>& along_v() const { return vroughness ? *vroughness : along_u(); }
  const Tex<float>& relative_index() const { return eta ? *eta : index; }

  bool is_opaque() const {
    const RGB v = opacity.value();
    return opacity.is_constant() && v.x >= 1 && v.y >= 1 && v.z >= 1;
  }

  /// Whether a lobe follows Fresnel's equations, so that the index matters.
  bool is_shiny() const { return !is_black(opacity) && !(is_black(Ks) && is_black(Kr) && is_black(Kt)); }

  void lobes(const ShadingBatch& s, LobeSet& out) const override {
    Lobe lobe;
    if (is_shiny()) {
      lobe.fresnel = FresnelType::Dielectric;
      lobe.eta = out.eta = indices(relative_index(), s);
    }
    const RGBLanes solid = weights(opacity, s);
    if (!is_opaque()) add_passage(s, solid, lobe.eta, out);
    if (is_black(opacity)) return;
    add(s, lobe, LobeType::LambertReflection, Kd, solid, out);
    if (!is_black(Ks)) set_alphas(lobe, along_u(), along_v(), remaproughness, s);
    add(s, lobe, LobeType::MicrofacetReflection, Ks, solid, out);
    add(s, lobe, LobeType::SpecularReflection, Kr, solid, out);
    add(s, lobe, LobeType::SpecularTransmission, Kt, solid, out);
  }

  std::vector<Ineffective> ineffective() const override {
    std::vector<Ineffective> all;
    const auto add_all = [&all](std::initializer_list<const char*> names, const char* why) {
      for (const char* name : names) all.push_back({name, why});
    };
    if (is_black(opacity)) {
      add_all({"Kd", "Ks", "Kr", "Kt", "roughness", "uroughness", "vroughness", "remaproughness", "index", "eta"},
              "\"opacity\" is black, so there is no surface");
      return all;
    }
    if (is_black(Ks)) {
      add_all({"roughness", "uroughness", "vroughness", "remaproughness"}, "\"Ks\" is black");
    } else if (uroughness) {
      add_all({"roughness"}, "\"uroughness\" goes before it");
    }
    if (!is_shiny()) add_all({"index", "eta"}, "\"Ks\", \"Kr\" and \"Kt\" are black");
    else if (eta) add_all({"index"}, "\"eta\" goes before it");
    return all;
  }

 private:
  static void add(const ShadingBatch& s, Lobe lobe, LobeType type, const Tex<RGB>& colour, const RGBLanes& solid,
                  LobeSet& out) {
    if (is_black(colour)) return;
    lobe.type = type;
    lobe.weight = product(s, weights(colour, s), solid);
    out.add(lobe);
  }
};

const Register<Uber> uber{
    "uber",
    "Diffuse, glossy, mirror and refraction together, with an opacity.",
    param(&Uber::Kd, "Kd", RGB(0.25f), Unit::None, "Diffuse reflectance."),
    param(&Uber::Ks, "Ks", RGB(0.25f), Unit::None, "Scale of the glossy reflection."),
    param(&Uber::Kr, "Kr", RGB(0.0f), Unit::None, "Scale of the mirror reflection."),
    param(&Uber::Kt, "Kt", RGB(0.0f), Unit::None, "Scale of the refraction."),
    param(&Uber::opacity, "opacity", RGB(1.0f), Unit::None, "Share of all this; the rest of a ray passes straight on."),
    param(&Uber::roughness, "roughness", 0.1f, Unit::None, "Roughness of the glossy part; see remaproughness.",
          kRoughness),
    param(&Uber::uroughness, "uroughness", Unit::None, "Roughness along u, instead of roughness.", kRoughness),
    param(&Uber::vroughness, "vroughness", Unit::None, "Roughness along v, instead of that along u.", kRoughness),
    param(&Uber::index, "index", 1.5f, Unit::None, "Index of refraction inside over that outside.", kPositive),
    param(&Uber::eta, "eta", Unit::None, "The same as index, which it overrides.", kPositive),
    param(&Uber::remaproughness, "remaproughness", true, Unit::None,
          "Roughness is in 0..1 and mapped to the microfacets' alpha; otherwise it is alpha."),
    bumpmap_param()};

}  // namespace
}  // namespace whit
