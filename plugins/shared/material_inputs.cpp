#include "plugins/shared/material_inputs.h"

#include "core/lobe/formulas.h"

namespace whit {

float* filled(const ShadingBatch& s, float value) {
  float* const out = s.arena->floats(s.n);
  for_lanes(s.n, [&](int i) { out[i] = value; });
  return out;
}

float* alphas(const Tex<float>& roughness, bool remap, const ShadingBatch& s) {
  if (roughness.is_constant()) {
    const float alpha = remap ? roughness_to_alpha(roughness.value()) : roughness.value();
    return filled(s, max_of(alpha, kMinAlpha));
  }
  float* const out = roughness(s);
  if (remap) for_lanes(s.n, [&](int i) { out[i] = roughness_to_alpha(out[i]); });
  for_lanes(s.n, [&](int i) { out[i] = max_of(out[i], kMinAlpha); });
  return out;
}

void set_alphas(Lobe& lobe, const Tex<float>& u, const Tex<float>& v, bool remap, const ShadingBatch& s) {
  const bool same = u.texture() == v.texture() && (u.texture() || u.value() == v.value());
  lobe.a = alphas(u, remap, s);
  lobe.b = same ? lobe.a : alphas(v, remap, s);
}

RGBLanes product(const ShadingBatch& s, const RGBLanes& a, const RGBLanes& b) {
  const RGBLanes out = s.arena->rgb(s.n);
  for_lanes(s.n, [&](int i) { out.r[i] = a.r[i] * b.r[i], out.g[i] = a.g[i] * b.g[i], out.b[i] = a.b[i] * b.b[i]; });
  return out;
}

RGBLanes one_minus(const ShadingBatch& s, const RGBLanes& share) {
  const RGBLanes out = s.arena->rgb(s.n);
  for_lanes(s.n, [&](int i) { out.r[i] = 1 - share.r[i], out.g[i] = 1 - share.g[i], out.b[i] = 1 - share.b[i]; });
  return clamp0(s.n, out);
}

void add_passage(const ShadingBatch& s, const RGBLanes& solid, const float* eta, LobeSet& out) {
  Lobe passage;
  passage.type = LobeType::SpecularTransmission;
  passage.fresnel = FresnelType::Dielectric;
  passage.eta = filled(s, 1);
  passage.weight = one_minus(s, solid);
  out.add(passage);
  if (!eta) return;  // 1 anyway
  float* const seen = s.arena->floats(s.n);
  const RGBLanes w = passage.weight;
  for_lanes(s.n, [&](int i) { seen[i] = w.r[i] + w.g[i] + w.b[i] > 0 ? 1.0f : eta[i]; });
  out.eta = seen;
}

float* indices(const Tex<float>& index, const ShadingBatch& s) {
  float* const out = index(s);
  for_lanes(s.n, [&](int i) { out[i] = clamp_to(out[i], 1e-3f, 1e3f); });
  return out;
}

}  // namespace whit
