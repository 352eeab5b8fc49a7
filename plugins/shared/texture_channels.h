// Writing one texture for floats and for colours: a colour is three channels, a float is one.
#pragma once

#include "core/plugin/texture.h"

namespace whit {

template <class T>
inline constexpr int kChannels = 1;
template <>
inline constexpr int kChannels<RGB> = 3;

/// Channel c of an array of values, or of one value.
inline float* channel(float* lanes, int /*c*/) { return lanes; }
inline float* channel(const RGBLanes& lanes, int c) { return c == 0 ? lanes.r : (c == 1 ? lanes.g : lanes.b); }
inline float channel(float value, int /*c*/) { return value; }
inline float channel(const RGB& value, int c) { return c == 0 ? value.x : (c == 1 ? value.y : value.z); }

/// out = (1 - t) a + t b, channel by channel, for n points. pbrt-v3's blend, exact at both ends.
template <class T>
void blend(int n, const typename ValueLanes<T>::type& a, const typename ValueLanes<T>::type& b, const float* t,
           const typename ValueLanes<T>::type& out) {
  for (int c = 0; c < kChannels<T>; ++c) {
    const float *const from = channel(a, c), *const to = channel(b, c);
    float* const result = channel(out, c);
    for_lanes(n, [&](int i) { result[i] = (1 - t[i]) * from[i] + t[i] * to[i]; });
  }
}

/// The same for two constants.
template <class T>
T blend(const T& a, const T& b, float t) {
  return a * (1 - t) + b * t;
}

}  // namespace whit
