#include "core/accel/ray_end.h"

#include <algorithm>
#include <cmath>

#include "core/accel/accel.h"

namespace whit {
namespace {

Vec3d absolute(const Vec3d& v) { return {std::abs(v.x), std::abs(v.y), std::abs(v.z)}; }

/// Where a ray meets the shape, of all places the nearest to `t`; `t` itself when it misses.
double root_near(const AnalyticShape& shape, const Vec3d& o, const Vec3d& d, double t) {
  const Vec3d from = transform_point(shape.scene_to_object(), o), along = transform_vector(shape.scene_to_object(), d);
  double best = t, least = 1e-3 * t, t_min = 0;
  // A quadric has two roots.
  for (int i = 0; i < 2; ++i) {
    double root = INFINITY;
    shape.intersect({1, &from.x, &from.y, &from.z, &along.x, &along.y, &along.z, &t_min, &root});
    if (!std::isfinite(root)) break;
    if (std::abs(root - t) < least) best = root, least = std::abs(root - t);
    t_min = std::nextafter(root, INFINITY);
  }
  return best;
}

}  // namespace

Vec3d rounding_of(const Vec3d& v) {
  const auto half_ulp = [](double x) { return x == 0 ? 0 : std::ldexp(0x1p-24, std::ilogb(x)); };
  return {half_ulp(v.x), half_ulp(v.y), half_ulp(v.z)};
}

double rounding_of_size(const Box3d& object_box, const Mat4d& to_render) {
  const Vec3d size = object_box.size();
  double largest = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3d along(to_render[axis][0], to_render[axis][1], to_render[axis][2]);
    largest = std::max(largest, size[axis] * along.length());
  }
  return largest * 0x1p-24;
}

const RayEnd& end_of(const RayLanes& rays, int lane) { return rays.ends ? *rays.ends[lane] : *rays.end; }

Vec3d end_point(const RayLanes& rays, int lane) {
  const RayEnd& end = end_of(rays, lane);
  if (end.on == RayEnd::On::Point) return end.p;
  const Vec3d o(rays.o[lane]), d(rays.d[lane]);
  const double t = static_cast<double>(rays.t_max[lane]);
  if (end.on == RayEnd::On::Shape) return o + d * root_near(*end.analytic, o, d, t);
  const Vec3d q = rays.q ? Vec3d(rays.q[lane]) : o + d * t;
  return end.on == RayEnd::On::Plane ? q - end.n * end.n.dot(q - end.p) : q;
}

bool EndTriangle::separates(const Vec3d& from, const Vec3d& to, const Vec3d& to_error) const {
  const Vec3d n = (b - a).cross(c - a).normalized();
  const double here = n.dot(from - a), there = n.dot(to - a);
  // Whoever wrote the vertices turned them by matrices of floats: a plane is known to two units of its size, of which
  // only what is as far away as the camera counts.
  const double size = std::sqrt(std::max({(b - a).length2(), (c - b).length2(), (a - c).length2()}));
  const double tilt = std::min(size, to.length()) * 0x1p-23;
  return here * there < 0 && std::abs(there) > std::max(tilt, absolute(n).dot(error + to_error));
}

bool ShapeHit::hides(const Vec3d& end, const Vec3d& end_error) const {
  // Normals go by the inverse transpose; the volume n . (q - p) is the same number in both spaces.
  Vec3d there;
  from_render.transposed().multDirMatrix(n, there);
  const double length = there.length(), side = n.dot(d) < 0 ? -1 : 1;
  const double behind = side * n.dot(transform_point(from_render, end) - p) / length;
  // Also where there is no normal, as at the tip of a cone.
  return !(behind <= error + absolute(there / length).dot(end_error));
}

}  // namespace whit
