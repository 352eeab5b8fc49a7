// Triangles that are huge beside what is seen next to them, in double precision: a ground of 1e7 units under a cube. As
// floats their corners would be off by more than the cube's size, and so would all that is computed from them.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/base/box.h"

namespace whit {

/// Made by exact_triangle(), for the plane must be known better than the corners tell.
struct ExactTriangle {
  Vec3d a, b, c;
  Vec3d n;            ///< Unit normal, towards whom a, b, c go around counter-clockwise.
  double height = 0;  ///< The plane is n . p = height.
  double error = 0;   ///< What rounding the corners to double may have moved them by.
  /// How far beyond its edges ab, bc and ca it reaches: as far as rounding to floats may have moved a neighbour's.
  double reach[3] = {0, 0, 0};
};

inline ExactTriangle exact_triangle(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  ExactTriangle t{a, b, c, (b - a).cross(c - a).normalized()};
  // The corner next to the origin has the fewest digits to lose.
  const Vec3d& near = std::min({a, b, c}, [](const Vec3d& p, const Vec3d& q) { return p.length2() < q.length2(); });
  t.height = t.n.dot(near);
  t.error = 4.5e-16 * std::max({a.length(), b.length(), c.length()});
  return t;
}

/// All that is met of it.
inline Box3d bounds_of(const ExactTriangle& t) {
  const Box3d box = triangle_box(t.a, t.b, t.c);
  const Vec3d reach(t.error + std::max({t.reach[0], t.reach[1], t.reach[2]}));
  return {box.min - reach, box.max + reach};
}

/// Where the line o + t d meets the triangle's plane; not finite where it runs along it.
inline double plane_distance(const ExactTriangle& t, const Vec3d& o, const Vec3d& d) {
  return (t.height - t.n.dot(o)) / t.n.dot(d);
}

/// The weights of b and c at a point of the plane.
inline Vec2d weights_at(const ExactTriangle& t, const Vec3d& p) {
  const Vec3d ab = t.b - t.a, ac = t.c - t.a, ap = p - t.a;
  const double area = t.n.dot(ab.cross(ac));
  return {t.n.dot(ap.cross(ac)) / area, t.n.dot(ab.cross(ap)) / area};
}

/// How far p, in the plane, lies inside the edge from q to r; negative outside.
inline double depth_inside_edge(const ExactTriangle& t, const Vec3d& q, const Vec3d& r, const Vec3d& p) {
  const Vec3d edge = r - q;
  return t.n.cross(edge).dot(p - q) / edge.length();
}

/// Whether the line o + t d passes the triangle on the inner side of its edges, given where it meets the plane. A
/// neighbour that shares an edge computes the same number for it with the other sign, so that no line passes between.
inline bool is_inside(const ExactTriangle& t, const Vec3d& o, const Vec3d& d, double distance) {
  const Vec3d a = t.a - o, b = t.b - o, c = t.c - o;
  const double ab = d.dot(a.cross(b)), bc = d.dot(b.cross(c)), ca = d.dot(c.cross(a));
  if ((ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0)) return true;
  if (t.reach[0] + t.reach[1] + t.reach[2] == 0) return false;
  const Vec3d p = o + distance * d;
  return depth_inside_edge(t, t.a, t.b, p) >= -t.reach[0] && depth_inside_edge(t, t.b, t.c, p) >= -t.reach[1] &&
         depth_inside_edge(t, t.c, t.a, p) >= -t.reach[2];
}

}  // namespace whit
