// Surface interaction: from hits to points, normals and derivatives, in batches.
#pragma once

#include "core/batch/arena.h"
#include "core/batch/rays.h"
#include "core/batch/shading.h"
#include "core/scene/scene.h"

namespace whit {

/// Rays and their hits, grouped by SceneShape::sort_key.
struct SurfaceHits : Rays, Hits {
  float time_of(int i) const { return compiled_in(Effect::MotionBlur) && time ? time[i] : 0.0f; }
  bool has_differentials() const { return kKnowsDifferentials && differentials; }
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
