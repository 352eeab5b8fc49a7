// Whether a ray reaches a box.
#pragma once

#include "core/accel/embree.h"

namespace whit {

/// True when the ray from o, one over whose direction is `inverse`, is inside the box somewhere within [t_near, t_far]: as
/// generous with rounding as Embree's robust traversal, and a NaN counts as reaching. For loops over lanes.
[[gnu::always_inline]] inline bool reaches(const RTCBounds& box, const Vec3f& o, const Vec3f& inverse, float t_near,
                                           float t_far) {
  constexpr float kWiden = 1 + 1e-6f;
  // Of these a NaN in the first place stays.
  const auto low = [](float a, float b) { return b < a ? b : a; };
  const auto high = [](float a, float b) { return b > a ? b : a; };
  const float x0 = (box.lower_x - o.x) * inverse.x, x1 = (box.upper_x - o.x) * inverse.x;
  const float y0 = (box.lower_y - o.y) * inverse.y, y1 = (box.upper_y - o.y) * inverse.y;
  const float z0 = (box.lower_z - o.z) * inverse.z, z1 = (box.upper_z - o.z) * inverse.z;
  const float enter = high(high(low(x0, x1), low(y0, y1)), high(low(z0, z1), t_near));
  const float leave = low(low(high(x0, x1), high(y0, y1)), low(high(z0, z1), t_far));
  return !(enter > leave * kWiden);
}

}  // namespace whit
