// What is asked of Embree's hits of meshes: whether alpha cuts the surface away, and whether it is before a ray's end.

#include <algorithm>
#include <cmath>

#include "core/accel/embree_geometry.h"
#include "core/accel/shadow_rays.h"

namespace whit {
namespace {

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

Vec3d absolute(const Vec3d& v) { return {std::abs(v.x), std::abs(v.y), std::abs(v.z)}; }

/// Whether a ray meets the triangle of its hit before its end.
bool meets_before_end(const ShadowRays& shadow, const GeometryUser& user, const RTCFilterFunctionNArguments* args,
                      unsigned i) {
  const RayLanes& rays = shadow.rays;
  const unsigned width = args->N;
  const auto id = static_cast<int>(RTCRayN_id(args->ray, width, i));
  const RayEnd& end = end_of(rays, id);
  if (end.on == RayEnd::On::Nothing) return true;
  // What every ray that nothing stops meets last.
  if (user.mesh.positions == end.own_vertices && RTCHitN_primID(args->hit, width, i) == end.own_triangle) return false;
  const Vec3f d(RTCRayN_dir_x(args->ray, width, i), RTCRayN_dir_y(args->ray, width, i),
                RTCRayN_dir_z(args->ray, width, i));
  const Vec3f n(RTCHitN_Ng_x(args->hit, width, i), RTCHitN_Ng_y(args->hit, width, i),
                RTCHitN_Ng_z(args->hit, width, i));
  // How far the end is behind the triangle's plane, in the space of its group, as far as floats tell.
  const float behind = (rays.t_max[id] - RTCRayN_tfar(args->ray, width, i)) * std::abs(n.dot(d)) / n.length();
  const float unsure = static_cast<float>(kNearEnd) * d.length();
  if (behind > unsure) return true;
  if (behind < -unsure) return false;
  const unsigned instance = args->context->instID[0];
  Mat4d placed;
  const bool instanced = instance != RTC_INVALID_GEOMETRY_ID;
  if (instanced) placed = instance_to_render(shadow.world, instance, RTCRayN_time(args->ray, width, i));
  return end_triangle(user.mesh, RTCHitN_primID(args->hit, width, i), instanced ? &placed : nullptr)
      .separates(Vec3d(rays.o[id]), end_point(rays, id), end.error);
}

}  // namespace

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

void end_filter(const RTCFilterFunctionNArguments* args) {
  const auto& user = *static_cast<const GeometryUser*>(args->geometryUserPtr);
  const ShadowRays& shadow = *shadow_of(args->context);
  for (unsigned i = 0; i < args->N; ++i) {
    if (args->valid[i] && !meets_before_end(shadow, user, args, i)) args->valid[i] = 0;
  }
}

void set_alpha_filter(RTCGeometry geometry) {
  rtcSetGeometryIntersectFilterFunction(geometry, alpha_filter<false>);
  rtcSetGeometryOccludedFilterFunction(geometry, alpha_filter<true>);
}

}  // namespace whit
