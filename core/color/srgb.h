// The curve of sRGB displays.
#pragma once

#include <cmath>

#include "core/base/fastmath.h"

namespace whit {

/// The exact sRGB curve of IEC 61966-2-1 as pbrt-v3 has it, clamped to [0, 1]: 12.92 v up to 0.0031308, else
/// 1.055 v^(1/2.4) - 0.055. NaN gives 0.
inline float srgb_encode(float v) {
  const float curve = 1.055f * pow_of(v, 1.0f / 2.4f) - 0.055f;
  const float below_one = v <= 0.0031308f ? 12.92f * v : curve;
  const float clamped = v >= 1 ? 1.0f : below_one;
  return v > 0 ? clamped : 0.0f;
}

/// The other way, of values of at least 0: v / 12.92 up to 0.04045, else ((v + 0.055) / 1.055)^2.4.
inline double srgb_decode(double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); }

}  // namespace whit
