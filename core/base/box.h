// Boxes under transforms.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/vec.h"

namespace whit {

/// The eight corners of a box that is not empty.
inline std::array<Vec3d, 8> corners_of(const Box3d& box) {
  std::array<Vec3d, 8> corners;
  for (size_t c = 0; c < 8; ++c) {
    corners[c] = {c & 1 ? box.max.x : box.min.x, c & 2 ? box.max.y : box.min.y, c & 4 ? box.max.z : box.min.z};
  }
  return corners;
}

/// The smallest box around a triangle. Without branches, which extendBy() has: it is chance which corner is the least.
inline Box3d triangle_box(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const auto least = [&](int k) { return std::min(std::min(a[k], b[k]), c[k]); };
  const auto most = [&](int k) { return std::max(std::max(a[k], b[k]), c[k]); };
  return {{least(0), least(1), least(2)}, {most(0), most(1), most(2)}};
}

/// The smallest box around a box under `m`; empty when the box is.
inline Box3d transform_box(const Mat4d& m, const Box3d& box) {
  Box3d out;
  if (box.isEmpty()) return out;
  for (const Vec3d& corner : corners_of(box)) out.extendBy(transform_point(m, corner));
  return out;
}

/// The largest absolute value of each coordinate in a box.
inline Vec3d farthest_of(const Box3d& box) {
  const auto farther = [&](int k) { return std::max(std::abs(box.min[k]), std::abs(box.max[k])); };
  return {farther(0), farther(1), farther(2)};
}

}  // namespace whit
