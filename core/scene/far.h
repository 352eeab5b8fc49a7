// What is so far away that floats cannot hold it in a space made for the rest: a vertex at 1e20 beside a cube, by a slip or
// as somebody's "infinity". Render space is scaled so that the whole scene is about a hundred units wide; with such a
// vertex all else would become too small for any product of floats, and beyond 1.8e18 units Embree leaves out, without a
// word, whatever has a box there. So it is left out before, and said.
#pragma once

#include <algorithm>
#include <limits>

#include "core/plugin/shape.h"

namespace whit {

/// Nothing is kept that is farther away than this times the nearest thing, and than so many units: in render space that is
/// still within Embree's range, and double precision tells no more where a thing is.
constexpr double kFarthest = 1e15;
/// The space of a group is made for what is not farther away than this times the nearest thing. The rest is seen under the
/// same angles in any space, but its triangles are traced in double precision, for products of their floats overflow.
constexpr double kFar = 1e8;

/// How far away from a point a box reaches.
double extent_of(const Box3d& box, const Vec3d& from);
/// The same of a box that is placed somewhere, or a few times more, for there may be millions of instances.
double extent_of(const Mat4d& m, const Box3d& box, const Vec3d& from);
/// The same of a mesh's triangle that reaches least.
double least_extent_of(const MeshData& mesh, const Mat4d& m, const Vec3d& from);

/// How far away things may be, given what all reach to.
class Horizon {
 public:
  void add(double extent) {
    if (extent > 0) nearest_ = std::min(nearest_, extent);
  }
  /// Beyond, things are left out.
  double limit() const { return kFarthest * std::max(1.0, nearest_); }
  /// Beyond, things are far.
  double reach() const { return kFar * nearest_; }

 private:
  double nearest_ = std::numeric_limits<double>::infinity();
};

/// Removes the triangles that reach beyond the limit. Returns how many there were.
size_t leave_out_far(MeshData& mesh, const Mat4d& m, const Vec3d& from, double limit);

}  // namespace whit
