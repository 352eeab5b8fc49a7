#include "core/accel/accel.h"

#include <fmt/format.h>

#include <atomic>
#include <cstring>
#include <functional>

#include "core/accel/embree.h"
#include "core/accel/replay.h"
#include "core/accel/second_look.h"
#include "core/base/box.h"

namespace whit {
namespace {

constexpr int kWidth = 16;

/// What Embree hands back to us with a user geometry or a filter call.
struct GeometryUser {
  const AnalyticShape* analytic = nullptr;
  const AlphaTest* alpha = nullptr;
  MeshView mesh{};
  CurveView curves{};
  const ExactTriangle* triangles = nullptr;
  RTCBounds bounds{};           ///< Of an analytic shape.
  int unshaded_by_itself = -2;  ///< The number of a shape that cannot shade itself; -2 is no shape, nor no target.
};

/// Rounded outward: a float box must hold what was bounded in double.
void set_bounds(const Box3d& box, RTCBounds& out) {
  const auto down = [](double v) { return std::nextafterf(static_cast<float>(v), -INFINITY); };
  const auto up = [](double v) { return std::nextafterf(static_cast<float>(v), INFINITY); };
  out = {down(box.min.x), down(box.min.y), down(box.min.z), 0, up(box.max.x), up(box.max.y), up(box.max.z), 0};
}

RTCBounds bounds_of(const AnalyticShape& shape) {
  RTCBounds out;
  set_bounds(transform_box(shape.object_to_scene(), shape.object_bounds()), out);
  return out;
}

void analytic_bounds(const RTCBoundsFunctionArguments* args) {
  *args->bounds_o = static_cast<const GeometryUser*>(args->geometryUserPtr)->bounds;
}

/// Whether any valid ray reaches a box. Embree asks this of the boxes of a tree, but not where one shape is all there
/// is in it; a callback that begins in double precision costs ten times as much. A NaN counts as reaching.
bool reaches(const RTCRayN* const_rays, const int* valid, unsigned width, const RTCBounds& box) {
  RTCRayN* rays = const_cast<RTCRayN*>(const_rays);  // Embree's accessors know no const
  const float *ox = &RTCRayN_org_x(rays, width, 0), *oy = &RTCRayN_org_y(rays, width, 0);
  const float *oz = &RTCRayN_org_z(rays, width, 0), *dx = &RTCRayN_dir_x(rays, width, 0);
  const float *dy = &RTCRayN_dir_y(rays, width, 0), *dz = &RTCRayN_dir_z(rays, width, 0);
  const float *t_near = &RTCRayN_tnear(rays, width, 0), *t_far = &RTCRayN_tfar(rays, width, 0);
  constexpr float kWiden = 1 + 1e-6f;
  int any = 0;
#pragma omp simd reduction(| : any)
  for (unsigned i = 0; i < width; ++i) {
    const auto low = [](float a, float b) { return b < a ? b : a; };
    const auto high = [](float a, float b) { return b > a ? b : a; };
    const float ix = 1 / dx[i], iy = 1 / dy[i], iz = 1 / dz[i];
    const float x0 = (box.lower_x - ox[i]) * ix, x1 = (box.upper_x - ox[i]) * ix;
    const float y0 = (box.lower_y - oy[i]) * iy, y1 = (box.upper_y - oy[i]) * iy;
    const float z0 = (box.lower_z - oz[i]) * iz, z1 = (box.upper_z - oz[i]) * iz;
    const float enter = high(high(low(x0, x1), low(y0, y1)), high(low(z0, z1), t_near[i]));
    const float leave = low(low(high(x0, x1), high(y0, y1)), low(high(z0, z1), t_far[i]));
    any |= valid[i] & -!(enter > leave * kWiden);
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

/// The shadow rays of a call, for Embree's callbacks; a ray's id is its number among them.
struct ShadowRays {
  RTCScene world;
  const RayLanes& rays;

  const RayEnd& end(unsigned id) const { return end_of(rays, static_cast<int>(id)); }
  bool meets_before_end(const GeometryUser& user, const ObjectPacket& packet, int k, unsigned id, unsigned instance,
                        float time) const;
  bool meets_before_end(const ExactTriangle& triangle, double t, unsigned id, unsigned instance, float time) const;
  bool meets_before_end(const GeometryUser& user, const RTCFilterFunctionNArguments* args, unsigned i) const;
  /// Whether a curve, which faces the ray, is on its end or behind it: the distance is known to a few units of the
  /// largest number that went into it.
  bool is_at_end(double t, unsigned id) const {
    const Vec3f o = rays.o[static_cast<int>(id)];
    const double t_max = static_cast<double>(rays.t_max[id]);
    const double largest = static_cast<double>(std::abs(o.x) + std::abs(o.y) + std::abs(o.z)) + t_max;
    return t >= t_max - 4.8e-7 * largest;
  }
};

/// Null when the rays of the query end at their distances.
const ShadowRays* shadow_of(const EmbreeContext* context) {
  return static_cast<const ShadowRays*>(static_cast<const QueryContext*>(context)->shadow);
}

/// Finds each lane's nearest hit that the alpha test and stands(packet, k) leave standing, and hands it to accept(lane,
/// t).
template <class Stands, class Accept>
void trace_analytic(const GeometryUser& user, RTCRayN* rays, const int* valid, unsigned width, bool shadow,
                    const Stands& stands, const Accept& accept) {
  if (!reaches(rays, valid, width, user.bounds)) return;
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
    return !shadow || shadow->meets_before_end(user, packet, k, RTCRayN_id(args->ray, args->N, lane),
                                               args->context->instID[0], RTCRayN_time(args->ray, args->N, lane));
  };
  trace_analytic(user, args->ray, args->valid, args->N, true, stands, [&](unsigned i, double) {
    RTCRayN_tfar(args->ray, args->N, i) = -std::numeric_limits<float>::infinity();
  });
}

void curve_piece_bounds(const RTCBoundsFunctionArguments* args) {
  const auto& user = *static_cast<const GeometryUser*>(args->geometryUserPtr);
  set_bounds(curve_bounds(user.curves, args->primID), *args->bounds_o);
}

/// Meets a packet with a piece of a curve and hands what the alpha test leaves standing to accept(lane, hit).
template <class Accept>
void trace_curve(const GeometryUser& user, unsigned piece, RTCRayN* rays, const int* valid, unsigned width, bool shadow,
                 const Accept& accept) {
  CurveHit hits[kWidth];
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
    if (shadow && shadow->is_at_end(hit.t, RTCRayN_id(args->ray, args->N, i))) return;
    RTCRayN_tfar(args->ray, args->N, i) = -std::numeric_limits<float>::infinity();
  });
}

void exact_bounds(const RTCBoundsFunctionArguments* args) {
  const ExactTriangle& t = static_cast<const GeometryUser*>(args->geometryUserPtr)->triangles[args->primID];
  Box3d box(t.a);
  box.extendBy(t.b), box.extendBy(t.c);
  const double reach = t.error + std::max({t.reach[0], t.reach[1], t.reach[2]});
  box.min -= Vec3d(reach), box.max += Vec3d(reach);
  set_bounds(box, *args->bounds_o);
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
    // As floats, for the reason given in trace_analytic().
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
    return !shadow || shadow->meets_before_end(user.triangles[args->primID], t, RTCRayN_id(args->ray, args->N, i),
                                               args->context->instID[0], RTCRayN_time(args->ray, args->N, i));
  };
  trace_exact(user, args->primID, args->ray, args->valid, args->N, true, stands, [&](unsigned i, float, const Vec2f&) {
    RTCRayN_tfar(args->ray, args->N, i) = -std::numeric_limits<float>::infinity();
  });
}

