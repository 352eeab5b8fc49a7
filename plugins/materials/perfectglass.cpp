// A smooth dielectric: reflects and refracts by Fresnel's equations, and reflects totally beyond the critical
// angle. A black Kr or Kt removes only its own lobe.
#include "core/plugin/registry.h"
#include "plugins/shared/material_inputs.h"

namespace whit {
namespace {

struct PerfectGlass : Material {
  Tex<RGB> Kr, Kt;
  Tex<float> index;

  void lobes(const ShadingBatch& s, LobeSet& out) const override {
    if (is_black(Kr) && is_black(Kt)) return;
    Lobe lobe;
    lobe.fresnel = FresnelType::Dielectric;
    lobe.eta = indices(index, s);
    out.eta = lobe.eta;
    if (!is_black(Kr)) {
      lobe.type = LobeType::SpecularReflection;
      lobe.weight = weights(Kr, s);
      out.add(lobe);
    }
    if (!is_black(Kt)) {
      lobe.type = LobeType::SpecularTransmission;
      lobe.weight = weights(Kt, s);
      out.add(lobe);
    }
  }
};

const Register<PerfectGlass> perfectglass{
    "perfectglass",
    "A smooth dielectric, by Fresnel's equations.",
    param(&PerfectGlass::Kr, "Kr", RGB(1.0f), Unit::None, "Scale of the reflection."),
    param(&PerfectGlass::Kt, "Kt", RGB(1.0f), Unit::None, "Scale of the transmission."),
    param(&PerfectGlass::index, "index", 1.5f, Unit::None, "Index of refraction inside over that outside.", kPositive),
    bumpmap_param()};

}  // namespace
}  // namespace whit
