// The far end of shadow rays: which surfaces are in front of a light's point, and which it lies on.
//
// A light's point that lies on a surface as far as anyone can tell (a lamp in a ceiling, a point light in the plane of a
// floor) is not hidden by it. Where the ray meets that surface says little: for a ray at the angle a to the surface the
// distance along the ray is uncertain by error / sin a, without limit. What has a bound is how far behind the surface
// the point is. So a surface hides a point that is behind it, seen from the ray's origin, by more than what rounding
// moved the two: half a unit in the last place of each coordinate of the vertices, and the same for the light's; or by
// more than the vertices' numbers are worth, which are mostly written by programs that compute in float.
//
// Embree's floats are not as exact. Its triangle test (Pluecker coordinates relative to the origin) forms the volume
// n . (v - o) from some ten roundings of terms no larger than |n| |v - o|, so its plane is off by about 10 u |v - o|, where
// u = 2^-24: in render space, whose radius is at most 128, by 1e-4, ten times more than the vertices are. Lights that have
// a triangle that near are `touched`: their rays go on beyond the end, so that no triangle before it is missed because of
// its rounded distance, and what they meet is decided in double precision. A plane that is off by e is met by a ray at
// the angle a to it up to e / sin a too far away; the triangles that touch are few, so rays go on by that of the one
// that they graze most. (To twice the distance is enough in any case: a ray's origin is at least as far from the
// triangle's plane as the plane is uncertain.) It matters: in front of a lamp that is a mesh, whose triangles all touch
// their neighbours, rays to twice the distance meet the lamp's far side and what is behind it. All other lights trace
// rays as they are. Analytic shapes are double precision anyway.
#pragma once

#include <cstdint>
#include <vector>

#include "core/plugin/shape.h"

namespace whit {

struct RayLanes;

/// Render lengths within which Embree's floats do not tell what is before a light's point and what behind it.
constexpr double kNearEnd = 1e-3;

/// What rounding to a float moves coordinates by at most.
Vec3d rounding_of(const Vec3d& v);

/// What a float moves a shape's surface by when its radii and heights are floats, under the transform to where that
/// counts. By the shape's own box, for one around a turned shape is larger.
double rounding_of_size(const Box3d& object_box, const Mat4d& to_render);

/// Triangles that are so near to an emitter that its shadow rays must tell them from it.
struct Touching {
  bool any = false;
  std::vector<Vec3f> normals;  ///< Their unit normals, render space.
  /// How far off Embree's planes may be; infinite, without normals, where that is not known, or they are too many.
  float off = 0;
};

/// What the shadow rays of one call end on.
struct RayEnd {
  enum class On : uint8_t { Nothing, Point, Plane, Shape };
  On on = On::Nothing;  ///< Nothing: rays end at t_max, as far as a float knows it.
  Touching touching{};  ///< The triangles within kNearEnd of it; see above.
  int unshaded_by =
      -1;  ///< The number of an analytic shape that does not hide its own points, if it cannot shade itself.
  Vec3d p{0, 0, 0}, n{0, 0, 1};  ///< The point; a point of the plane and its unit normal.
  Vec3d error{0, 0, 0};          ///< How far off rounding may have put p, in each coordinate.
  const AnalyticShape* analytic = nullptr;
  /// Of a plane: the vertices and the number of the triangle whose plane it is. It never hides its own points.
  const float* own_vertices = nullptr;
  uint32_t own_triangle = 0;

  bool touched() const { return touching.any; }
};

/// What a shadow ray ends on.
const RayEnd& end_of(const RayLanes& rays, int lane);

/// The point on which a ray ends, in render space and double precision.
Vec3d end_point(const RayLanes& rays, int lane);

/// Three corners in render space, each within `error` of where it is in exact arithmetic.
struct EndTriangle {
  Vec3d a, b, c, error;
  /// Whether the plane is between the two points, and the second of them farther from it than the errors.
  bool separates(const Vec3d& from, const Vec3d& to, const Vec3d& to_error) const;
};

/// A hit of an analytic shape, in its object space.
struct ShapeHit {
  Vec3d p, n, d;      ///< The point, the normal (of any length), the ray's direction.
  Mat4d from_render;  ///< Render to object space.
  double error = 0;   ///< How far off the surface may be, in render space.
  /// Whether the surface is before a point of render space, rather than on it or behind it.
  bool hides(const Vec3d& end, const Vec3d& end_error) const;
};

}  // namespace whit
