// Perlin's gradient noise and sums of its octaves, band-limited to the size of what is looked at.
// Sources: Perlin, Improving Noise, SIGGRAPH 2002 (the smooth interpolation; his permutation table); the gradients and
// the clamping of octaves are those of the PBR book, 3rd ed., 10.6, so that its textures look as they do there.
#pragma once

#include <cmath>
#include <cstdint>

#include "core/base/fastmath.h"

namespace whit {

namespace detail {

/// A permutation of 0..255, twice over, so that a sum of two entries is an index.
extern const int32_t kNoisePermutation[512];

/// The integer part of x modulo 256; 0 for what is not finite.
inline int32_t noise_cell(float whole) {
  return static_cast<int32_t>(clamp_to(whole - 256 * std::floor(whole * (1.0f / 256)), 0.0f, 255.0f));
}

/// The fifth-degree blend from 0 to 1, with two derivatives 0 at both ends.
inline float noise_blend(float t) { return t * t * t * (t * (6 * t - 15) + 10); }

/// The gradient that a lattice point's hash chooses, times the offset from that point.
inline float noise_gradient(int32_t hash, float x, float y, float z) {
  // Twelve directions, four of them twice. By bit masks instead of comparisons, which become branches.
  constexpr int32_t kFirstIsX = 0x30ff, kSecondIsY = 0x300f;
  const int32_t h = hash & 15;
  const float u = ((kFirstIsX >> h) & 1) != 0 ? x : y, v = ((kSecondIsY >> h) & 1) != 0 ? y : z;
  return ((h & 1) != 0 ? -u : u) + ((h & 2) != 0 ? -v : v);
}

}  // namespace detail

/// Noise in about [-1, 1], 0 at every point with whole coordinates, repeating after 256.
inline float perlin_noise(float x, float y, float z) {
  const float fx = std::floor(x), fy = std::floor(y), fz = std::floor(z);
  const int32_t ix = detail::noise_cell(fx), iy = detail::noise_cell(fy), iz = detail::noise_cell(fz);
  // Clamped for the sake of infinity minus infinity.
  const float dx = clamp_to(x - fx, 0.0f, 1.0f), dy = clamp_to(y - fy, 0.0f, 1.0f), dz = clamp_to(z - fz, 0.0f, 1.0f);
  const int32_t* const p = detail::kNoisePermutation;
  const int32_t a = p[ix] + iy, b = p[ix + 1] + iy;
  const int32_t a0 = p[a] + iz, a1 = p[a + 1] + iz, b0 = p[b] + iz, b1 = p[b + 1] + iz;
  const float wx = detail::noise_blend(dx), wy = detail::noise_blend(dy), wz = detail::noise_blend(dz);
  const float ex = dx - 1, ey = dy - 1, ez = dz - 1;
  const float y0z0 = lerp(wx, detail::noise_gradient(p[a0], dx, dy, dz), detail::noise_gradient(p[b0], ex, dy, dz));
  const float y1z0 = lerp(wx, detail::noise_gradient(p[a1], dx, ey, dz), detail::noise_gradient(p[b1], ex, ey, dz));
  const float y0z1 =
      lerp(wx, detail::noise_gradient(p[a0 + 1], dx, dy, ez), detail::noise_gradient(p[b0 + 1], ex, dy, ez));
  const float y1z1 =
      lerp(wx, detail::noise_gradient(p[a1 + 1], dx, ey, ez), detail::noise_gradient(p[b1 + 1], ex, ey, ez));
  return lerp(wz, lerp(wy, y0z0, y1z0), lerp(wy, y0z1, y1z1));
}

/// Noise in the plane: the slice z = 1/2.
inline float perlin_noise(float x, float y) { return perlin_noise(x, y, 0.5f); }

/// n points in the space of the noise.
struct NoisePoints {
  int n = 0;
  const float *x = nullptr, *y = nullptr, *z = nullptr;
  /// The squared size of what is seen at each point: 0 sees every octave, 1 none.
  const float* width2 = nullptr;
};

/// The most octaves that a sum takes; further ones would lie below the resolution of floats.
inline constexpr int kMaxOctaves = 64;

/// Fractional Brownian motion at n points, scaled by `scale` beforehand: the sum of `octaves` octaves of noise, each
/// `roughness` times as strong and 1.99 times as fine as the one before; octaves finer than the width fade out.
void fbm(const NoisePoints& points, float scale, int octaves, float roughness, float* out);

/// The same sum of absolute values; octaves that are too fine count with a mean of 0.2.
void turbulence(const NoisePoints& points, float scale, int octaves, float roughness, float* out);

}  // namespace whit
