// Analytic shapes in double precision, for Embree.

#include <cmath>
#include <cstring>
#include <limits>

#include "core/accel/embree_geometry.h"
#include "core/accel/reach.h"
#include "core/accel/shadow_rays.h"
#include "core/base/box.h"

namespace whit {
namespace {

constexpr int kWidth = 16;

void analytic_bounds(const RTCBoundsFunctionArguments* args) {
  *args->bounds_o = static_cast<const GeometryUser*>(args->geometryUserPtr)->bounds;
}

/// Whether any valid ray reaches a box. Embree asks this of the boxes of a tree, but not where one shape is all there
/// is in it; a callback that begins in double precision costs ten times as much.
bool any_reaches(const RTCRayN* const_rays, const int* valid, unsigned width, const RTCBounds& box) {
  RTCRayN* rays = const_cast<RTCRayN*>(const_rays);  // Embree's accessors know no const
  const float *ox = &RTCRayN_org_x(rays, width, 0), *oy = &RTCRayN_org_y(rays, width, 0);
  const float *oz = &RTCRayN_org_z(rays, width, 0), *dx = &RTCRayN_dir_x(rays, width, 0);
  const float *dy = &RTCRayN_dir_y(rays, width, 0), *dz = &RTCRayN_dir_z(rays, width, 0);
  const float *t_near = &RTCRayN_tnear(rays, width, 0), *t_far = &RTCRayN_tfar(rays, width, 0);
  int any = 0;
#pragma omp simd reduction(| : any)
  for (unsigned i = 0; i < width; ++i) {
    const Vec3f o(ox[i], oy[i], oz[i]), inverse(1 / dx[i], 1 / dy[i], 1 / dz[i]);
    any |= valid[i] & -static_cast<int>(reaches(box, o, inverse, t_near[i], t_far[i]));
  }
  return any != 0;
}

/// The valid rays of an Embree packet in an analytic shape's object space.
struct ObjectPacket {
  int n = 0;
  int lane[kWidth];
  double ox[kWidth], oy[kWidth], oz[kWidth], dx[kWidth], dy[kWidth], dz[kWidth], t_min[kWidth], t[kWidth];

