// Diffuse reflection: Lambert's, or that of Oren and Nayar (Generalization of Lambert's Reflectance Model,
// 1994) where sigma is not 0.
#include "core/lobe/formulas.h"
#include "core/plugin/registry.h"
#include "plugins/shared/material_inputs.h"

namespace whit {
namespace {

struct Matte : Material {
  Tex<RGB> Kd;
  Tex<float> sigma;

  void lobes(const ShadingBatch& s, LobeSet& out) const override {
    if (is_black(Kd)) return;
    Lobe lobe;
    lobe.weight = weights(Kd, s);
    if (!sigma.is_constant() || sigma.value() > 0) set_oren_nayar(s, lobe);
    out.add(lobe);
  }

  std::vector<Ineffective> ineffective() const override {
    if (!is_black(Kd)) return {};
    return {{"sigma", "\"Kd\" is black"}};
  }

 private:
  void set_oren_nayar(const ShadingBatch& s, Lobe& lobe) const {
    const float* const degrees = sigma(s);
    float *const a = s.arena->floats(s.n), *const b = s.arena->floats(s.n);
    for_lanes(s.n, [&](int i) {
      const OrenNayarAB ab = oren_nayar_ab(clamp_to(degrees[i], 0.0f, 90.0f) * (kPi / 180));
      a[i] = ab.a, b[i] = ab.b;
    });
    lobe.type = LobeType::OrenNayar;
    lobe.a = a, lobe.b = b;
  }
};

const Register<Matte> matte{
    "matte", "Lambertian or Oren-Nayar diffuse reflection.",
    param(&Matte::Kd, "Kd", RGB(0.5f), Unit::None, "Diffuse reflectance."),
    param(&Matte::sigma, "sigma", 0.0f, Unit::Degrees, "Oren-Nayar roughness, clamped to 0..90; 0 is Lambertian."),
    bumpmap_param()};

}  // namespace
}  // namespace whit
