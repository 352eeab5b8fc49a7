// Embree 3 or 4, whichever CMake found: the differences, and nothing else.
#pragma once

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>
#include <cmath>

#include "core/base/vec.h"

namespace whit {

/// Embree's assertions end the program for rays that are not finite or absurdly far away, and some of its ways to trace a
/// packet look at lanes that are switched off: whatever it is handed must pass this, or be a ray that hits nothing. A ray
/// that ends before it begins would look like one that was blocked.
[[gnu::always_inline]] inline bool is_traceable(const Vec3f& o, const Vec3f& d, float t_far) {
  constexpr float kFar = 1.8e18f;
  const float origin = std::max(std::max(std::abs(o.x), std::abs(o.y)), std::abs(o.z));
  const float direction = std::max(std::max(std::abs(d.x), std::abs(d.y)), std::abs(d.z));
  // The sums see a NaN, which max() may drop.
  const float sum = o.x + o.y + o.z + d.x + d.y + d.z;
  return (origin <= kFar) & (direction <= kFar) & (sum == sum) & (t_far >= 0);
}
#if RTC_VERSION_MAJOR >= 4
using EmbreeContext = RTCRayQueryContext;
constexpr RTCSceneFlags kQueryFilter = RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS;
#else
using EmbreeContext = RTCIntersectContext;
constexpr RTCSceneFlags kQueryFilter = RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;
#endif

/// Rays of a stream, which Embree 3 traces together by what bounds them all if neighbours are alike; laid out as its
/// packets are.
constexpr int kStream = 64;
constexpr bool kHasStreams = RTC_VERSION_MAJOR < 4;
struct alignas(64) RayStream {
  float org_x[kStream], org_y[kStream], org_z[kStream], tnear[kStream];
  float dir_x[kStream], dir_y[kStream], dir_z[kStream], time[kStream];
  float tfar[kStream];
  unsigned mask[kStream], id[kStream], flags[kStream];
};
struct alignas(64) HitStream {
  float Ng_x[kStream], Ng_y[kStream], Ng_z[kStream], u[kStream], v[kStream];
  unsigned primID[kStream], geomID[kStream], instID[RTC_MAX_INSTANCE_LEVEL_COUNT][kStream];
};
struct RayHitStream {
  RayStream ray;
  HitStream hit;
};

/// What Embree hands on to callbacks: its own context, and behind it ours.
struct QueryContext : EmbreeContext {
  const void* shadow =
      nullptr;  ///< Of occlusion queries that know what their rays end on: ShadowRays, core/accel/shadow_rays.h.
  int unshaded_by = -1;  ///< The same as RayEnd::unshaded_by, for rays that know no more than that.
};

/// One thread's queries with one coherence hint. trace() finds nearest hits for RTCRayHit and its packets, and
/// occlusion for RTCRay and its packets; `valid` has -1 for lanes to trace, 0 for others.
class EmbreeQuery {
 public:
#if RTC_VERSION_MAJOR >= 4
  explicit EmbreeQuery(bool coherent) {
    const RTCRayQueryFlags flags = coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
    rtcInitIntersectArguments(&intersect_);
    rtcInitOccludedArguments(&occluded_);
    intersect_.flags = flags;
    occluded_.flags = flags;
    rtcInitRayQueryContext(&context_);
    intersect_.context = occluded_.context = &context_;
  }
  /// The analytic shape that does not hide its own points from the rays of this query; -1 for none.
  void set_unshaded_by(int shape) { context_.unshaded_by = shape; }
  /// Hands `shadow` to the callbacks of occlusion queries, and has hits of triangles asked of a filter unless it is null.
  void set_shadow(const void* shadow, RTCFilterFunctionN filter) {
    context_.shadow = shadow;
    occluded_.filter = filter;
    if (filter) occluded_.flags = occluded_.flags | RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER;
  }
  void trace(const int*, RTCScene scene, RTCRayHit& ray) { rtcIntersect1(scene, &ray, &intersect_); }
  void trace(const int* valid, RTCScene scene, RTCRayHit4& rays) { rtcIntersect4(valid, scene, &rays, &intersect_); }
  void trace(const int* valid, RTCScene scene, RTCRayHit8& rays) { rtcIntersect8(valid, scene, &rays, &intersect_); }
  void trace(const int* valid, RTCScene scene, RTCRayHit16& rays) { rtcIntersect16(valid, scene, &rays, &intersect_); }
  void trace(const int*, RTCScene, RayHitStream&) {}  // has no streams
  void trace(const int*, RTCScene scene, RTCRay& ray) { rtcOccluded1(scene, &ray, &occluded_); }
  void trace(const int* valid, RTCScene scene, RTCRay4& rays) { rtcOccluded4(valid, scene, &rays, &occluded_); }
  void trace(const int* valid, RTCScene scene, RTCRay8& rays) { rtcOccluded8(valid, scene, &rays, &occluded_); }
  void trace(const int* valid, RTCScene scene, RTCRay16& rays) { rtcOccluded16(valid, scene, &rays, &occluded_); }

 private:
  RTCIntersectArguments intersect_;
  RTCOccludedArguments occluded_;
  QueryContext context_;
#else
  explicit EmbreeQuery(bool coherent) {
    rtcInitIntersectContext(&context_);
    context_.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  }
  void set_unshaded_by(int shape) { context_.unshaded_by = shape; }
  void set_shadow(const void* shadow, RTCFilterFunctionN filter) {
    context_.shadow = shadow;
    context_.filter = filter;
  }
  void trace(const int*, RTCScene scene, RTCRayHit& ray) { rtcIntersect1(scene, &context_, &ray); }
  void trace(const int* valid, RTCScene scene, RTCRayHit4& rays) { rtcIntersect4(valid, scene, &context_, &rays); }
  void trace(const int* valid, RTCScene scene, RTCRayHit8& rays) { rtcIntersect8(valid, scene, &context_, &rays); }
  void trace(const int* valid, RTCScene scene, RTCRayHit16& rays) { rtcIntersect16(valid, scene, &context_, &rays); }
  /// Lanes that are switched off must end before they begin.
  void trace(const int*, RTCScene scene, RayHitStream& rays) {
    rtcIntersectNM(scene, &context_, reinterpret_cast<RTCRayHitN*>(&rays), kStream, 1, sizeof rays);
  }
  void trace(const int*, RTCScene scene, RTCRay& ray) { rtcOccluded1(scene, &context_, &ray); }
  void trace(const int* valid, RTCScene scene, RTCRay4& rays) { rtcOccluded4(valid, scene, &context_, &rays); }
  void trace(const int* valid, RTCScene scene, RTCRay8& rays) { rtcOccluded8(valid, scene, &context_, &rays); }
  void trace(const int* valid, RTCScene scene, RTCRay16& rays) { rtcOccluded16(valid, scene, &context_, &rays); }

 private:
  QueryContext context_;
#endif
};

}  // namespace whit
