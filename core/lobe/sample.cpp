// Sampling directions: a lobe is chosen for each lane, each lobe draws for the lanes that chose it, and what came out
// is evaluated by all lobes.
#include <limits>

#include "core/base/fastmath.h"
#include "core/lobe/shares.h"
#include "core/lobe/table.h"

namespace whit {

namespace {

/// For each lane the last lobe whose part of [0, 1) starts at or before lobe_u; -1 where all are black.
int32_t* choose(const LobeSet& set, const ShadingBatch& s, const LobeShares& shares, const float* lobe_u) {
  int32_t* const chosen = s.arena->alloc<int32_t>(s.n);
  float* const start = s.arena->floats(s.n);
  for_lanes(s.n, [&](int i) { chosen[i] = -1, start[i] = 0; });
  for (int k = 0; k < set.count; ++k) {
    const float* const share = shares.of[k];
    if (!share) continue;
    for_lanes(s.n, [&](int i) {
      const int32_t before = chosen[i];
      const bool mine = (share[i] > 0) & (lobe_u[i] >= start[i]);
      chosen[i] = mine ? k : before;
      start[i] += share[i];
    });
  }
  return chosen;
}

bool is_chosen(const int32_t* chosen, int n, int k) {
  int any = 0;
#pragma omp simd reduction(| : any)
  for (int i = 0; i < n; ++i) any |= chosen[i] == k;
  return any != 0;
}

/// A density whose inverse is far from overflowing. What is less likely does not happen.
constexpr float kLeastDensity = 1e-30f;

/// From values and densities of the drawn directions to weights; where none came out there is no light.
void weigh(const ShadingBatch& s, const LobeSamples& out) {
  for_lanes(s.n, [&](int i) {
    const Vec3f wi = out.wi[i], back = -s.wo[i];
    const RGB f = out.weight[i];
    const float density = out.pdf[i];
    const bool came = (dot(wi, wi) > 0) & (density > kLeastDensity);
    const float inv = came ? 1 / density : 0.0f;
    out.wi.set(i, {came ? wi.x : back.x, came ? wi.y : back.y, came ? wi.z : back.z});
    out.weight.set(i, {came ? f.x * inv : 0.0f, came ? f.y * inv : 0.0f, came ? f.z * inv : 0.0f});
    out.pdf[i] = came ? density : 0.0f;
  });
}

/// Divides the weights of the lanes that drew from a specular lobe by its share, and marks them by their densities.
void weigh_specular(const ShadingBatch& s, const int32_t* chosen, int k, const float* share, const LobeSamples& out) {
  for_lanes(s.n, [&](int i) {
    const Vec3f wi = out.wi[i], wo = s.wo[i];
    const RGB w = out.weight[i];
    const float density = out.pdf[i];
    const bool mine = chosen[i] == k, came = (w.x != 0) | (w.y != 0) | (w.z != 0);
    const float scale = (mine & came) ? 1 / share[i] : 1.0f;
    const bool none = mine & !came;
    out.wi.set(i, {none ? -wo.x : wi.x, none ? -wo.y : wi.y, none ? -wo.z : wi.z});
    out.weight.set(i, {w.x * scale, w.y * scale, w.z * scale});
    const float delta = came ? std::numeric_limits<float>::infinity() : 0.0f;
    out.pdf[i] = mine ? delta : density;
  });
}

}  // namespace

void sample_lobes(const LobeSet& set, const ShadingBatch& s, const LobeFrame& frame, const float* lobe_u,
                  const float* u, const float* v, LobeKinds kinds, const LobeSamples& out) {
  const ArenaScope scratch(*s.arena);
  const LobeShares shares = lobe_shares(set, s, kinds);
  const int32_t* const chosen = choose(set, s, shares, lobe_u);
  const auto draw_all = [&](bool specular, const auto& then) {
    for (int k = 0; k < set.count; ++k) {
      const LobeRow& row = row_of(set.lobes[k].type);
      if (row.specular != specular || !shares.of[k] || !is_chosen(chosen, s.n, k)) continue;
      row.sample({set.lobes[k], s, frame, chosen, k, u, v, out.wi, out.weight, out.eta2});
      then(k);
    }
  };
  for_lanes(s.n, [&](int i) { out.wi.set(i, {0, 0, 0}); });
  if (out.eta2) for_lanes(s.n, [&](int i) { out.eta2[i] = 1; });
  if (kinds == LobeKinds::Specular) {
    for_lanes(s.n, [&](int i) { out.wi.set(i, -s.wo[i]), out.weight.set(i, RGB(0.0f)), out.pdf[i] = 0; });
  } else {
    draw_all(false, [](int) {});
    eval_with_shares(set, s, frame, out.wi, shares, out.weight, out.pdf);
    weigh(s, out);
  }
  draw_all(true, [&](int k) { weigh_specular(s, chosen, k, shares.of[k], out); });
}

}  // namespace whit
