#include "core/lobe/shares.h"

#include "core/base/fastmath.h"
#include "core/lobe/table.h"

namespace whit {

namespace {

bool is_of(const Lobe& lobe, LobeKinds kinds) {
  return kinds == LobeKinds::All || is_specular(lobe.type) == (kinds == LobeKinds::Specular);
}

/// The luminance of the weights, kept from overflowing in a sum.
void luminances(const Lobe& lobe, int n, float* to) {
  const RGBLanes w = lobe.weight;
  for_lanes(n, [&](int i) { to[i] = min_of(luminance({w.r[i], w.g[i], w.b[i]}), 1e30f); });
}

}  // namespace

LobeShares lobe_shares(const LobeSet& set, const ShadingBatch& s, LobeKinds kinds) {
  const LobeShares shares{s.arena->alloc<float*>(set.count)};
  int count = 0;
  for (int k = 0; k < set.count; ++k) {
    const bool counts = is_of(set.lobes[k], kinds);
    shares.of[k] = counts ? s.arena->floats(s.n) : nullptr;
    count += counts;
  }
  float* const total = s.arena->floats(s.n);
  for_lanes(s.n, [&](int i) { total[i] = 0; });
  for (int k = 0; k < set.count; ++k) {
    float* const share = shares.of[k];
    if (!share) continue;
    luminances(set.lobes[k], s.n, share);
    const auto scale_strength = row_of(set.lobes[k].type).scale_strength;
    if (scale_strength && count > 1) scale_strength(set.lobes[k], s, share);
    for_lanes(s.n, [&](int i) { total[i] += share[i]; });
  }
  // What is as dark as this counts as black: its inverse would overflow.
  for_lanes(s.n, [&](int i) { total[i] = total[i] > 1e-30f ? 1 / total[i] : 0.0f; });
  for (int k = 0; k < set.count; ++k) {
    float* const share = shares.of[k];
    if (!share) continue;
    for_lanes(s.n, [&](int i) { share[i] *= total[i]; });
  }
  return shares;
}

}  // namespace whit
