// Maps from the unit square to disks and spheres.
#pragma once

#include "core/base/fastmath.h"
#include "core/base/vec.h"

namespace whit {

/// The unit disk from (u, v) in [0,1)^2, uniformly, squares about the centre going to circles; pbrt-v3's variant, in
/// which (u, 1/2) stays on the x axis. Source: Shirley and Chiu, A Low Distortion Map Between Disk and Square, 1997.
inline Vec2f concentric_disk(float u, float v) {
  const float x = 2 * u - 1, y = 2 * v - 1;
  const bool wide = std::abs(x) > std::abs(y);
  const float radius = wide ? x : y, other = wide ? y : x;
  // An eighth of a turn times other / radius; the centre is 0 at any angle.
  const SinCos a = sin_cos(0.25f * kPi * (other / (radius != 0 ? radius : 1.0f)));
  return {radius * (wide ? a.cos : a.sin), radius * (wide ? a.sin : a.cos)};
}

/// The unit sphere from (u, v) in [0,1)^2, uniformly; v = 0 is +z. Density 1/(4 pi).
inline Vec3f uniform_sphere(float u, float v) {
  const float sin_theta = 2 * safe_sqrt(v * (1 - v));  // sqrt(1 - z^2) without cancellation
  const SinCos phi = sin_cos_2pi(u);
  return {sin_theta * phi.cos, sin_theta * phi.sin, 1 - 2 * v};
}

/// The hemisphere around +z from (u, v) in [0,1)^2, in proportion to the cosine. Density cos / pi.
inline Vec3f cosine_hemisphere(float u, float v) {
  const float r = safe_sqrt(u);
  const SinCos phi = sin_cos_2pi(v);
  return {r * phi.cos, r * phi.sin, safe_sqrt(1 - u)};
}

/// The hemisphere around +z, uniformly. Density 1/(2 pi).
inline Vec3f uniform_hemisphere(float u, float v) {
  const float sin_theta = safe_sqrt(1 - u * u);
  const SinCos phi = sin_cos_2pi(v);
  return {sin_theta * phi.cos, sin_theta * phi.sin, u};
}

/// The k-th point of a lattice in [0,1)^2 that begins at `first`: steps by powers of the inverse plastic number, which
/// leave no large gaps at any count. Source: Roberts, The Unreasonable Effectiveness of Quasirandom Sequences, 2018.
inline Vec2f lattice_point(const Vec2f& first, int k) {
  const auto step = [k](double x) { return static_cast<float>(k * x - std::floor(k * x)); };
  const auto wrapped = [](float x) { return x < 1 ? x : x - 1; };
  return {wrapped(first.x + step(0.7548776662466927)), wrapped(first.y + step(0.5698402909980532))};
}

}  // namespace whit
