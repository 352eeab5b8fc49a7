// Surface points of a batch: what materials and textures are evaluated at.
#pragma once

#include <tuple>
#include <vector>

#include "core/base/effect.h"
#include "core/batch/arena.h"
#include "core/batch/lanes.h"
#include "core/batch/stage_clock.h"

namespace whit {

class Plugin;

/// n surface points, structure of arrays. All positions and vectors are in render space (camera-relative,
/// scaled world space, see core/base/render_space.h); normals are unit vectors.
struct ShadingBatch {
  int n = 0;
  Arena* arena = nullptr;             ///< Scratch of the worker that shades this batch.
  StageClock* clock = nullptr;        ///< Runs while a render is timed; null otherwise.
  int64_t* texture_values = nullptr;  ///< Counts the points that textures are evaluated at; null where nobody does.
  /// Where not null, textures note here that they were asked for: a run over no points, see Material::lobes().
  std::vector<const Plugin*>* textures_asked = nullptr;
  Vec3Lanes p;                       ///< Point on the surface.
  Vec3Lanes p_error;                 ///< Bound on the absolute error of p, per component, >= 0.
  Vec3Lanes wo;                      ///< Unit direction towards where the ray came from.
  Vec3Lanes ng;                      ///< Geometric normal, oriented by pbrt's rule, see SceneShape::flips.
  Vec3Lanes ns;                      ///< Shading normal, in the hemisphere of ng.
  Vec3Lanes dpdu, dpdv;              ///< Shading partial derivatives of p (pbrt's shading.dpdu, shading.dpdv).
  Vec3Lanes dndu, dndv;              ///< Shading normal derivatives; null unless differentials or bumps are live.
  float *u = nullptr, *v = nullptr;  ///< Surface parameters.
  /// Screen-space derivatives of (u, v) and p, over one sample's footprint; null when no effect needs them.
  float *dudx = nullptr, *dvdx = nullptr, *dudy = nullptr, *dvdy = nullptr;
  Vec3Lanes dpdx, dpdy;
  uint8_t* flips = nullptr;  ///< SceneShape::flips, 1 where normals flip.
  /// The second set of (u, v), which is the first where a shape has no other, and its derivatives, as far as the first has
  /// them; and the colours and alphas of vertices, 1 where a shape has none. Null where nobody asks (MeshAttributes).
  float *u1 = nullptr, *v1 = nullptr;
  float *du1du = nullptr, *dv1du = nullptr, *du1dv = nullptr, *dv1dv = nullptr;
  float *du1dx = nullptr, *dv1dx = nullptr, *du1dy = nullptr, *dv1dy = nullptr;
  RGBLanes color;
  float* color_alpha = nullptr;

  static constexpr auto fields() {
    using S = ShadingBatch;
    return std::tuple(&S::p, &S::p_error, &S::wo, &S::ng, &S::ns, &S::dpdu, &S::dpdv, &S::dndu, &S::dndv, &S::u, &S::v,
                      &S::dudx, &S::dvdx, &S::dudy, &S::dvdy, &S::dpdx, &S::dpdy, &S::flips, &S::u1, &S::v1, &S::du1du,
                      &S::dv1du, &S::du1dv, &S::dv1dv, &S::du1dx, &S::dv1dx, &S::du1dy, &S::dv1dy, &S::color,
                      &S::color_alpha);
  }

  bool has_footprint() const { return kKnowsDifferentials && dudx != nullptr; }

  /// Enough arena for no points: a material or texture that is asked what it is made of.
  static constexpr size_t kNoPoints = 4096;

  /// The points [first, first + count) as a batch of their own.
  ShadingBatch range(int first, int count) const;
};

}  // namespace whit
