// Surface interaction: from hits to points, normals and derivatives, in batches.
#pragma once

#include "core/batch/arena.h"
#include "core/batch/shading.h"
#include "core/scene/scene.h"

namespace whit {

/// The direction of the differential rays of a ray that has none: its footprints are exactly 0. (Differential rays that
/// equal the ray itself would not do: roundings make footprints of 1e-7 of them, and bump maps divide by those.)
inline constexpr Vec3f kNoDifferential{0, 0, 0};

/// n hits with the rays that made them, grouped by SceneShape::sort_key; render space.
struct SurfaceHits {
  int n = 0;
  Vec3Lanes o, d;
  float *t = nullptr, *u = nullptr, *v = nullptr;
  int32_t *shape = nullptr, *instance = nullptr;
  uint32_t* prim = nullptr;
  const float* time = nullptr;  ///< In [0,1] over the transform times; null when nothing moves.
  /// Null when no effect needs differentials; directions of kNoDifferential where a ray has none.
  Vec3Lanes rx_o, rx_d, ry_o, ry_d;

  float time_of(int i) const { return compiled_in(Effect::MotionBlur) && time ? time[i] : 0.0f; }
  bool has_differentials() const { return kKnowsDifferentials && rx_o; }
};

/// Computes the shading batch of the hits. Derivatives of normals and footprints exist when the hits carry
/// differential rays. Arrays come from `arena`.
ShadingBatch compute_surfaces(const Scene& scene, const SurfaceHits& hits, Arena& arena);

/// Moves a point off its surface along the geometric normal, to the side of `w`, by the bound on its error,
/// rounding outward (Pharr, Jakob, Humphreys, PBR 3e, section 3.9.5).
inline Vec3f offset_origin(const Vec3f& p, const Vec3f& error, const Vec3f& n, const Vec3f& w) {
  const float d = std::abs(n.x) * error.x + std::abs(n.y) * error.y + std::abs(n.z) * error.z;
  const float side = n.x * w.x + n.y * w.y + n.z * w.z < 0 ? -d : d;
  const Vec3f o(side * n.x, side * n.y, side * n.z);
  // One more unit in the last place, away from the surface, stands for rounding the sum.
  constexpr float kUlp = 1.2e-7f;
  const auto away = [](float q, float move) {
    const float step = std::abs(q) * kUlp;
    return q + (move > 0 ? step : move < 0 ? -step : 0.0f);
  };
  return {away(p.x + o.x, o.x), away(p.y + o.y, o.y), away(p.z + o.z, o.z)};
}

}  // namespace whit
