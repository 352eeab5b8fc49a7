#include "core/plugin/material_inputs.h"

#include "core/batch/lobe_formulas.h"

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

float* indices(const Tex<float>& index, const ShadingBatch& s) {
  float* const out = index(s);
  for_lanes(s.n, [&](int i) { out[i] = clamp_to(out[i], 1e-3f, 1e3f); });
  return out;
}

}  // namespace whit