template <bool kShadow>
void alpha_filter(const RTCFilterFunctionNArguments* args) {
  const auto& user = *static_cast<const GeometryUser*>(args->geometryUserPtr);
  const unsigned width = args->N;
  for (unsigned i = 0; i < width; ++i) {
    if (!args->valid[i]) continue;
    const float t = RTCRayN_tfar(args->ray, width, i);
    const Vec3f p = Vec3f(RTCRayN_org_x(args->ray, width, i), RTCRayN_org_y(args->ray, width, i),
                          RTCRayN_org_z(args->ray, width, i)) +
                    t * Vec3f(RTCRayN_dir_x(args->ray, width, i), RTCRayN_dir_y(args->ray, width, i),
                              RTCRayN_dir_z(args->ray, width, i));
    if (user.alpha->cut(RTCHitN_primID(args->hit, width, i), RTCHitN_u(args->hit, width, i),
                        RTCHitN_v(args->hit, width, i), p, kShadow)) {
      args->valid[i] = 0;
    }
  }
}

/// Column-major, as Embree writes it.
Mat4d instance_to_render(RTCScene world, unsigned instance, float time) {
  float m[16];
  rtcGetGeometryTransform(rtcGetGeometry(world, instance), time, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, m);
  Mat4d out;
  for (int i = 0; i < 16; ++i) out[i / 4][i % 4] = static_cast<double>(m[i]);
  return out;
}

constexpr double kRounding = 0x1p-24;  ///< Half a unit in the last place of 1, in float.

Vec3d absolute(const Vec3d& v) { return {std::abs(v.x), std::abs(v.y), std::abs(v.z)}; }

