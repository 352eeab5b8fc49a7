// Curves that face the ray, as pbrt-v3 traces them: cubic Bezier segments in a space of their own, in which they are as
// wide as they say from wherever they are seen. (Embree's flat curves ignore what is within a diameter of a ray's
// origin, which opens the shadow at a curve's foot, and its normal-oriented ones are surfaces, which pbrt's ribbons are
// not: theirs is a width that shrinks as they turn away.)
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/base/vec.h"

namespace whit {

/// Cubic Bezier curves. Arrays must outlive the Accel.
struct CurveView {
  const float* control_points = nullptr;  ///< 4 x (x, y, z, half width) per segment, the width linear in u.
  size_t segment_count = 0;
  const float* normals = nullptr;  ///< Ribbons: 4 x 3 per segment (CurveData::normals); null for the others.
  int split_depth = 0;             ///< Every segment is bounded and traced as 2^split_depth pieces.
  Mat4d to_group, from_group;      ///< The curves' own space to their group's, and back.

  size_t piece_count() const { return segment_count << split_depth; }
  uint32_t segment_of(size_t piece) const { return static_cast<uint32_t>(piece >> split_depth); }
};

/// The bounds of a piece in its group's space.
Box3d curve_bounds(const CurveView& curves, size_t piece);

/// A packet's rays in the group's space, as Embree keeps them. No more than kMaxCurveRays.
inline constexpr int kMaxCurveRays = 16;
struct CurveRays {
  int n = 0;
  const int* valid = nullptr;  ///< 0: leave this one out.
  const float *ox = nullptr, *oy = nullptr, *oz = nullptr;
  const float *dx = nullptr, *dy = nullptr, *dz = nullptr;
  const float *t_min = nullptr, *t_max = nullptr;
};

struct CurveHit {
  double t;    ///< In units of the direction's length.
  float u, v;  ///< Along the segment, and across it: 0.5 on its centre line.
};

/// Meets rays with one piece. Returns the rays that hit as bits.
uint32_t intersect_curve(const CurveView& curves, size_t piece, const CurveRays& rays, CurveHit* hits);

/// The normal of a ribbon's segment at u: turned at constant speed from one end's to the other's.
Vec3d ribbon_normal(const float* normals, double u);

}  // namespace whit
