#include "plugins/shared/dielectric_surface.h"

#include <cmath>

#include "plugins/shared/material_inputs.h"

namespace whit {

namespace {

/// Adds a lobe of a type and colour, black where `rough` (null: nowhere) is not `wanted`.
void add(const ShadingBatch& s, Lobe lobe, LobeType type, const Tex<RGB>& colour, const float* rough, float wanted,
         LobeSet& out) {
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

}  // namespace

bool DielectricSurface::is_nothing() const { return is_black(Kr) && is_black(Kt); }

std::vector<Ineffective> DielectricSurface::ineffective() const {
  if (is_nothing()) {
    constexpr const char* why = "\"Kr\" and \"Kt\" are black";
    return {{"uroughness", why}, {"vroughness", why}, {"remaproughness", why}, {"index", why}, {"eta", why}};
  }
  if (!may_be_rough()) return {{"remaproughness", "the surface is smooth: both roughnesses are 0"}};
  return {};
}

void DielectricSurface::add_surface(const ShadingBatch& s, const float* eta, LobeSet& out) const {
  Lobe lobe;
  lobe.fresnel = FresnelType::Dielectric;
  lobe.eta = out.eta = eta;
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

/// 1 where a roughness is not 0, else 0.
float* DielectricSurface::rough_points(const ShadingBatch& s) const {
  float* const rough = uroughness(s);
  const float* const v = vroughness(s);
  for_lanes(s.n, [&](int i) { rough[i] = std::abs(rough[i]) + std::abs(v[i]) > 0 ? 1.0f : 0.0f; });
  return rough;
}

}  // namespace whit
