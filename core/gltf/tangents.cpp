// Tangents where a file has none, by the rules of MikkTSpace.
//
// Source: M. Mikkelsen, "Simulation of Wrinkled Surfaces Revisited" (2008), chapter 5, and the rules that everybody's
// baker follows since: corners share a tangent if they agree in position, normal and texture coordinates, if their
// triangles are connected by edges around the vertex, and if the pictures on them are mirrored alike. It is the mean of
// the triangles' directions of growing u, in the plane across the normal, weighed by the angles at the corner.
//
// Not taken over: groups are not divided again where two triangles' directions are exactly opposed.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <span>
#include <unordered_map>

#include "core/gltf/primitive_parts.h"

namespace whit::gltf {
namespace {

constexpr uint32_t kNone = ~0u;
/// What MikkTSpace takes for 0.
bool is_zero(double x) { return !(std::abs(x) > 1.17549435e-38); }

Vec3d vector_at(const auto& values, size_t i) {
  return {double{values[i * 3]}, double{values[i * 3 + 1]}, double{values[i * 3 + 2]}};
}

/// v without its part along n, as a unit vector, or 0.
Vec3d across(const Vec3d& n, const Vec3d& v) { return (v - n * n.dot(v)).normalized(); }

struct Triangle {
  Vec3d direction{0, 0, 0};  ///< In which u grows; unit.
  bool any = true;           ///< Its picture has no area: it goes with any group.
  bool mirrored = true;
};

class TangentMaker {
 public:
  TangentMaker(MeshData& mesh, const std::vector<float>& uvs) : mesh_(mesh), uvs_(uvs) {}

  void make() {
    weld();
    find_directions();
    find_neighbours();
    group_of_.assign(mesh_.indices.size(), kNone);
    for (uint32_t corner = 0; corner < mesh_.indices.size(); ++corner) {
      if (group_of_[corner] == kNone && !triangles_[corner / 3].any) make_group(corner);
    }
    // What no group has reached.
    for (uint32_t corner = 0; corner < mesh_.indices.size(); ++corner) {
      if (group_of_[corner] == kNone) group_of_[corner] = add_group(any_direction(normal(corner)), 1);
    }
    split_vertices();
  }

 private:
  struct Group {
    float tangent[3], sign;
  };

  /// next(corner) and last(corner) are the triangle's other corners.
  static uint32_t next(uint32_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }
  static uint32_t last(uint32_t corner) { return corner % 3 == 0 ? corner + 2 : corner - 1; }
  Vec3d position(uint32_t corner) const { return vector_at(mesh_.positions, mesh_.indices[corner]); }
  Vec3d normal(uint32_t corner) const { return vector_at(mesh_.normals, mesh_.indices[corner]).normalized(); }
  Vec2d uv(uint32_t corner) const {
    const size_t i = size_t{mesh_.indices[corner]} * 2;
    return {double{uvs_[i]}, double{uvs_[i + 1]}};
  }

  /// Gives vertices that are alike one number. Only those of triangles: others may be no numbers, which equal nothing.
  void weld() {
    const size_t n = mesh_.positions.size() / 3;
    welded_.assign(n, kNone);
    const size_t size = std::bit_ceil(n * 2 + 1);
    std::vector<uint32_t> table(size, kNone);
    const auto key = [&](size_t v) {
      // Minus 0 is 0.
      return std::array<double, 8>{mesh_.positions[v * 3] + 0.0,
                                   mesh_.positions[v * 3 + 1] + 0.0,
                                   mesh_.positions[v * 3 + 2] + 0.0,
                                   double{mesh_.normals[v * 3]} + 0.0,
                                   double{mesh_.normals[v * 3 + 1]} + 0.0,
                                   double{mesh_.normals[v * 3 + 2]} + 0.0,
                                   double{uvs_[v * 2]} + 0.0,
                                   double{uvs_[v * 2 + 1]} + 0.0};
    };
    for (const uint32_t v : mesh_.indices) {
      if (welded_[v] != kNone) continue;
      const std::array<double, 8> k = key(v);
      uint64_t hash = 0;
      for (const double x : k) hash = (hash ^ std::bit_cast<uint64_t>(x)) * 0x9e3779b97f4a7c15u, hash ^= hash >> 29;
      size_t slot = hash & (size - 1);
      while (table[slot] != kNone && key(table[slot]) != k) slot = (slot + 1) & (size - 1);
      if (table[slot] == kNone) table[slot] = v;
      welded_[v] = table[slot];
    }
  }
  uint32_t welded(uint32_t corner) const { return welded_[mesh_.indices[corner]]; }

