// The shadow rays of a call on their way through Embree: how far they are traced, and what callbacks know of their ends.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/accel/accel.h"
#include "core/accel/embree.h"
#include "core/base/fastmath.h"

namespace whit {

/// In place of a number of a shape that does not hide its own points: rays do not all end on such a one.
constexpr int kNobody = -3;

/// For Embree's callbacks; a ray's id is its number among them.
struct ShadowRays {
  RTCScene world;
  const RayLanes& rays;

  const RayEnd& end(unsigned id) const { return end_of(rays, static_cast<int>(id)); }
};

/// Null when the rays of the query end at their distances.
inline const ShadowRays* shadow_of(const EmbreeContext* context) {
  return static_cast<const ShadowRays*>(static_cast<const QueryContext*>(context)->shadow);
}

/// How far beyond its end a ray is traced, for what decides there knows better than floats where the end is
/// (core/accel/ray_end.h). Of a plane that nothing else is near to, t_max is in front.
inline void lengthen_to(const RayEnd& end, const Vec3Lanes& d, int n, float* t_far) {
  if (end.on == RayEnd::On::Nothing || (end.on == RayEnd::On::Plane && !end.touched())) return;
  constexpr auto kRoom = static_cast<float>(kNearEnd / 2);
  constexpr int kBlock = 16;
  const Touching& touching = end.touching;
  for (int first = 0; first < n; first += kBlock) {
    const int count = std::min(kBlock, n - first);
    const Vec3Lanes along = d.from(first);
    alignas(64) float sine[kBlock];
    for (int i = 0; i < count; ++i) sine[i] = touching.normals.empty() ? 0.0f : 1.0f;
    for (const Vec3f& normal : touching.normals) {
      for (int i = 0; i < count; ++i) sine[i] = min_of(sine[i], std::abs(dot(normal, along[i])));
    }
    float* const t = t_far + first;
    for (int i = 0; i < count; ++i) t[i] += min_of(t[i], touching.off / max_of(sine[i], 1e-30f)) + kRoom;
  }
}

/// The shape that hides its own points from none of rays [first, first + count); kNobody if there is no such.
inline int unshaded_by(const RayLanes& rays, int first, int count) {
  if (!rays.ends) return rays.end ? rays.end->unshaded_by : kNobody;
  const int shape = rays.ends[first]->unshaded_by;
  for (int i = first + 1; i < first + count; ++i)
    if (rays.ends[i]->unshaded_by != shape) return kNobody;
  return shape;
}

/// The ends of the shadow rays of a call: one, or one for each.
struct ShadowEnds {
  const RayLanes& rays;
  bool any = false, touched = false;  ///< Whether some ray ends on something; on something that is touched.

  explicit ShadowEnds(const RayLanes& r) : rays(r) {
    for (int i = 0; i < (rays.ends ? rays.n : rays.end ? 1 : 0); ++i) {
      const RayEnd& end = end_of(rays, i);
      any |= end.on != RayEnd::On::Nothing;
      touched |= end.on != RayEnd::On::Nothing && end.touched();
    }
  }
  void lengthen(int first, int count, float* t_far) const {
    if (!any) return;
    if (!rays.ends) return lengthen_to(*rays.end, rays.d.from(first), count, t_far);
    for (int i = 0; i < count; ++i) lengthen_to(*rays.ends[first + i], rays.d.from(first + i), 1, t_far + i);
  }
};

}  // namespace whit
