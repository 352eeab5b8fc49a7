// What evaluating a lobe starts from: the two directions at a point of a batch, and which lobes the geometric normal
// allows.
#pragma once

#include "core/base/fastmath.h"
#include "core/batch/shading.h"
#include "core/lobe/table.h"

namespace whit {

/// One pair of directions at one point.
struct Pair {
  Vec3f wo, wi, n;
  float zo, zi;               ///< Cosines to the shading normal, signed.
  float reflects, transmits;  ///< 1 or 0: which lobes the geometric normal allows.
};

inline Pair make_pair(const ShadingBatch& s, const Vec3Lanes& wi_lanes, int i) {
  const Vec3f wo = s.wo[i], wi = wi_lanes[i], ng = s.ng[i], n = s.ns[i];
  const float zo = dot(wo, n), zi = dot(wi, n);
  const bool same_side = dot(wi, ng) * dot(wo, ng) > 0;
  const float on = zo != 0 ? 1.0f : 0.0f;
  return {wo, wi, n, zo, zi, same_side ? on : 0.0f, same_side ? 0.0f : on};
}

/// `reflects` where light counts only in front of the shading normal, on the side that is seen: with it a surface whose
/// normals are mapped has flanks that are dark. pbrt-v3's own materials go by the geometric normal alone.
inline float reflects_in_front(const LobeQuery& q, const Pair& p, int i) {
  return p.zi * dot(q.s.wo[i], q.s.ng[i]) > 0 ? p.reflects : 0.0f;
}

/// The density of draw_diffuse(), and that of the other side.
inline float diffuse_density(const Pair& p) { return p.zo * p.zi > 0 ? std::abs(p.zi) * kInvPi : 0.0f; }
inline float diffuse_density_behind(const Pair& p) { return p.zo * p.zi < 0 ? std::abs(p.zi) * kInvPi : 0.0f; }

inline void accumulate(const RGBLanes& out, int i, const RGBLanes& weight, float f) {
  out.r[i] += weight.r[i] * f;
  out.g[i] += weight.g[i] * f;
  out.b[i] += weight.b[i] * f;
}

/// Calls add(i, pair, add_density) for every lane; add_density(x) adds the lobe's share of a density x. Where densities
/// are not asked for it does nothing, and what is computed for it costs nothing.
template <class Add>
void for_pairs(const LobeQuery& q, const LobeValues& out, const Add& add) {
  if (out.pdf) {
    for_lanes(q.s.n, [&](int i) {
      add(i, make_pair(q.s, q.wi, i), [&](float density) { out.pdf[i] += out.share[i] * density; });
    });
  } else {
    for_lanes(q.s.n, [&](int i) { add(i, make_pair(q.s, q.wi, i), [](float) {}); });
  }
}

}  // namespace whit
