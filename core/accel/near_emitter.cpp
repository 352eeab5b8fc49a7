#include "core/accel/near_emitter.h"

#include <algorithm>
#include <cmath>

#include "core/base/box.h"

namespace whit {
namespace {

/// A query for what is near an emitter.
struct NearEmitter {
  const UserOf& user_of;
  RTCScene world;
  const Box3d& box;
  const std::array<Vec3d, 3>* corners;
  Touching found{};

  void look_at(const EndTriangle& t, bool in_world_floats);
  bool is_near(const EndTriangle& t, double margin) const;
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

Box3d box_around(const EndTriangle& t) { return triangle_box(t.a, t.b, t.c); }

/// Notes a triangle that is near. What floats in render space get wrong is known; an instance's space has other lengths,
/// and huge triangles are what they are for being beyond floats.
void NearEmitter::look_at(const EndTriangle& t, bool in_world_floats) {
  // More are not looked at for every ray.
  constexpr size_t kMost = 32;
  // The larger the triangle, the farther off Embree's plane is.
  const double margin = kNearEnd * std::max(1.0, box_around(t).size().length() / 128);
  if (!is_near(t, margin)) return;
  found.any = true;
  found.normals.emplace_back((t.b - t.a).cross(t.c - t.a).normalized());
  found.off = std::max(found.off, static_cast<float>(margin));
  if (!in_world_floats || found.normals.size() > kMost) found.off = INFINITY;
}

bool NearEmitter::is_near(const EndTriangle& t, double margin) const {
  const std::array<Vec3d, 3> own{t.a, t.b, t.c};
  const Box3d around = box_around(t);
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
  // There is nothing more to know.
  if (self.found.off == INFINITY) return false;
  const bool instanced = args->context->instStackSize > 0;
  const unsigned instance = instanced ? args->context->instID[0] : RTC_INVALID_GEOMETRY_ID;
  const GeometryUser* user = self.user_of(instance, args->geomID);
  if (!user) return false;
  Mat4d placed;
  if (instanced) placed = instance_to_render(self.world, instance, args->query->time);
  const Mat4d* to_render = instanced ? &placed : nullptr;
  if (user->triangles) {
    self.look_at(end_triangle(user->triangles[args->primID], to_render), false);
  } else if (user->mesh.indices) {
    self.look_at(end_triangle(user->mesh, args->primID, to_render), !instanced);
  } else if (user->analytic && self.corners) {
    // Rays to a triangle stop in front of it, unless it is touched.
    Box3d box = transform_box(user->analytic->object_to_scene(), user->analytic->object_bounds());
    if (instanced) box = transform_box(placed, box);
    if (Box3d(box.min - Vec3d(kNearEnd), box.max + Vec3d(kNearEnd)).intersects(self.box))
      self.found.any = true, self.found.off = INFINITY;
  }
  return false;
}

}  // namespace

Touching what_is_near(RTCScene world, const UserOf& user_of, const Box3d& box, const std::array<Vec3d, 3>* corners) {
  NearEmitter near{user_of, world, box, corners};
  const Vec3f middle(box.center());
  RTCPointQuery query{middle.x, middle.y, middle.z, 0, static_cast<float>(box.size().length() / 2 + 20 * kNearEnd)};
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(world, &query, &context, NearEmitter::visit, &near);
  if (near.found.off == INFINITY) near.found.normals.clear();
  return std::move(near.found);
}

}  // namespace whit
