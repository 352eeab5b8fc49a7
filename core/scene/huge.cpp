#include "core/scene/huge.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "core/base/box.h"
#include "core/scene/far.h"

namespace whit {
namespace {

constexpr double kHuge = 2048, kHugeBesideOne = 16384;
/// With more small things than this they are looked at together.
constexpr size_t kMostCompared = 64;

double size_of(const Box3d& box) { return box.isEmpty() ? 0 : box.size().length(); }

/// Of a point from a box.
double distance_to(const Box3d& box, const Vec3d& p) {
  Vec3d off(0, 0, 0);
  for (int c = 0; c < 3; ++c) off[c] = std::max({box.min[c] - p[c], p[c] - box.max[c], 0.0});
  return off.length();
}

double distance_to_segment(const Vec3d& a, const Vec3d& b, const Vec3d& p) {
  const Vec3d along = b - a;
  const double length2 = along.length2(), at = length2 > 0 ? std::clamp(along.dot(p - a) / length2, 0.0, 1.0) : 0.0;
  return (p - a - at * along).length();
}

double distance_to_triangle(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& p) {
  const Vec3d n = (b - a).cross(c - a).normalized();
  const auto inside = [&](const Vec3d& q, const Vec3d& r) { return n.cross(r - q).dot(p - q) >= 0; };
  if (inside(a, b) && inside(b, c) && inside(c, a)) return std::abs(n.dot(p - a));
  return std::min({distance_to_segment(a, b, p), distance_to_segment(b, c, p), distance_to_segment(c, a, p)});
}

Vec3d corner(const MeshData& mesh, size_t i) {
  const size_t v = 3 * static_cast<size_t>(mesh.indices[i]);
  return {mesh.positions[v], mesh.positions[v + 1], mesh.positions[v + 2]};
}

Box3d box_of(const MeshData& mesh, size_t t) {
  return triangle_box(corner(mesh, 3 * t), corner(mesh, 3 * t + 1), corner(mesh, 3 * t + 2));
}

/// What there is of a mesh beside triangles kHuge times larger, if it has such.
Box3d small_part(const MeshData& mesh) {
  const size_t n = mesh.indices.size() / 3;
  double largest = 0, smallest = std::numeric_limits<double>::infinity();
  for (size_t t = 0; t < n; ++t) {
    const double size2 = box_of(mesh, t).size().length2();
    largest = std::max(largest, size2), smallest = std::min(smallest, size2);
  }
  Box3d part;
  const double limit = largest / (kHuge * kHuge);
  if (!(smallest < limit)) return part;
  for (size_t t = 0; t < n; ++t) {
    const Box3d box = box_of(mesh, t);
    if (box.size().length2() < limit) part.extendBy(box);
  }
  return part;
}

}  // namespace

void CloseUps::add(const Box3d& content) {
  if (size_of(content) > 0) contents_.push_back({size_of(content), content, content});
}

void CloseUps::sort() {
  std::sort(contents_.begin(), contents_.end(), [](const Content& a, const Content& b) { return a.size < b.size; });
  for (size_t i = 0; i < contents_.size(); ++i) {
    contents_[i].all = contents_[i].own;
    if (i > 0) contents_[i].all.extendBy(contents_[i - 1].all);
  }
}

size_t CloseUps::count_below(double size) const {
  const auto end = std::partition_point(contents_.begin(), contents_.end(),
                                        [&](const Content& content) { return content.size < size; });
  return static_cast<size_t>(end - contents_.begin());
}

bool CloseUps::is_far(const Box3d& box) const { return extent_of(box, from_) > reach_; }

bool CloseUps::makes_huge(const Vec3d& a, const Vec3d& b, const Vec3d& c) const {
  const Box3d box = triangle_box(a, b, c);
  if (is_far(box)) return true;
  const double size = size_of(box);
  const auto is_near = [&](const Vec3d& p, double reach) {
    return distance_to(box, p) <= reach && distance_to_triangle(a, b, c, p) <= reach;
  };
  const auto is_beside = [&](const Box3d& content) { return is_near(content.center(), size_of(content)); };
  for (const Vec3d& eye : eyes_) {
    if (is_near(eye, size / kHuge)) return true;
  }
  const size_t small = count_below(size / kHuge), tiny = count_below(size / kHugeBesideOne);
  if (small == 0) return false;
  const Box3d& all = contents_[small - 1].all;
  if (size > kHuge * size_of(all) && is_beside(all)) return true;
  if (tiny > kMostCompared) return is_beside(contents_[tiny - 1].all);
  return std::any_of(contents_.begin(), contents_.begin() + static_cast<std::ptrdiff_t>(tiny),
                     [&](const Content& content) { return is_beside(content.own); });
}

bool CloseUps::may_make_huge(const Box3d& mesh) const {
  const double size = size_of(mesh);
  return is_far(mesh) || count_below(size / kHuge) > 0 ||
         std::any_of(eyes_.begin(), eyes_.end(),
                     [&](const Vec3d& eye) { return distance_to(mesh, eye) < size / kHuge; });
}

bool CloseUps::is_dwarfed_by(const Box3d& box) const {
  const double size = size_of(box);
  const size_t small = count_below(size / kHuge);
  return small > 0 && size > kHuge * size_of(contents_[small - 1].all) && box.intersects(contents_[small - 1].all);
}

std::vector<uint32_t> find_huge(const MeshData& mesh, const Mat4d& m, const Box3d& bounds, const CloseUps& around) {
  std::vector<uint32_t> huge;
  const Box3d part = small_part(mesh);
  if (part.isEmpty() && !around.may_make_huge(bounds)) return huge;
  CloseUps close_ups = around;
  if (!part.isEmpty()) close_ups.add(transform_box(m, part));
  close_ups.sort();
  const size_t n = mesh.indices.size() / 3;
  for (size_t t = 0; t < n; ++t) {
    const auto placed = [&](size_t k) { return transform_point(m, corner(mesh, 3 * t + k)); };
    if (close_ups.makes_huge(placed(0), placed(1), placed(2))) huge.push_back(static_cast<uint32_t>(t));
  }
  return huge;
}

MeshData take_huge(MeshData& mesh, std::span<const uint32_t> huge) {
  MeshData taken;
  std::unordered_map<uint32_t, uint32_t> number;  // Of the vertices that are taken.
  const auto take = [&](uint32_t from) {
    const auto found = number.try_emplace(from, static_cast<uint32_t>(number.size()));
    const bool is_new = found.second;  // Clang 14 captures no structured binding.
    const auto copy = [&](auto& to, const auto& values, size_t count) {
      if (is_new && !values.empty())
        to.insert(to.end(), values.begin() + from * count, values.begin() + (from + 1) * count);
    };
    copy(taken.owned_positions, mesh.positions, 3), copy(taken.normals, mesh.normals, 3);
    copy(taken.tangents, mesh.tangents, 3), copy(taken.uvs, mesh.uvs, 2);
    copy(taken.bitangent_signs, mesh.bitangent_signs, 1);
    copy(taken.uvs1, mesh.uvs1, 2), copy(taken.colors, mesh.colors, 4);
    return found.first->second;
  };
  size_t left = 0, next = 0;
  for (size_t t = 0; t < mesh.indices.size() / 3; ++t) {
    const bool is_huge = next < huge.size() && huge[next] == t;
    next += is_huge;
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t vertex = mesh.indices[3 * t + k];
      if (is_huge) taken.indices.push_back(take(vertex));
      else mesh.indices[left++] = vertex;
    }
  }
  mesh.indices.resize(left);
  taken.positions = taken.owned_positions;
  return taken;
}

}  // namespace whit
