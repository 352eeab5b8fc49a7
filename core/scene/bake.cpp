#include "core/scene/bake.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace whit {
namespace {

template <class Numbers>
Vec3d point_of(const Numbers& flat, size_t i) {
  return {flat[3 * i], flat[3 * i + 1], flat[3 * i + 2]};
}

/// Writes the i-th of vectors that lie flat.
void put(std::vector<float>& to, size_t i, const Vec3d& v) {
  for (int c = 0; c < 3; ++c) to[3 * i + static_cast<size_t>(c)] = static_cast<float>(v[c]);
}

void append(std::vector<float>& to, const Vec3d& v) {
  to.push_back(static_cast<float>(v.x));
  to.push_back(static_cast<float>(v.y));
  to.push_back(static_cast<float>(v.z));
}

bool has_area(const Mesh& mesh, uint32_t a, uint32_t b, uint32_t c) {
  if (a == b || b == c || a == c) return false;
  // In double, so that a small triangle's area does not underflow.
  const Vec3d p(mesh.position(a)), q(mesh.position(b)), r(mesh.position(c));
  return (q - p).cross(r - p).length2() > 0;
}

/// A mesh without triangles yet.
std::unique_ptr<Mesh> bake_vertices(const MeshData& data, const Mat4d& object_to_group) {
  auto mesh = std::make_unique<Mesh>();
  const size_t vertices = data.positions.size() / 3;
  mesh->positions.resize(3 * vertices + 1);
  for (size_t i = 0; i < vertices; ++i)
    put(mesh->positions, i, transform_point(object_to_group, point_of(data.positions, i)));
  if (!data.normals.empty()) {
    const Mat4d n = normal_matrix(object_to_group);
    mesh->normals.resize(3 * vertices);
    for (size_t i = 0; i < vertices; ++i) put(mesh->normals, i, transform_vector(n, point_of(data.normals, i)));
  }
  if (!data.tangents.empty()) {
    mesh->tangents.resize(3 * vertices);
    for (size_t i = 0; i < vertices; ++i)
      put(mesh->tangents, i, transform_vector(object_to_group, point_of(data.tangents, i)));
    // What is mirrored has its bitangents on the other side of normal and tangent.
    const float mirror = swaps_handedness(object_to_group) ? -1.0f : 1.0f;
    for (const float sign : data.bitangent_signs) mesh->bitangent_signs.push_back(sign < 0 ? -mirror : mirror);
  }
  mesh->uvs = data.uvs;
  mesh->uvs1 = data.uvs1;
  mesh->colors = data.colors;
  return mesh;
}

using Point = std::array<double, 3>;
using EdgeSet = std::set<std::pair<Point, Point>>;

std::pair<Point, Point> edge_of(const Vec3d& q, const Vec3d& r) {
  return std::minmax(Point{q.x, q.y, q.z}, Point{r.x, r.y, r.z});
}

/// The edges of `neighbours` between two points of `data`, in object space.
EdgeSet shared_edges(const MeshData& data, const MeshData& neighbours) {
  std::set<Point> points;
  for (size_t i = 0; i + 2 < data.positions.size(); i += 3) {
    points.insert({data.positions[i], data.positions[i + 1], data.positions[i + 2]});
  }
  std::vector<bool> shared(neighbours.positions.size() / 3);
  for (size_t i = 0; i < shared.size(); ++i) {
    const Vec3d p = point_of(neighbours.positions, i);
    shared[i] = points.count({p.x, p.y, p.z}) > 0;
  }
  EdgeSet edges;
  for (size_t i = 0; i < neighbours.indices.size(); ++i) {
    const uint32_t q = neighbours.indices[i], r = neighbours.indices[i % 3 == 2 ? i - 2 : i + 1];
    if (shared[q] && shared[r])
      edges.insert(edge_of(point_of(neighbours.positions, q), point_of(neighbours.positions, r)));
  }
  return edges;
}

}  // namespace