/// A triangle in render space, with what rounding its vertices, and the matrix of its instance, may have moved it by.
EndTriangle end_triangle(const MeshView& mesh, unsigned triangle, const Mat4d* to_render) {
  Vec3d corner[3], largest(0, 0, 0), shift(0, 0, 0);
  for (int c = 0; c < 3; ++c) {
    const float* v = mesh.positions +
                     3 * static_cast<size_t>(mesh.indices[3 * static_cast<size_t>(triangle) + static_cast<size_t>(c)]);
    corner[c] = Vec3d(static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2]));
    const Vec3d a = absolute(corner[c]);
    largest = {std::max(largest.x, a.x), std::max(largest.y, a.y), std::max(largest.z, a.z)};
    if (to_render) corner[c] = transform_point(*to_render, corner[c]);
  }
  if (!to_render) return {corner[0], corner[1], corner[2], rounding_of(largest)};
  const Mat4d& m = *to_render;
  for (int k = 0; k < 3; ++k) {
    shift[k] = std::abs(m[3][k]);
    for (int j = 0; j < 3; ++j) shift[k] += 2 * std::abs(m[j][k]) * largest[j];
  }
  return {corner[0], corner[1], corner[2], shift * kRounding};
}

bool ShadowRays::meets_before_end(const GeometryUser& user, const RTCFilterFunctionNArguments* args, unsigned i) const {
  const unsigned width = args->N;
  const Vec3f d(RTCRayN_dir_x(args->ray, width, i), RTCRayN_dir_y(args->ray, width, i),
                RTCRayN_dir_z(args->ray, width, i));
  const Vec3f n(RTCHitN_Ng_x(args->hit, width, i), RTCHitN_Ng_y(args->hit, width, i),
                RTCHitN_Ng_z(args->hit, width, i));
  const auto id = static_cast<int>(RTCRayN_id(args->ray, width, i));
  const RayEnd& end = end_of(rays, id);
  if (end.on == RayEnd::On::Nothing) return true;
  // How far the end is behind the triangle's plane, in the space of its group, as far as floats tell.
  const float behind = (rays.t_max[id] - RTCRayN_tfar(args->ray, width, i)) * std::abs(n.dot(d)) / n.length();
  const float unsure = static_cast<float>(kNearEnd) * d.length();
  if (behind > unsure) return true;
  if (behind < -unsure) return false;
  const unsigned instance = args->context->instID[0];
  Mat4d placed;
  const bool instanced = instance != RTC_INVALID_GEOMETRY_ID;
  if (instanced) placed = instance_to_render(world, instance, RTCRayN_time(args->ray, width, i));
  return end_triangle(user.mesh, RTCHitN_primID(args->hit, width, i), instanced ? &placed : nullptr)
      .separates(Vec3d(rays.o[id]), end_point(rays, id), end.error);
}

bool ShadowRays::meets_before_end(const ExactTriangle& triangle, double t, unsigned id, unsigned instance,
                                  float time) const {
  const int lane = static_cast<int>(id);
  // As with analytic shapes, below.
  if (t < 0.5 * static_cast<double>(rays.t_max[lane])) return true;
  EndTriangle here{triangle.a, triangle.b, triangle.c, Vec3d(triangle.error)};
  if (instance != RTC_INVALID_GEOMETRY_ID) {
    const Mat4d placed = instance_to_render(world, instance, time);
    for (Vec3d* corner : {&here.a, &here.b, &here.c}) *corner = transform_point(placed, *corner);
  }
  return here.separates(Vec3d(rays.o[lane]), end_point(rays, lane), end(id).error);
}

bool ShadowRays::meets_before_end(const GeometryUser& user, const ObjectPacket& packet, int k, unsigned id,
                                  unsigned instance, float time) const {
  const AnalyticShape& shape = *user.analytic;
  const int lane = static_cast<int>(id);
  const double t = packet.t[k], t_end = static_cast<double>(rays.t_max[lane]);
  if (end(id).on == RayEnd::On::Nothing) return t < t_end;
  // Only an origin as near to the surface as the end gets here with a surface that the end is on.
  if (t < 0.5 * t_end) return true;
  if (&shape == end(id).analytic && std::abs(t - t_end) < 0.1 * kNearEnd) return false;
  const Vec3d o(packet.ox[k], packet.oy[k], packet.oz[k]), d(packet.dx[k], packet.dy[k], packet.dz[k]);
  const Box3d box = shape.object_bounds();
  const Vec3d near = o + d * t_end, room = box.size() * 1e-3 + Vec3d(1e-3 * box.size().length());
  if (!Box3d(box.min - room, box.max + room).intersects(near)) return t < t_end;
  const SurfacePoint at = shape.surface(o + d * t);
  Mat4d to_render = shape.object_to_scene();
  ShapeHit hit{at.p, at.dpdu.cross(at.dpdv), d, shape.scene_to_object(), rounding_of_size(box, to_render)};
  if (instance != RTC_INVALID_GEOMETRY_ID) {
    const Mat4d placed = instance_to_render(world, instance, time);
    to_render = to_render * placed;
    hit.from_render = to_render.inverse();
    hit.error =
        rounding_of_size(box, to_render) +
        2 * kRounding * (transform_point(to_render, at.p).length() + transform_point(placed, {0, 0, 0}).length());
  }
  return hit.hides(end_point(rays, lane), end(id).error);
}

