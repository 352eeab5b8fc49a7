// A perfect mirror: reflects the same share at every angle.
#include "core/plugin/registry.h"
#include "plugins/shared/material_inputs.h"

namespace whit {
namespace {

struct Mirror : Material {
  Tex<RGB> Kr;

  void lobes(const ShadingBatch& s, LobeSet& out) const override {
    if (is_black(Kr)) return;
    Lobe lobe;
    lobe.type = LobeType::SpecularReflection;
    lobe.weight = weights(Kr, s);
    out.add(lobe);
  }
};

const Register<Mirror> mirror{"mirror", "A perfect mirror.",
                              param(&Mirror::Kr, "Kr", RGB(0.9f), Unit::None, "Reflectance, the same at every angle."),
                              bumpmap_param()};

}  // namespace
}  // namespace whit
