// Boxes under transforms.
#pragma once

#include <array>

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