/// Drops the hits of triangles that the end of their ray lies on, or that are behind it.
void end_filter(const RTCFilterFunctionNArguments* args) {
  const auto& user = *static_cast<const GeometryUser*>(args->geometryUserPtr);
  const ShadowRays& shadow = *shadow_of(args->context);
  for (unsigned i = 0; i < args->N; ++i) {
    if (args->valid[i] && !shadow.meets_before_end(user, args, i)) args->valid[i] = 0;
  }
}

/// How far beyond its end a ray is traced, for what decides there knows better than floats where the end is
/// (core/accel/ray_end.h). Of a plane that nothing else is near to, t_max is in front.
struct Beyond {
  float stretch = 1, room = 0;
  explicit Beyond(const RayEnd& end) {
    const bool touched = end.on != RayEnd::On::Nothing && end.touched;
    stretch = touched ? 2.0f : 1.0f;
    if (touched || (end.on != RayEnd::On::Nothing && end.on != RayEnd::On::Plane))
      room = static_cast<float>(kNearEnd / 2);
  }
};

/// The ends of the shadow rays of a call: one, or one for each.
struct ShadowEnds {
  const RayLanes& rays;
  bool any = false, touched = false;  ///< Whether some ray ends on something; on something that is touched.

  explicit ShadowEnds(const RayLanes& r) : rays(r) {
    for (int i = 0; i < (rays.ends ? rays.n : rays.end ? 1 : 0); ++i) {
      const RayEnd& end = end_of(rays, i);
      any |= end.on != RayEnd::On::Nothing;
      touched |= end.on != RayEnd::On::Nothing && end.touched;
    }
  }
  void lengthen(int first, int count, float* t_far) const {
    if (!any) return;
    if (!rays.ends) {
      const Beyond beyond(*rays.end);
      for (int i = 0; i < count; ++i) t_far[i] = t_far[i] * beyond.stretch + beyond.room;
      return;
    }
    for (int i = 0; i < count; ++i) {
      const Beyond beyond(*rays.ends[first + i]);
      t_far[i] = t_far[i] * beyond.stretch + beyond.room;
    }
  }
};

/// Embree's packets of N rays.
template <int N>
struct Packets;
template <>
struct Packets<4> {
  using Ray = RTCRay4;
  using RayHit = RTCRayHit4;
};
template <>
struct Packets<8> {
  using Ray = RTCRay8;
  using RayHit = RTCRayHit8;
};
template <>
struct Packets<16> {
  using Ray = RTCRay16;
  using RayHit = RTCRayHit16;
};

/// Copies the first `count` of up to N values. A whole packet is a matter of one instruction, without a call.
template <int N, class T>
void copy_lanes(T* to, const T* from, int count) {
  if (count == N) std::memcpy(to, from, sizeof(T) * N);
  else std::memcpy(to, from, sizeof(T) * static_cast<size_t>(count));
}

/// Fills one packet from lanes [first, first + count). Lanes beyond count and rays that are not usable are switched off
/// by `valid`, and are such that nothing happens to them should Embree look at them all the same.
template <int N, class Packet>
void load_packet(const RayLanes& rays, int first, int count, Packet& ray, int* valid) {
  const auto copy = [&](float* to, const float* from) { copy_lanes<N>(to, from + first, count); };
  copy(ray.org_x, rays.o.x), copy(ray.org_y, rays.o.y), copy(ray.org_z, rays.o.z);
  copy(ray.dir_x, rays.d.x), copy(ray.dir_y, rays.d.y), copy(ray.dir_z, rays.d.z);
  for (int i = 0; i < N; ++i) {
    ray.tnear[i] = 0;
    ray.time[i] = 0;
    ray.tfar[i] = std::numeric_limits<float>::infinity();
    ray.mask[i] = 0xffffffffu;
    ray.id[i] = static_cast<unsigned>(first + i);
    ray.flags[i] = 0;
  }
  if (rays.t_max) copy(ray.tfar, rays.t_max);
  if (rays.time) copy(ray.time, rays.time);
  for (int i = 0; i < N; ++i) {
    const Vec3f o(ray.org_x[i], ray.org_y[i], ray.org_z[i]), d(ray.dir_x[i], ray.dir_y[i], ray.dir_z[i]);
    const bool use = (i < count) & is_traceable(o, d, ray.tfar[i]);
    valid[i] = use ? -1 : 0;
    ray.org_x[i] = use ? ray.org_x[i] : 0.0f;
    ray.org_y[i] = use ? ray.org_y[i] : 0.0f;
    ray.org_z[i] = use ? ray.org_z[i] : 0.0f;
    ray.dir_x[i] = use ? ray.dir_x[i] : 0.0f;
    ray.dir_y[i] = use ? ray.dir_y[i] : 0.0f;
    ray.dir_z[i] = use ? ray.dir_z[i] : 1.0f;
    ray.tfar[i] = use ? ray.tfar[i] : -std::numeric_limits<float>::infinity();
  }
}

}  // namespace