  ObjectPacket(RTCRayN* rays, const int* valid, unsigned width, const AnalyticShape& shape) {
    const Mat4d& m = shape.scene_to_object();
    for (unsigned i = 0; i < width; ++i) {
      if (!valid[i]) continue;
      const Vec3d o = transform_point(
          m, {RTCRayN_org_x(rays, width, i), RTCRayN_org_y(rays, width, i), RTCRayN_org_z(rays, width, i)});
      const Vec3d d = transform_vector(
          m, {RTCRayN_dir_x(rays, width, i), RTCRayN_dir_y(rays, width, i), RTCRayN_dir_z(rays, width, i)});
      ox[n] = o.x, oy[n] = o.y, oz[n] = o.z, dx[n] = d.x, dy[n] = d.y, dz[n] = d.z;
      t_min[n] = RTCRayN_tnear(rays, width, i);
      t[n] = RTCRayN_tfar(rays, width, i);
      lane[n++] = static_cast<int>(i);
    }
  }
  void intersect(const AnalyticShape& shape) { shape.intersect({n, ox, oy, oz, dx, dy, dz, t_min, t}); }
};

/// Whether ray k of a packet meets the shape before its end.
bool meets_before_end(const ShadowRays& shadow, const GeometryUser& user, const ObjectPacket& packet, int k,
                      unsigned id, unsigned instance, float time) {
  const RayLanes& rays = shadow.rays;
  const AnalyticShape& shape = *user.analytic;
  const int lane = static_cast<int>(id);
  const double t = packet.t[k], t_end = static_cast<double>(rays.t_max[lane]);
  if (shadow.end(id).on == RayEnd::On::Nothing) return t < t_end;
  // Only an origin as near to the surface as the end gets here with a surface that the end is on.
  if (t < 0.5 * t_end) return true;
  if (&shape == shadow.end(id).analytic && std::abs(t - t_end) < 0.1 * kNearEnd) return false;
  const Vec3d o(packet.ox[k], packet.oy[k], packet.oz[k]), d(packet.dx[k], packet.dy[k], packet.dz[k]);
  const Box3d box = shape.object_bounds();
  const Vec3d near = o + d * t_end, room = box.size() * 1e-3 + Vec3d(1e-3 * box.size().length());
  if (!Box3d(box.min - room, box.max + room).intersects(near)) return t < t_end;
  const SurfacePoint at = shape.surface(o + d * t);
  Mat4d to_render = shape.object_to_scene();
  ShapeHit hit{at.p, at.dpdu.cross(at.dpdv), d, shape.scene_to_object(), rounding_of_size(box, to_render)};
  if (instance != RTC_INVALID_GEOMETRY_ID) {
    const Mat4d placed = instance_to_render(shadow.world, instance, time);
    to_render = to_render * placed;
    hit.from_render = to_render.inverse();
    hit.error =
        rounding_of_size(box, to_render) +
        2 * kRounding * (transform_point(to_render, at.p).length() + transform_point(placed, {0, 0, 0}).length());
  }
  return hit.hides(end_point(rays, lane), shadow.end(id).error);
}

/// Finds each lane's nearest hit that the alpha test and stands(packet, k) leave standing, and hands it to accept(lane,
/// t).
template <class Stands, class Accept>
void trace_analytic(const GeometryUser& user, RTCRayN* rays, const int* valid, unsigned width, bool shadow,
                    const Stands& stands, const Accept& accept) {
  if (!any_reaches(rays, valid, width, user.bounds)) return;
  ObjectPacket packet(rays, valid, width, *user.analytic);
  double t_far[kWidth];
  std::memcpy(t_far, packet.t, sizeof(double) * static_cast<size_t>(packet.n));
  // A cut-out point sends its ray on to the next root of the quadric, of which there are at most two.
  for (int round = 0; round < 3 && packet.n > 0; ++round) {
    packet.intersect(*user.analytic);
    int left = 0;
    for (int k = 0; k < packet.n; ++k) {
      // As floats, which is what Embree keeps: of surfaces that coincide the same one is met everywhere, whatever the
      // distance rounds to.
      if (!(static_cast<float>(packet.t[k]) < static_cast<float>(t_far[k]))) continue;
      const int i = packet.lane[k];
      bool cut = !stands(packet, k);
      if (user.alpha && !cut) {
        const Vec3d p = transform_point(user.analytic->object_to_scene(),
                                        Vec3d(packet.ox[k], packet.oy[k], packet.oz[k]) +
                                            packet.t[k] * Vec3d(packet.dx[k], packet.dy[k], packet.dz[k]));
        cut = user.alpha->cut(0, 0, 0, Vec3f(p), shadow);
      }
      if (!cut) {
        accept(static_cast<unsigned>(i), packet.t[k]);
        continue;
      }
      packet.ox[left] = packet.ox[k], packet.oy[left] = packet.oy[k], packet.oz[left] = packet.oz[k];
      packet.dx[left] = packet.dx[k], packet.dy[left] = packet.dy[k], packet.dz[left] = packet.dz[k];
      packet.t_min[left] = std::nextafter(packet.t[k], t_far[k]);
      packet.t[left] = t_far[left] = t_far[k];
      packet.lane[left++] = i;
    }
    packet.n = left;
  }
}

void analytic_intersect(const RTCIntersectFunctionNArguments* args) {
  const auto& user = *static_cast<const GeometryUser*>(args->geometryUserPtr);
  const unsigned width = args->N;
  RTCRayN* rays = RTCRayHitN_RayN(args->rayhit, width);
  RTCHitN* hits = RTCRayHitN_HitN(args->rayhit, width);
  const auto always = [](const ObjectPacket&, int) { return true; };
  trace_analytic(user, rays, args->valid, width, false, always, [&](unsigned i, double t) {
    RTCRayN_tfar(rays, width, i) = static_cast<float>(t);
    RTCHitN_u(hits, width, i) = RTCHitN_v(hits, width, i) = 0;
    RTCHitN_primID(hits, width, i) = args->primID;
    RTCHitN_geomID(hits, width, i) = args->geomID;
    RTCHitN_instID(hits, width, i, 0) = args->context->instID[0];
  });
}

void analytic_occluded(const RTCOccludedFunctionNArguments* args) {
  const auto& user = *static_cast<const GeometryUser*>(args->geometryUserPtr);
  const ShadowRays* shadow = shadow_of(args->context);
  const bool one_end = !shadow || !shadow->rays.ends;
  const int unshaded_by = !one_end ? -1
                          : shadow ? shadow->rays.end->unshaded_by
                                   : static_cast<const QueryContext*>(args->context)->unshaded_by;
  if (one_end && unshaded_by == user.unshaded_by_itself) return;
  const auto stands = [&](const ObjectPacket& packet, int k) {
    const auto lane = static_cast<unsigned>(packet.lane[k]);
    if (!one_end && shadow->end(RTCRayN_id(args->ray, args->N, lane)).unshaded_by == user.unshaded_by_itself)
      return false;
    return !shadow || meets_before_end(*shadow, user, packet, k, RTCRayN_id(args->ray, args->N, lane),
                                       args->context->instID[0], RTCRayN_time(args->ray, args->N, lane));
  };
  trace_analytic(user, args->ray, args->valid, args->N, true, stands, [&](unsigned i, double) {
    RTCRayN_tfar(args->ray, args->N, i) = -std::numeric_limits<float>::infinity();
  });
}

}  // namespace

RTCBounds bounds_of(const AnalyticShape& shape) {
  RTCBounds out;
  set_bounds(transform_box(shape.object_to_scene(), shape.object_bounds()), out);
  return out;
}

void set_analytic_callbacks(RTCGeometry geometry) {
  rtcSetGeometryBoundsFunction(geometry, analytic_bounds, nullptr);
  rtcSetGeometryIntersectFunction(geometry, analytic_intersect);
  rtcSetGeometryOccludedFunction(geometry, analytic_occluded);
}

}  // namespace whit
