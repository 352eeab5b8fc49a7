#include "core/watch/halves.h"

#include <Imath/half.h>

#include <algorithm>

namespace whit {

std::vector<uint16_t> halves_of(std::span<const float> numbers) {
  constexpr float kMost = 65504;
  std::vector<uint16_t> out(numbers.size());
  for (size_t i = 0; i < out.size(); ++i) {
    const float v = numbers[i];
    out[i] = imath_float_to_half(v - v == 0 ? std::clamp(v, -kMost, kMost) : v);
  }
  return out;
}

std::vector<float> floats_of(std::span<const uint16_t> halves) {
  std::vector<float> out(halves.size());
  std::transform(halves.begin(), halves.end(), out.begin(), [](uint16_t h) { return imath_half_to_float(h); });
  return out;
}

}  // namespace whit