struct Accel::Impl {
  RTCDevice device = nullptr;
  bool robust = true;
  int width = 4;  ///< Of the largest packets that Embree traces whole on this processor; it takes larger ones apart.
  RayRecord* record = nullptr;
  struct Group {
    RTCScene scene = nullptr;
    int first_shape = 0;  ///< Shape index of geometry 0: a group's shapes are numbered without gaps.
    int shape_count = 0;
  };
  std::vector<Group> groups;
  std::vector<int32_t> instance_group;
  std::vector<Box3d> swept;                                 ///< Of each instance that moves: where it ever is.
  std::vector<std::pair<int, std::vector<Affine>>> moving;  ///< Their groups and keys, until build().
  std::vector<std::unique_ptr<GeometryUser>> users;
  bool has_meshes = false, second_look = false;
  double small_scene = 0;
  double worth = 0;  ///< Of the whole scene, in triangles; see AccelOptions.
  std::atomic<ssize_t> bytes{0};
  std::string error;

  template <int N>
  void intersect(const RayLanes& rays, const Hits& hits, bool coherent) const;
  void intersect_packets(const RayLanes& rays, const Hits& hits, bool coherent) const;
  template <int N>
  void occluded(const RayLanes& rays, uint8_t* blocked) const;
  void sweep_moving();

  Group& group(int g) { return groups[static_cast<size_t>(g)]; }
  RTCScene new_scene() const {
    RTCScene scene = rtcNewScene(device);
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_MEDIUM);
    set_flags(scene, RTC_SCENE_FLAG_NONE);
    return scene;
  }
  void set_flags(RTCScene scene, RTCSceneFlags flags) const {
    rtcSetSceneFlags(scene, robust ? flags | RTC_SCENE_FLAG_ROBUST : flags);
  }
  void commit() const {
    for (size_t g = 1; g < groups.size(); ++g) rtcCommitScene(groups[g].scene);
    rtcCommitScene(groups[kWorld].scene);
  }
  /// Of what Embree was asked since the last call; "" when all went well.
  std::string problem() const {
    const RTCError code = rtcGetDeviceError(device);
    if (code == RTC_ERROR_NONE && error.empty()) return {};
    return fmt::format("the ray tracer could not be built: {}", error.empty() ? "unknown error" : error);
  }
  GeometryUser* new_user(const AnalyticShape* shape, const AlphaTest* alpha, const CurveView& curves = {}) {
    users.push_back(std::make_unique<GeometryUser>());
    users.back()->analytic = shape, users.back()->alpha = alpha, users.back()->curves = curves;
    return users.back().get();
  }
  void set_alpha(RTCGeometry geometry, const AlphaTest* alpha) {
    if (!alpha) return;
    rtcSetGeometryIntersectFilterFunction(geometry, alpha_filter<false>);
    rtcSetGeometryOccludedFilterFunction(geometry, alpha_filter<true>);
  }
  /// Attaches with the geometry number that makes shape = first_shape + number.
  void attach(int g, RTCGeometry geometry, int shape) {
    Group& to = group(g);
    if (to.shape_count == 0) to.first_shape = shape;
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(to.scene, geometry, static_cast<unsigned>(shape - to.first_shape));
    rtcReleaseGeometry(geometry);
    to.shape_count = std::max(to.shape_count, shape - to.first_shape + 1);
  }
};

// In triangles: where the coherence hint wins and loses was measured with scenes of both kinds. Curves and instances
// are never few.
constexpr double kWorthOfAnalytic = 200, kWorthOfLarge = 1e9;

Accel::Accel(const AccelOptions& options) : impl_(std::make_unique<Impl>()) {
  impl_->robust = options.robust, impl_->small_scene = options.small_scene;
  impl_->second_look = options.second_look;
  impl_->device = rtcNewDevice(options.embree.empty() ? nullptr : options.embree.c_str());
  const auto can = [this](RTCDeviceProperty p) { return rtcGetDeviceProperty(impl_->device, p) != 0; };
  if (can(RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED)) impl_->width = 8;
  if (can(RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED)) impl_->width = 16;
  rtcSetDeviceErrorFunction(
      impl_->device,
      [](void* self, RTCError, const char* text) { static_cast<Impl*>(self)->error = text ? text : "unknown"; },
      impl_.get());
  rtcSetDeviceMemoryMonitorFunction(
      impl_->device,
      [](void* self, ssize_t change, bool) {
        static_cast<Impl*>(self)->bytes += change;
        return true;
      },
      impl_.get());
  add_group();
}

Accel::~Accel() {
  for (auto& g : impl_->groups) rtcReleaseScene(g.scene);
  rtcReleaseDevice(impl_->device);
}

int Accel::add_group() {
  impl_->groups.push_back({impl_->new_scene(), 0, 0});
  return static_cast<int>(impl_->groups.size()) - 1;
}