  void find_directions() {
    triangles_.resize(mesh_.indices.size() / 3);
    for (uint32_t t = 0; t < triangles_.size(); ++t) {
      const Vec3d p = position(t * 3), d1 = position(t * 3 + 1) - p, d2 = position(t * 3 + 2) - p;
      const Vec2d o = uv(t * 3), e1 = uv(t * 3 + 1) - o, e2 = uv(t * 3 + 2) - o;
      const double area = e1.x * e2.y - e1.y * e2.x;
      const Vec3d along = d1 * e2.y - d2 * e1.y, up = d2 * e1.x - d1 * e2.x;
      Triangle& out = triangles_[t];
      out.mirrored = !(area > 0);
      if (is_zero(area) || is_zero(along.length()) || is_zero(up.length())) continue;
      out.any = false;
      out.direction = along.normalized() * (out.mirrored ? -1 : 1);
    }
  }

  /// An edge, at the lower of its ends.
  struct Edge {
    uint32_t other, corner;  ///< The other end, and the corner that it follows.
    bool operator<(const Edge& e) const { return other != e.other ? other < e.other : corner < e.corner; }
  };

  /// Matches the edge after each corner with the edge of another triangle that runs the other way.
  void find_neighbours() {
    const auto corners = static_cast<uint32_t>(mesh_.indices.size());
    const auto lower = [&](uint32_t c) { return std::min(welded(c), welded(next(c))); };
    // Sorted by counting by the lower end, then few by few.
    std::vector<uint32_t> start(welded_.size() + 2);
    for (uint32_t c = 0; c < corners; ++c) ++start[lower(c) + 2];
    for (size_t v = 2; v < start.size(); ++v) start[v] += start[v - 1];
    std::vector<Edge> edges(corners);
    for (uint32_t c = 0; c < corners; ++c) edges[start[lower(c) + 1]++] = {std::max(welded(c), welded(next(c))), c};
    neighbour_.assign(corners, kNone);
    for (size_t v = 0; v + 1 < start.size(); ++v) {
      std::sort(edges.begin() + start[v], edges.begin() + start[v + 1]);
      match_edges({edges.data() + start[v], start[v + 1] - start[v]}, static_cast<uint32_t>(v));
    }
  }

  /// The first that run one way with the first that run the other, of those between the same ends.
  void match_edges(std::span<const Edge> edges, uint32_t lower_end) {
    for (size_t begin = 0, end; begin < edges.size(); begin = end) {
      for (auto& waiting : waiting_) waiting.clear();
      for (end = begin; end < edges.size() && edges[end].other == edges[begin].other; ++end) {
        waiting_[welded(edges[end].corner) == lower_end ? 0 : 1].push_back(edges[end].corner);
      }
      for (size_t k = 0; k < std::min(waiting_[0].size(), waiting_[1].size()); ++k) {
        neighbour_[waiting_[0][k]] = waiting_[1][k], neighbour_[waiting_[1][k]] = waiting_[0][k];
      }
    }
  }

  /// The corner at the same vertex beyond the edge after, or before, a corner.
  uint32_t beyond_next(uint32_t corner) const { return neighbour_[corner] == kNone ? kNone : next(neighbour_[corner]); }
  uint32_t beyond_last(uint32_t corner) const { return neighbour_[last(corner)]; }

