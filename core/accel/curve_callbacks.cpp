// Curves that face the ray (core/accel/curve.h), for Embree.

#include <limits>

#include "core/accel/embree_geometry.h"
#include "core/accel/shadow_rays.h"

namespace whit {
namespace {

/// Whether a curve, which faces the ray, is on its end or behind it: the distance is known to a few units of the largest
/// number that went into it.
bool is_at_end(const RayLanes& rays, double t, unsigned id) {
  const Vec3f o = rays.o[static_cast<int>(id)];
  const double t_max = static_cast<double>(rays.t_max[id]);
  const double largest = static_cast<double>(std::abs(o.x) + std::abs(o.y) + std::abs(o.z)) + t_max;
  return t >= t_max - 4.8e-7 * largest;
}

void curve_piece_bounds(const RTCBoundsFunctionArguments* args) {
  const auto& user = *static_cast<const GeometryUser*>(args->geometryUserPtr);
  set_bounds(curve_bounds(user.curves, args->primID), *args->bounds_o);
}

/// Meets a packet with a piece of a curve and hands what the alpha test leaves standing to accept(lane, hit).
template <class Accept>
void trace_curve(const GeometryUser& user, unsigned piece, RTCRayN* rays, const int* valid, unsigned width, bool shadow,
                 const Accept& accept) {
  CurveHit hits[kMaxCurveRays];
  const CurveRays lanes{static_cast<int>(width),        valid,
                        &RTCRayN_org_x(rays, width, 0), &RTCRayN_org_y(rays, width, 0),
                        &RTCRayN_org_z(rays, width, 0), &RTCRayN_dir_x(rays, width, 0),
                        &RTCRayN_dir_y(rays, width, 0), &RTCRayN_dir_z(rays, width, 0),
                        &RTCRayN_tnear(rays, width, 0), &RTCRayN_tfar(rays, width, 0)};
  uint32_t found = intersect_curve(user.curves, piece, lanes, hits);
  for (; found; found &= found - 1) {
    const int i = __builtin_ctz(found);
    const CurveHit& hit = hits[i];
    if (user.alpha) {
      const float t = static_cast<float>(hit.t);
      const Vec3f p(lanes.ox[i] + t * lanes.dx[i], lanes.oy[i] + t * lanes.dy[i], lanes.oz[i] + t * lanes.dz[i]);
      if (user.alpha->cut(user.curves.segment_of(piece), hit.u, hit.v, p, shadow)) continue;
    }
    accept(static_cast<unsigned>(i), hit);
  }
}

void curve_intersect(const RTCIntersectFunctionNArguments* args) {
  const auto& user = *static_cast<const GeometryUser*>(args->geometryUserPtr);
  const unsigned width = args->N;
  RTCRayN* rays = RTCRayHitN_RayN(args->rayhit, width);
  RTCHitN* hits = RTCRayHitN_HitN(args->rayhit, width);
  trace_curve(user, args->primID, rays, args->valid, width, false, [&](unsigned i, const CurveHit& hit) {
    RTCRayN_tfar(rays, width, i) = static_cast<float>(hit.t);
    RTCHitN_u(hits, width, i) = hit.u;
    RTCHitN_v(hits, width, i) = hit.v;
    RTCHitN_primID(hits, width, i) = user.curves.segment_of(args->primID);
    RTCHitN_geomID(hits, width, i) = args->geomID;
    RTCHitN_instID(hits, width, i, 0) = args->context->instID[0];
  });
}

void curve_occluded(const RTCOccludedFunctionNArguments* args) {
  const auto& user = *static_cast<const GeometryUser*>(args->geometryUserPtr);
  const ShadowRays* shadow = shadow_of(args->context);
  trace_curve(user, args->primID, args->ray, args->valid, args->N, true, [&](unsigned i, const CurveHit& hit) {
    if (shadow && is_at_end(shadow->rays, hit.t, RTCRayN_id(args->ray, args->N, i))) return;
    RTCRayN_tfar(args->ray, args->N, i) = -std::numeric_limits<float>::infinity();
  });
}

}  // namespace

void set_curve_callbacks(RTCGeometry geometry) {
  rtcSetGeometryBoundsFunction(geometry, curve_piece_bounds, nullptr);
  rtcSetGeometryIntersectFunction(geometry, curve_intersect);
  rtcSetGeometryOccludedFunction(geometry, curve_occluded);
}

}  // namespace whit