void Accel::add_mesh(int group, const MeshView& mesh, int shape, const AlphaTest* alpha) {
  RTCGeometry g = rtcNewGeometry(impl_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, mesh.positions, 0, 3 * sizeof(float),
                             mesh.vertex_count);
  rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.indices, 0, 3 * sizeof(uint32_t),
                             mesh.triangle_count);
  GeometryUser* const user = impl_->new_user(nullptr, alpha);
  user->mesh = mesh;
  rtcSetGeometryUserData(g, user);
  impl_->set_alpha(g, alpha);
  impl_->attach(group, g, shape);
  impl_->worth += static_cast<double>(mesh.triangle_count);
  impl_->has_meshes = true;
}

void Accel::add_curves(int group, const CurveView& curves, int shape, const AlphaTest* alpha) {
  RTCGeometry g = rtcNewGeometry(impl_->device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(g, static_cast<unsigned>(curves.piece_count()));
  rtcSetGeometryUserData(g, impl_->new_user(nullptr, alpha, curves));
  rtcSetGeometryBoundsFunction(g, curve_piece_bounds, nullptr);
  rtcSetGeometryIntersectFunction(g, curve_intersect);
  rtcSetGeometryOccludedFunction(g, curve_occluded);
  impl_->attach(group, g, shape);
  impl_->worth += kWorthOfLarge;
}

void Accel::add_exact(int group, std::span<const ExactTriangle> triangles, int shape, const AlphaTest* alpha) {
  RTCGeometry g = rtcNewGeometry(impl_->device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(g, static_cast<unsigned>(triangles.size()));
  GeometryUser* const user = impl_->new_user(nullptr, alpha);
  user->triangles = triangles.data();
  rtcSetGeometryUserData(g, user);
  rtcSetGeometryBoundsFunction(g, exact_bounds, nullptr);
  rtcSetGeometryIntersectFunction(g, exact_intersect);
  rtcSetGeometryOccludedFunction(g, exact_occluded);
  impl_->attach(group, g, shape);
  impl_->worth += kWorthOfAnalytic * static_cast<double>(triangles.size());
}

void Accel::add_analytic(int group, const AnalyticShape& geometry, int shape, const AlphaTest* alpha) {
  RTCGeometry g = rtcNewGeometry(impl_->device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(g, 1);
  GeometryUser* const user = impl_->new_user(&geometry, alpha);
  user->bounds = bounds_of(geometry);
  if (geometry.cannot_shade_itself()) user->unshaded_by_itself = shape;
  rtcSetGeometryUserData(g, user);
  rtcSetGeometryBoundsFunction(g, analytic_bounds, nullptr);
  rtcSetGeometryIntersectFunction(g, analytic_intersect);
  rtcSetGeometryOccludedFunction(g, analytic_occluded);
  impl_->attach(group, g, shape);
  impl_->worth += kWorthOfAnalytic;
}

int Accel::add_instance(int group, const std::vector<Affine>& keys) {
  RTCGeometry g = rtcNewGeometry(impl_->device, RTC_GEOMETRY_TYPE_INSTANCE);
  rtcSetGeometryInstancedScene(g, impl_->group(group).scene);
  rtcSetGeometryTimeStepCount(g, static_cast<unsigned>(keys.size()));
  for (size_t k = 0; k < keys.size(); ++k) {
    rtcSetGeometryTransform(g, static_cast<unsigned>(k), RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, keys[k].m);
  }
  rtcCommitGeometry(g);
  // Instances are numbered after the world's own shapes, which are all there when the first instance comes.
  const int index = static_cast<int>(impl_->instance_group.size());
  rtcAttachGeometryByID(impl_->group(kWorld).scene, g, static_cast<unsigned>(impl_->group(kWorld).shape_count + index));
  rtcReleaseGeometry(g);
  impl_->instance_group.push_back(group);
  if (keys.size() > 1) impl_->moving.emplace_back(group, keys);
  impl_->worth += kWorthOfLarge;
  return index;
}

/// Between two keys a point moves on a straight line, so the boxes at the keys hold all there is.
void Accel::Impl::sweep_moving() {
  for (const auto& [number, keys] : moving) {
    RTCBounds b;
    rtcGetSceneBounds(group(number).scene, &b);
    const auto wide = [](float v) { return static_cast<double>(v); };
    const Box3d box({wide(b.lower_x), wide(b.lower_y), wide(b.lower_z)},
                    {wide(b.upper_x), wide(b.upper_y), wide(b.upper_z)});
    Box3d& all = swept.emplace_back();
    for (const Affine& key : keys) {
      Mat4d m;
      for (int i = 0; i < 12; ++i) m[i / 3][i % 3] = wide(key.m[i]);
      all.extendBy(transform_box(m, box));
    }
  }
  moving.clear();
}

std::string Accel::build() {
  impl_->commit();
  impl_->sweep_moving();
  return impl_->problem();
}

std::string Accel::watch_ends() {
  for (const Impl::Group& group : impl_->groups) {
    impl_->set_flags(group.scene, kQueryFilter);
    const bool is_empty =
        group.shape_count == 0 && (group.scene != impl_->groups[kWorld].scene || impl_->instance_group.empty());
    // A scene is built anew when something in it is committed, and not for flags alone.
    if (!is_empty) rtcCommitGeometry(rtcGetGeometry(group.scene, 0));
  }
  impl_->commit();
  return impl_->problem();
}

template <int N>
void Accel::Impl::intersect(const RayLanes& rays, const Hits& hits, bool coherent) const {
  const RTCScene scene = groups[kWorld].scene;
  const int world_first = groups[kWorld].first_shape, world_shapes = groups[kWorld].shape_count;
  EmbreeQuery query(coherent || worth <= small_scene);
  alignas(64) typename Packets<N>::RayHit packet;
  alignas(64) int valid[N];
  for (int first = 0; first < rays.n; first += N) {
    const int count = std::min(N, rays.n - first);
    load_packet<N>(rays, first, count, packet.ray, valid);
    for (int i = 0; i < N; ++i) {
      packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
      packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
    query.trace(valid, scene, packet);
    copy_lanes<N>(hits.t + first, packet.ray.tfar, count);
    copy_lanes<N>(hits.u + first, packet.hit.u, count);
    copy_lanes<N>(hits.v + first, packet.hit.v, count);
    copy_lanes<N>(hits.prim + first, packet.hit.primID, count);
    for (int i = 0; i < count; ++i) {
      if (!valid[i]) hits.t[first + i] = std::numeric_limits<float>::quiet_NaN();
      const unsigned geometry = packet.hit.geomID[i], instance = packet.hit.instID[0][i];
      const bool hit = geometry != RTC_INVALID_GEOMETRY_ID;
      const bool instanced = hit && instance != RTC_INVALID_GEOMETRY_ID;
      hits.instance[first + i] = instanced ? static_cast<int32_t>(instance) - world_shapes : -1;
      hits.shape[first + i] = hit ? static_cast<int32_t>(geometry) + world_first : -1;
    }
  }
}

void Accel::Impl::intersect_packets(const RayLanes& rays, const Hits& hits, bool coherent) const {
  switch (width) {
    case 16: intersect<16>(rays, hits, coherent); break;
    case 8: intersect<8>(rays, hits, coherent); break;
    default: intersect<4>(rays, hits, coherent); break;
  }
}

void Accel::intersect(const RayLanes& rays, const Hits& hits, bool coherent) const {
  if (impl_->record) impl_->record->add(coherent ? RayKind::Camera : RayKind::Secondary, rays);
  const auto trace = [&](const RayLanes& r, const Hits& h) { impl_->intersect_packets(r, h, coherent); };
  trace(rays, hits);
  if (impl_->second_look && coherent && impl_->has_meshes && impl_->robust) SecondLook().look(rays, hits, trace);
  if (impl_->instance_group.empty()) return;
  const int world_first = impl_->groups[kWorld].first_shape;
  for (int i = 0; i < rays.n; ++i) {
    if (hits.instance[i] < 0) continue;
    const int group = impl_->instance_group[static_cast<size_t>(hits.instance[i])];
    hits.shape[i] += impl_->groups[static_cast<size_t>(group)].first_shape - world_first;
  }
}

template <int N>
void Accel::Impl::occluded(const RayLanes& rays, uint8_t* blocked) const {
  // Without the hint: shadow rays begin at different surfaces, and end on different points of a light (docs/speed.md).
  EmbreeQuery query(false);
  const ShadowRays shadow{groups[kWorld].scene, rays};
  const ShadowEnds ends(rays);
  if (ends.any) query.set_shadow(&shadow, ends.touched ? end_filter : nullptr);
  alignas(64) typename Packets<N>::Ray packet;
  alignas(64) int valid[N];
  for (int first = 0; first < rays.n; first += N) {
    const int count = std::min(N, rays.n - first);
    load_packet<N>(rays, first, count, packet, valid);
    ends.lengthen(first, count, packet.tfar);
    query.trace(valid, groups[kWorld].scene, packet);
    for (int i = 0; i < count; ++i) blocked[first + i] = (valid[i] != 0) & (packet.tfar[i] < 0);
  }
}

void Accel::occluded(const RayLanes& rays, uint8_t* blocked) const {
  if (impl_->record) impl_->record->add(RayKind::Shadow, rays);
  switch (impl_->width) {
    case 16: impl_->occluded<16>(rays, blocked); break;
    case 8: impl_->occluded<8>(rays, blocked); break;
    default: impl_->occluded<4>(rays, blocked); break;
  }
}

void Accel::record(RayRecord* record) { impl_->record = record; }

namespace {

/// A query for what is near an emitter.
struct NearEmitter {
  const std::function<const GeometryUser*(unsigned instance, unsigned geometry)>& user_of;
  RTCScene world;
  const Box3d& box;
  const std::array<Vec3d, 3>* corners;
  bool found = false;

  bool is_near(const EndTriangle& t) const;
  static bool visit(RTCPointQueryFunctionArguments* args);
};

/// The least and the greatest distance of points from a triangle's plane.
template <class Points>
std::pair<double, double> distances(const EndTriangle& t, const Points& points) {
  const Vec3d n = (t.b - t.a).cross(t.c - t.a).normalized();
  double low = INFINITY, high = -INFINITY;
  for (const Vec3d& p : points) low = std::min(low, n.dot(p - t.a)), high = std::max(high, n.dot(p - t.a));
  return {low, high};
}

double largest_of(const Vec3d& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

bool NearEmitter::is_near(const EndTriangle& t) const {
  const std::array<Vec3d, 3> own{t.a, t.b, t.c};
  Box3d around;
  for (const Vec3d& p : own) around.extendBy(p);
  // The larger the triangle, the farther off Embree's plane is.
  const double margin = kNearEnd * std::max(1.0, around.size().length() / 128);
  if (!Box3d(around.min - Vec3d(margin), around.max + Vec3d(margin)).intersects(box)) return false;
  const auto apart = [&](const std::pair<double, double>& d) { return d.first > margin || d.second < -margin; };
  if (!corners) return !apart(distances(t, corners_of(box)));
  const EndTriangle emitter{(*corners)[0], (*corners)[1], (*corners)[2], {}};
  const auto over = distances(t, *corners), under = distances(emitter, own);
  if (apart(over) || apart(under)) return false;
  // In its plane, as the other half of a quad: rays that stop in front of the one have not met the other.
  const double flat = 8 * kRounding * std::max({largest_of(box.min), largest_of(box.max), largest_of(around.size())});
  return std::max({-over.first, over.second, -under.first, under.second}) > flat;
}

bool NearEmitter::visit(RTCPointQueryFunctionArguments* args) {
  auto& self = *static_cast<NearEmitter*>(args->userPtr);
  if (self.found) return false;
  const bool instanced = args->context->instStackSize > 0;
  const unsigned instance = instanced ? args->context->instID[0] : RTC_INVALID_GEOMETRY_ID;
  const GeometryUser* user = self.user_of(instance, args->geomID);
  if (!user) return false;
  Mat4d placed;
  if (instanced) placed = instance_to_render(self.world, instance, args->query->time);
  if (user->triangles) {
    const ExactTriangle& t = user->triangles[args->primID];
    EndTriangle here{t.a, t.b, t.c, Vec3d(t.error)};
    if (instanced) {
      for (Vec3d* corner : {&here.a, &here.b, &here.c}) *corner = transform_point(placed, *corner);
    }
    self.found = self.is_near(here);
  } else if (user->mesh.indices) {
    self.found = self.is_near(end_triangle(user->mesh, args->primID, instanced ? &placed : nullptr));
  } else if (user->analytic && self.corners) {
    // Rays to a triangle stop in front of it, unless it is touched.
    Box3d box = transform_box(user->analytic->object_to_scene(), user->analytic->object_bounds());
    if (instanced) box = transform_box(placed, box);
    self.found = Box3d(box.min - Vec3d(kNearEnd), box.max + Vec3d(kNearEnd)).intersects(self.box);
  }
  return false;
}

}  // namespace

bool Accel::is_touched(const Box3d& box, const std::array<Vec3d, 3>* corners) const {
  const Impl::Group& world = impl_->groups[kWorld];
  const std::function<const GeometryUser*(unsigned, unsigned)> user_of = [&](unsigned instance, unsigned geometry) {
    RTCScene scene = world.scene;
    if (instance != RTC_INVALID_GEOMETRY_ID) {
      const auto index = instance - static_cast<unsigned>(world.shape_count);
      scene = impl_->group(impl_->instance_group[index]).scene;
    }
    return static_cast<const GeometryUser*>(rtcGetGeometryUserData(rtcGetGeometry(scene, geometry)));
  };
  const Box3d room(box.min - Vec3d(kNearEnd), box.max + Vec3d(kNearEnd));
  for (const Box3d& swept : impl_->swept) {
    if (swept.intersects(room)) return true;
  }
  NearEmitter near{user_of, world.scene, box, corners};
  const Vec3f middle(box.center());
  RTCPointQuery query{middle.x, middle.y, middle.z, 0, static_cast<float>(box.size().length() / 2 + 20 * kNearEnd)};
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(world.scene, &query, &context, NearEmitter::visit, &near);
  return near.found;
}

bool Accel::has_instances() const { return !impl_->instance_group.empty(); }

void* Accel::embree_scene() const { return impl_->groups[kWorld].scene; }

size_t Accel::bytes() const { return static_cast<size_t>(std::max<ssize_t>(0, impl_->bytes)); }

std::string accel_version() {
  return fmt::format("Embree {}.{}.{}", RTC_VERSION_MAJOR, RTC_VERSION_MINOR, RTC_VERSION_PATCH);
}

}  // namespace whit
