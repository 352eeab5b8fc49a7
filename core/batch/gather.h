// Picking lanes out of a batch: out[i] = values[from[i]].
#pragma once

#include "core/batch/lanes.h"

namespace whit {

/// The values of the n lanes that `from` names, in that order.
inline void gather(const int32_t* from, int n, const float* values, float* out) {
  for_lanes(n, [&](int i) { out[i] = values[from[i]]; });
}
inline void gather(const int32_t* from, int n, const Vec3Lanes& values, const Vec3Lanes& out) {
  gather(from, n, values.x, out.x);
  gather(from, n, values.y, out.y);
  gather(from, n, values.z, out.z);
}

}  // namespace whit
