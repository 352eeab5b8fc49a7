#include "core/scene/emitter_reach.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/box.h"

namespace whit {
namespace {

/// The box and, where the emitter is not too strong to be judged, leave to use it.
LightReach within(const Box3d& box, const RGB& radiance) {
  LightReach reach;
  reach.low = Vec3f(box.min), reach.high = Vec3f(box.max);
  // Radiance over density is that times at most area / distance^2, and no shape's area exceeds some boxes of its size.
  const double strongest = std::max({std::abs(radiance.x), std::abs(radiance.y), std::abs(radiance.z)});
  constexpr double nearest = LightReach::kNearestLight * LightReach::kNearestLight;
  const double most = strongest * (1 + 100 * box.size().length2() / nearest);
  if (most < LightReach::kStrongest) reach.from = LightReach::From::Box;
  return reach;
}

/// Adds the plane; `corners` span what is sampled.
template <class Corners>
void set_front(LightReach& reach, const Vec3d& normal, const Corners& corners) {
  reach.normal = Vec3f(normal);
  const Vec3d n(reach.normal);
  reach.plane = n.dot(corners[0]);
  for (const Vec3d& corner : corners) reach.plane = std::min(reach.plane, n.dot(corner));
  reach.one_sided = std::isfinite(reach.plane);
}

/// 1 or -1 where the normals of a triangle's corners leave its front on the side of n, or turn it, at every point; else
/// 0. See Round::sample_triangle().
int side_of_normals(const Mesh& mesh, const uint32_t* index, const Vec3d& n) {
  if (mesh.normals.empty()) return 1;
  double low = 1, high = -1, shortest = 1e30, longest = 0;
  for (int c = 0; c < 3; ++c) {
    const Vec3d given(mesh.normal(index[c]));
    const double length = given.length(), cosine = n.dot(given) / length;
    if (!std::isfinite(cosine)) return 0;
    low = std::min(low, cosine), high = std::max(high, cosine);
    shortest = std::min(shortest, length), longest = std::max(longest, length);
  }
  // Interpolated cosines lie between. Floats get 1e-7 of the longest normal wrong.
  constexpr double kClear = 1e-3, kVisible = 1e-20;
  if (!(shortest > kClear * longest && shortest > kVisible)) return 0;
  return low > kClear ? 1 : high < -kClear ? -1 : 0;
}

LightReach triangle_reach(const SceneShape& shape, const SceneLight& light) {
  const Mesh& mesh = *shape.mesh;
  const uint32_t* index = &mesh.indices[3 * static_cast<size_t>(light.prim)];
  const std::array<Vec3d, 3> corners{Vec3d(mesh.position(index[0])), Vec3d(mesh.position(index[1])),
                                     Vec3d(mesh.position(index[2]))};
  Box3d box;
  for (const Vec3d& corner : corners) box.extendBy(corner);
  LightReach reach = within(box, light.radiance);
  if (light.two_sided) return reach;
  const Vec3d n = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
  const int side = side_of_normals(mesh, index, n);
  if (side != 0) set_front(reach, n * (shape.flips ? -side : side), corners);
  return reach;
}

LightReach analytic_reach(const AnalyticShape& shape, const SceneLight& light) {
  const Box3d box = shape.object_bounds();
  const Box3d placed = transform_box(shape.object_to_scene(), box);
  LightReach reach = within(placed, light.radiance);
  if (light.two_sided || !shape.is_planar()) return reach;
  std::array<Vec3d, 8> corners = corners_of(box);
  for (Vec3d& corner : corners) corner = transform_point(shape.object_to_scene(), corner);
  // Of a plane, any sample has the normal, seen from anywhere.
  set_front(reach, shape.sample_from(placed.max + Vec3d(1, 2, 3), 0.5, 0.5).n, corners);
  return reach;
}

}  // namespace

LightReach reach_of(const Scene& scene, const SceneLight& light) {
  if (light.light) return light.light->reach();
  const SceneShape& shape = scene.shapes[static_cast<size_t>(light.shape)];
  return shape.mesh ? triangle_reach(shape, light) : analytic_reach(*shape.analytic, light);
}

}  // namespace whit
