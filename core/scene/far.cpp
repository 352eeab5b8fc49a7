#include "core/scene/far.h"

#include <algorithm>
#include <cmath>

#include "core/base/box.h"

namespace whit {
namespace {

Box3d triangle_box(const MeshData& mesh, const Mat4d& m, size_t triangle) {
  Box3d box;
  for (size_t k = 0; k < 3; ++k) {
    const size_t v = 3 * static_cast<size_t>(mesh.indices[3 * triangle + k]);
    box.extendBy(transform_point(m, {mesh.positions[v], mesh.positions[v + 1], mesh.positions[v + 2]}));
  }
  return box;
}

}  // namespace

double extent_of(const Box3d& box, const Vec3d& from) {
  double farthest = 0;
  if (box.isEmpty()) return farthest;
  for (int c = 0; c < 3; ++c)
    farthest = std::max({farthest, std::abs(box.min[c] - from[c]), std::abs(box.max[c] - from[c])});
  return farthest;
}

double extent_of(const Mat4d& m, const Box3d& box, const Vec3d& from) {
  if (box.isEmpty()) return 0;
  double squares = 0;
  for (int i = 0; i < 9; ++i) squares += m[i / 3][i % 3] * m[i / 3][i % 3];
  return (transform_point(m, box.center()) - from).length() + std::sqrt(squares) * box.size().length() / 2;
}

double least_extent_of(const MeshData& mesh, const Mat4d& m, const Vec3d& from) {
  double least = std::numeric_limits<double>::infinity();
  for (size_t t = 0; t < mesh.indices.size() / 3; ++t)
    least = std::min(least, extent_of(triangle_box(mesh, m, t), from));
  return least;
}

size_t leave_out_far(MeshData& mesh, const Mat4d& m, const Vec3d& from, double limit) {
  const size_t before = mesh.indices.size() / 3;
  size_t left = 0;
  for (size_t t = 0; t < before; ++t) {
    if (!(extent_of(triangle_box(mesh, m, t), from) <= limit)) continue;
    for (size_t k = 0; k < 3; ++k) mesh.indices[left++] = mesh.indices[3 * t + k];
  }
  mesh.indices.resize(left);
  return before - left / 3;
}

}  // namespace whit
