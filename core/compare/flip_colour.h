// Colours as FLIP sees them, a row of pixels at a time, each number in an array of its own. NaN stays NaN.
#pragma once

#include <cstddef>
#include <vector>

#include "core/base/fastmath.h"

namespace whit {

/// x^y for x in [0, 1e6], y in [0, 3]; NaN stays, where pow_of() would take it for 0, and it does without that one's branches,
/// which keep loops from being vectorised that clamp first.
inline float flip_power(float x, double y) {
  const double power = detail::exp2_kernel(detail::log2_kernel(double{max_of(x, 1e-30f)}) * y);
  return (x > 0 ? static_cast<float>(power) : 0.0f) + (x - x);
}

/// A row of colours: red, green and blue of light, or three numbers made of them.
struct ColourRow {
  explicit ColourRow(size_t width) : a(width), b(width), c(width) {}
  std::vector<float> a, b, c;
};

/// Takes sRGB to linear, clamped to [0, 1].
void decode_srgb(ColourRow& row);

/// Takes light, `scale` times as bright, to what a display shows of it, linear in [0, 1].
void tone_map(ColourRow& row, float scale);

/// The value that tone_map() takes to `shown` in (0, 1).
float tone_map_inverse(float shown);

/// Y of light, 1 of white.
float luminance(float r, float g, float b);

/// Takes linear light to Y, X - Y and Y - Z, relative to those of white. YCxCz (116 Y - 16, 500 (X - Y), 200 (Y - Z)) is these
/// but for factors, which filters whose weights add up to one leave as they are.
void to_opponent(ColourRow& row);

/// Takes these to L*a*b*, clamped to what a display shows, with the Hunt effect: colours are less colourful in the dark.
void to_hunt_lab(ColourRow& row);

/// Differences of colours of to_hunt_lab() in [0, 1]: most of the range is for those below 0.4 of the largest there are.
void colour_differences(const ColourRow& one, const ColourRow& other, std::vector<float>& out);

}  // namespace whit