  /// Spreads from a corner to all around its vertex that go with it, and gives them the mean of their directions.
  void make_group(uint32_t first) {
    const bool mirrored = triangles_[first / 3].mirrored;
    const auto group = static_cast<uint32_t>(groups_.size());
    Vec3d sum(0.0);
    open_.assign(1, first);
    while (!open_.empty()) {
      const uint32_t corner = open_.back();
      open_.pop_back();
      if (corner == kNone || group_of_[corner] != kNone) continue;
      Triangle& triangle = triangles_[corner / 3];
      const uint32_t base = corner / 3 * 3;
      if (triangle.any && group_of_[base] == kNone && group_of_[base + 1] == kNone && group_of_[base + 2] == kNone)
        triangle.mirrored = mirrored;
      if (triangle.mirrored != mirrored) continue;
      group_of_[corner] = group;
      if (!triangle.any) sum += weighed_direction(corner);
      open_.push_back(beyond_last(corner));
      open_.push_back(beyond_next(corner));
    }
    const Vec3d n = normal(first);
    add_group(is_zero(sum.length()) ? any_direction(n) : sum.normalized(), mirrored ? -1 : 1);
  }

  Vec3d weighed_direction(uint32_t corner) const {
    const Vec3d n = normal(corner), p = position(corner);
    const Vec3d a = across(n, position(next(corner)) - p), b = across(n, position(last(corner)) - p);
    return across(n, triangles_[corner / 3].direction) * std::acos(std::clamp(a.dot(b), -1.0, 1.0));
  }

  /// Where there is no direction of growing u. MikkTSpace has (1, 0, 0) there, which may be the normal.
  static Vec3d any_direction(const Vec3d& n) {
    return across(n, std::abs(n.x) < 0.9 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0));
  }

  uint32_t add_group(const Vec3d& tangent, int sign) {
    groups_.push_back({{static_cast<float>(tangent.x), static_cast<float>(tangent.y), static_cast<float>(tangent.z)},
                       static_cast<float>(sign)});
    return static_cast<uint32_t>(groups_.size() - 1);
  }

  /// A vertex for each group that meets in one.
  void split_vertices() {
    const size_t n = mesh_.positions.size() / 3;
    std::vector<uint32_t> from(n), group(n, kNone);
    for (uint32_t v = 0; v < n; ++v) from[v] = v;
    std::unordered_map<uint64_t, uint32_t> more;
    for (uint32_t c = 0; c < mesh_.indices.size(); ++c) {
      const uint32_t v = mesh_.indices[c], g = group_of_[c];
      if (group[v] == kNone) group[v] = g;
      if (alike(groups_[group[v]], groups_[g])) continue;
      const auto [found, fresh] = more.try_emplace(uint64_t{v} << 32 | g, static_cast<uint32_t>(from.size()));
      if (fresh) from.push_back(v), group.push_back(g);
      mesh_.indices[c] = found->second;
    }
    if (from.size() > n) pick_vertices(mesh_, from);
    mesh_.tangents.resize(from.size() * 3), mesh_.bitangent_signs.resize(from.size());
    for (size_t v = 0; v < from.size(); ++v) {
      const Group unused{{1, 0, 0}, 1};
      const Group& g = group[v] == kNone ? unused : groups_[group[v]];
      std::copy_n(g.tangent, 3, mesh_.tangents.data() + v * 3);
      mesh_.bitangent_signs[v] = g.sign;
    }
  }
  static bool alike(const Group& a, const Group& b) {
    return a.tangent[0] == b.tangent[0] && a.tangent[1] == b.tangent[1] && a.tangent[2] == b.tangent[2] &&
           a.sign == b.sign;
  }

  MeshData& mesh_;
  const std::vector<float>& uvs_;
  std::vector<uint32_t> welded_;     ///< Of vertices.
  std::vector<uint32_t> neighbour_;  ///< Of corners: the corner that begins the other triangle's edge.
  std::vector<uint32_t> group_of_, open_, waiting_[2];
  std::vector<Triangle> triangles_;
  std::vector<Group> groups_;
};

}  // namespace

void add_tangents(MeshData& mesh, const std::vector<float>& uvs) { TangentMaker(mesh, uvs).make(); }

}  // namespace whit::gltf