Mat4d normal_matrix(const Mat4d& m) {
  // The inverse transpose is the matrix of cofactors over the determinant, of which only the sign matters.
  const auto largest_of = [](const Mat4d& a) {
    double largest = 0;
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) largest = std::max(largest, std::abs(a[r][c]));
    }
    return largest;
  };
  const double size = 1 / largest_of(m);
  Mat4d out;
  for (int r = 0; r < 3; ++r) {
    const int r1 = (r + 1) % 3, r2 = (r + 2) % 3;
    for (int c = 0; c < 3; ++c) {
      const int c1 = (c + 1) % 3, c2 = (c + 2) % 3;
      out[r][c] = (size * m[r1][c1]) * (size * m[r2][c2]) - (size * m[r1][c2]) * (size * m[r2][c1]);
    }
  }
  const double determinant = m[0][0] * out[0][0] + m[0][1] * out[0][1] + m[0][2] * out[0][2];
  const double scale = (determinant < 0 ? -1 : 1) / largest_of(out);
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) out[r][c] *= scale;
  }
  return out;
}

Box3d mesh_bounds(const MeshData& data, const Mat4d& m) {
  // Of the vertices that triangles have: others may be anywhere, or not be numbers.
  std::vector<bool> used(data.positions.size() / 3, data.indices.empty());
  for (const uint32_t i : data.indices) used[i] = true;
  Box3d box;
  for (size_t i = 0; i < used.size(); ++i) {
    if (used[i]) box.extendBy(transform_point(m, point_of(data.positions, i)));
  }
  return box;
}

std::unique_ptr<Mesh> bake_mesh(const MeshData& data, const Mat4d& object_to_group, size_t& degenerate) {
  std::unique_ptr<Mesh> mesh = bake_vertices(data, object_to_group);
  degenerate = 0;
  mesh->indices.reserve(data.indices.size());
  for (size_t t = 0; t + 2 < data.indices.size(); t += 3) {
    const uint32_t a = data.indices[t], b = data.indices[t + 1], c = data.indices[t + 2];
    if (!has_area(*mesh, a, b, c)) {
      ++degenerate;
      continue;
    }
    mesh->indices.insert(mesh->indices.end(), {a, b, c});
  }
  return mesh;
}

std::unique_ptr<Mesh> bake_huge(const MeshData& data, const MeshData& neighbours, const Mat4d& object_to_group,
                                size_t& degenerate) {
  std::unique_ptr<Mesh> mesh = bake_vertices(data, object_to_group);
  const EdgeSet shared = shared_edges(data, neighbours);
  degenerate = 0;
  for (size_t t = 0; t + 2 < data.indices.size(); t += 3) {
    Vec3d p[3];
    for (size_t k = 0; k < 3; ++k)
      p[k] = transform_point(object_to_group, point_of(data.positions, data.indices[t + k]));
    if (!((p[1] - p[0]).cross(p[2] - p[0]).length2() > 0)) {
      ++degenerate;
      continue;
    }
    ExactTriangle& triangle = mesh->exact.emplace_back(exact_triangle(p[0], p[1], p[2]));
    for (size_t k = 0; k < 3; ++k) {
      const size_t next = (k + 1) % 3;
      const Vec3d q = point_of(data.positions, data.indices[t + k]),
                  r = point_of(data.positions, data.indices[t + next]);
      if (shared.count(edge_of(q, r))) triangle.reach[k] = 0x1p-22 * std::max(p[k].length(), p[next].length());
    }
    mesh->indices.insert(mesh->indices.end(), data.indices.begin() + static_cast<std::ptrdiff_t>(t),
                         data.indices.begin() + static_cast<std::ptrdiff_t>(t) + 3);
  }
  return mesh;
}

std::unique_ptr<Curves> bake_curves(const CurveData& data, const Mat4d& object_to_group) {
  auto curves = std::make_unique<Curves>();
  curves->kind = data.kind;
  curves->u_range = data.u_range;
  curves->normals = data.normals;
  curves->split_depth = data.split_depth;
  const size_t points = data.control_points.size() / 3;
  Box3d box;
  for (size_t i = 0; i < points; ++i) box.extendBy(point_of(data.control_points, i));
  // Relative to their middle, so that curves far from their object's origin keep their digits.
  const Vec3d middle = box.isEmpty() ? Vec3d(0, 0, 0) : box.center();
  for (size_t i = 0; i < points; ++i) {
    append(curves->control_points, point_of(data.control_points, i) - middle);
    curves->control_points.push_back(0.5f * data.widths[i]);
  }
  curves->to_group = Mat4d().translate(middle) * object_to_group;
  curves->from_group = curves->to_group.inverse();
  return curves;
}

}  // namespace whit
