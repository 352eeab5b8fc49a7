// Triangles in double precision (core/accel/exact_triangle.h), for Embree.

#include <limits>

#include "core/accel/embree_geometry.h"
#include "core/accel/shadow_rays.h"

namespace whit {
namespace {

/// Whether a ray that meets the triangle at t meets it before its end.
bool meets_before_end(const ShadowRays& shadow, const ExactTriangle& triangle, double t, unsigned id, unsigned instance,
                      float time) {
  const RayLanes& rays = shadow.rays;
  const int lane = static_cast<int>(id);
  // Only an origin as near to the triangle as the end gets here with a triangle that the end is on.
  if (t < 0.5 * static_cast<double>(rays.t_max[lane])) return true;
  Mat4d placed;
  const bool instanced = instance != RTC_INVALID_GEOMETRY_ID;
  if (instanced) placed = instance_to_render(shadow.world, instance, time);
  return end_triangle(triangle, instanced ? &placed : nullptr)
      .separates(Vec3d(rays.o[lane]), end_point(rays, lane), shadow.end(id).error);
}

void exact_bounds(const RTCBoundsFunctionArguments* args) {
  set_bounds(bounds_of(static_cast<const GeometryUser*>(args->geometryUserPtr)->triangles[args->primID]),
             *args->bounds_o);
}

/// Meets a packet with a triangle in double precision and hands what the alpha test and stands(lane, t) leave standing to
/// accept(lane, t, weights).
template <class Stands, class Accept>
void trace_exact(const GeometryUser& user, unsigned prim, RTCRayN* rays, const int* valid, unsigned width, bool shadow,
                 const Stands& stands, const Accept& accept) {
  const ExactTriangle& triangle = user.triangles[prim];
  for (unsigned i = 0; i < width; ++i) {
    if (!valid[i]) continue;
    const Vec3d o(RTCRayN_org_x(rays, width, i), RTCRayN_org_y(rays, width, i), RTCRayN_org_z(rays, width, i));
    const Vec3d d(RTCRayN_dir_x(rays, width, i), RTCRayN_dir_y(rays, width, i), RTCRayN_dir_z(rays, width, i));
    const double t = plane_distance(triangle, o, d);
    // As floats, for the reason given in trace_analytic(), core/accel/analytic_callbacks.cpp.
    if (!(t > static_cast<double>(RTCRayN_tnear(rays, width, i)) &&
          static_cast<float>(t) < RTCRayN_tfar(rays, width, i)) ||
        !is_inside(triangle, o, d, t) || !stands(i, t)) {
      continue;
    }
    const Vec3d p = o + t * d;
    const Vec2f weights(weights_at(triangle, p));
    if (user.alpha && user.alpha->cut(prim, weights.x, weights.y, Vec3f(p), shadow)) continue;
    accept(i, static_cast<float>(t), weights);
  }
}

void exact_intersect(const RTCIntersectFunctionNArguments* args) {
  const auto& user = *static_cast<const GeometryUser*>(args->geometryUserPtr);
  const unsigned width = args->N;
  RTCRayN* rays = RTCRayHitN_RayN(args->rayhit, width);
  RTCHitN* hits = RTCRayHitN_HitN(args->rayhit, width);
  const auto always = [](unsigned, double) { return true; };
  trace_exact(user, args->primID, rays, args->valid, width, false, always,
              [&](unsigned i, float t, const Vec2f& weights) {
                RTCRayN_tfar(rays, width, i) = t;
                RTCHitN_u(hits, width, i) = weights.x;
                RTCHitN_v(hits, width, i) = weights.y;
                RTCHitN_primID(hits, width, i) = args->primID;
                RTCHitN_geomID(hits, width, i) = args->geomID;
                RTCHitN_instID(hits, width, i, 0) = args->context->instID[0];
              });
}

void exact_occluded(const RTCOccludedFunctionNArguments* args) {
  const auto& user = *static_cast<const GeometryUser*>(args->geometryUserPtr);
  const ShadowRays* shadow = shadow_of(args->context);
  const auto stands = [&](unsigned i, double t) {
    return !shadow || meets_before_end(*shadow, user.triangles[args->primID], t, RTCRayN_id(args->ray, args->N, i),
                                       args->context->instID[0], RTCRayN_time(args->ray, args->N, i));
  };
  trace_exact(user, args->primID, args->ray, args->valid, args->N, true, stands, [&](unsigned i, float, const Vec2f&) {
    RTCRayN_tfar(args->ray, args->N, i) = -std::numeric_limits<float>::infinity();
  });
}

}  // namespace

EndTriangle end_triangle(const ExactTriangle& triangle, const Mat4d* to_render) {
  EndTriangle here{triangle.a, triangle.b, triangle.c, Vec3d(triangle.error)};
  if (to_render) {
    for (Vec3d* corner : {&here.a, &here.b, &here.c}) *corner = transform_point(*to_render, *corner);
  }
  return here;
}

void set_exact_callbacks(RTCGeometry geometry) {
  rtcSetGeometryBoundsFunction(geometry, exact_bounds, nullptr);
  rtcSetGeometryIntersectFunction(geometry, exact_intersect);
  rtcSetGeometryOccludedFunction(geometry, exact_occluded);
}

}  // namespace whit
