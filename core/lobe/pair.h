// What evaluating a lobe starts from: the two directions at a point of a batch, and which lobes the geometric normal
// allows.
#pragma once

#include "core/base/fastmath.h"
#include "core/batch/shading.h"

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

inline void accumulate(const RGBLanes& out, int i, const RGBLanes& weight, float f) {
  out.r[i] += weight.r[i] * f;
  out.g[i] += weight.g[i] * f;
  out.b[i] += weight.b[i] * f;
}

}  // namespace whit
