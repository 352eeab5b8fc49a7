// Loop's subdivision surface (Loop 1987) as in pbrt-v3: a triangle mesh is refined a few times, its vertices are then
// moved to the limit surface and get that surface's normals (Hoppe et al. 1994; PBR 3e, section 3.8). An edge that
// belongs to one face only is a boundary, which is a cubic B-spline of its own.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "core/base/quadratic.h"
#include "core/plugin/memory_need.h"
#include "core/plugin/registry.h"
#include "core/plugin/shape.h"

namespace whit {
namespace {

constexpr uint32_t kNone = 0xffffffffu;

/// Half-edge h goes from corner h of the face h / 3 to the face's next corner.
uint32_t next(uint32_t h) { return h % 3 == 2 ? h - 2 : h + 1; }
uint32_t previous(uint32_t h) { return h % 3 == 0 ? h + 2 : h - 1; }

/// The weight of each neighbour in the refined place of an interior vertex (Warren's simplification).
double refine_weight(size_t valence) { return valence == 3 ? 3. / 16 : 3. / (8 * static_cast<double>(valence)); }
/// The weight of each neighbour in an interior vertex's limit.
double limit_weight(size_t valence) { return 1 / (static_cast<double>(valence) + 3 / (8 * refine_weight(valence))); }

/// The neighbours of a vertex in order. Interior: clockwise seen from the front. Boundary: from one end of the fan of
/// faces to the other, counter-clockwise.
struct Ring {
  std::vector<Vec3d> p;
  bool boundary = false;
};

/// A mesh that knows its neighbours.
struct SubdivisionMesh {
  std::vector<Vec3d> p;
  std::vector<uint32_t> corner;  ///< The vertex that half-edge h starts at.
  std::vector<uint32_t> twin;    ///< The half-edge the other way in the neighbouring face, or kNone.
  std::vector<uint32_t> start;   ///< Of each vertex: a half-edge that starts there; kNone where no face uses it.

  /// Fills in a ring that may have been another one: with memory of its own each vertex would ask for some.
  void ring(uint32_t v, Ring& out) const;
  SubdivisionMesh refined() const;
  /// The vertices' places on the limit surface.
  std::vector<Vec3d> limit() const { return moved(1. / 5, limit_weight); }

  template <class Weight>
  std::vector<Vec3d> moved(double boundary_weight, const Weight& interior_weight) const;

 private:
  Vec3d edge_point(uint32_t h) const;
};

/// Mates half-edges. Where more than two faces meet, or two that are wound differently, some find no mate and count
/// as boundaries; returns how many.
size_t find_twins(SubdivisionMesh& mesh) {
  const auto key = [&](uint32_t from, uint32_t to) { return uint64_t{from} << 32 | to; };
  const auto count = static_cast<uint32_t>(mesh.corner.size());
  std::unordered_map<uint64_t, uint32_t> directed;
  directed.reserve(count);
  size_t rejected = 0;
  for (uint32_t h = 0; h < count; ++h) {
    rejected += !directed.try_emplace(key(mesh.corner[h], mesh.corner[next(h)]), h).second;
  }
  mesh.twin.assign(count, kNone);
  for (const auto& [edge, h] : directed) {
    const auto other = directed.find(key(mesh.corner[next(h)], mesh.corner[h]));
    if (other != directed.end()) mesh.twin[h] = other->second;
  }
  mesh.start.assign(mesh.p.size(), kNone);
  for (uint32_t h = 0; h < count; ++h) mesh.start[mesh.corner[h]] = h;
  return rejected;
}

void SubdivisionMesh::ring(uint32_t v, Ring& out) const {
  out.p.clear();
  out.boundary = false;
  uint32_t h = start[v];
  do {
    out.p.push_back(p[corner[next(h)]]);
    if (twin[h] == kNone) out.boundary = true;
    else h = next(twin[h]);
  } while (h != start[v] && !out.boundary);
  if (!out.boundary) return;
  // h is the clockwise end of the fan.
  out.p.assign(1, p[corner[next(h)]]);
  while (h != kNone) {
    out.p.push_back(p[corner[previous(h)]]);
    h = twin[previous(h)];
  }
}

/// Every vertex as a weighted mean of itself and its neighbours; on a boundary, of its neighbours there.
template <class Weight>
std::vector<Vec3d> SubdivisionMesh::moved(double boundary_weight, const Weight& interior_weight) const {
  std::vector<Vec3d> out(p);
  Ring r;
  for (uint32_t v = 0; v < p.size(); ++v) {
    if (start[v] == kNone) continue;
    ring(v, r);
    if (r.boundary) {
      out[v] = p[v] * (1 - 2 * boundary_weight) + (r.p.front() + r.p.back()) * boundary_weight;
      continue;
    }
    const double weight = interior_weight(r.p.size());
    out[v] = p[v] * (1 - static_cast<double>(r.p.size()) * weight);
    for (const Vec3d& q : r.p) out[v] += q * weight;
  }
  return out;
}

/// The new vertex on an edge.
Vec3d SubdivisionMesh::edge_point(uint32_t h) const {
  const Vec3d ends = p[corner[h]] + p[corner[next(h)]];
  if (twin[h] == kNone) return ends / 2;
  return ends * (3. / 8) + (p[corner[previous(h)]] + p[corner[previous(twin[h])]]) / 8;
}

/// Face f becomes 4 f + k, its k-th corner with the halves of the two edges there, and 4 f + 3 in their midst. A
/// corner stays the k-th of its face, which fixes the texture coordinates of meshes that have none.
SubdivisionMesh SubdivisionMesh::refined() const {
  const auto count = static_cast<uint32_t>(corner.size());
  const auto child = [](uint32_t h, uint32_t k) { return 12 * (h / 3) + 3 * (h % 3) + k % 3; };
  SubdivisionMesh out;
  out.p = moved(1. / 8, refine_weight);
  std::vector<uint32_t> middle(count);
  for (uint32_t h = 0; h < count; ++h) {
    const bool first = twin[h] == kNone || h < twin[h];
    middle[h] = first ? static_cast<uint32_t>(out.p.size()) : middle[twin[h]];
    if (first) out.p.push_back(edge_point(h));
  }
  out.corner.resize(4 * corner.size());
  out.twin.assign(4 * corner.size(), kNone);
  out.start.assign(out.p.size(), kNone);
  for (uint32_t h = 0; h < count; ++h) {
    const uint32_t k = h % 3, a = child(h, k), b = child(h, k + 1), c = child(h, k + 2);
    const uint32_t inner = 12 * (h / 3) + 9 + previous(h) % 3;
    out.corner[a] = corner[h], out.corner[b] = middle[h], out.corner[c] = middle[previous(h)];
    out.corner[12 * (h / 3) + 9 + k] = middle[h];
    out.twin[b] = inner, out.twin[inner] = b;
    if (twin[h] != kNone) {
      const uint32_t beyond = next(twin[h]);
      out.twin[a] = child(beyond, beyond % 3 + 2);
    }
    if (const uint32_t side = twin[previous(h)]; side != kNone) out.twin[c] = child(side, side % 3);
    if (start[corner[h]] == h) out.start[corner[h]] = a;
    out.start[middle[h]] = b;
  }
  return out;
}

/// The limit surface's normal from the tangents along and across the ring; as pbrt-v3, from neighbours that lie on
/// the limit surface themselves, and pointing to where faces look clockwise.
Vec3d limit_normal(const Vec3d& p, const Ring& ring) {
  const size_t n = ring.p.size();
  const std::vector<Vec3d>& r = ring.p;
  Vec3d s(0, 0, 0), t(0, 0, 0);
  if (!ring.boundary) {
    for (size_t j = 0; j < n; ++j) {
      const double angle = 2 * kPiD * static_cast<double>(j) / static_cast<double>(n);
      s += std::cos(angle) * r[j], t += std::sin(angle) * r[j];
    }
    return s.cross(t);
  }
  s = r[n - 1] - r[0];
  if (n == 2) {
    t = r[0] + r[1] - 2.0 * p;
  } else if (n == 3) {
    t = r[1] - p;
  } else if (n == 4) {
    t = 2.0 * (r[1] + r[2]) - r[0] - r[3] - 2.0 * p;
  } else {
    const double theta = kPiD / static_cast<double>(n - 1);
    t = -std::sin(theta) * (r[0] + r[n - 1]);
    for (size_t k = 1; k + 1 < n; ++k) {
      t += (2 - 2 * std::cos(theta)) * std::sin(static_cast<double>(k) * theta) * r[k];
    }
  }
  return s.cross(t);
}

struct LoopSubdivision final : MeshShape, NeedsMemory {
  int levels, nlevels;
  Choice scheme;
  IntegerList indices;
  Point3List P;

  void check(Diagnostics& diagnostics, SourcePos statement) override {
    if (is_empty()) {
      const char* lacks = indices.size() + P.size() == 0 ? "triangles" : P.size() == 0 ? "\"P\"" : "\"indices\"";
      return diagnostics.warning(statement, fmt::format("loopsubdiv has no {}", lacks), "it is left out");
    }
    check_indices(diagnostics);
    const double triangles = static_cast<double>(indices.size() / 3) * std::pow(4.0, level_count());
    if (triangles > kMostTriangles) {
      diagnostics.error(statement, fmt::format("{} levels make {:.3g} triangles, more than {:.3g}", level_count(),
                                               triangles, kMostTriangles));
    }
  }

  MemoryNeed memory_need(const MeshAttributes&) const override {
    if (is_empty()) return {};
    // As many edges as a closed surface has, or one in a piece. Each edge gets a vertex, and becomes two, with three more in
    // each face, which becomes four.
    uint64_t vertices = P.size() / 3, faces = indices.size() / 3, edges = std::max(faces * 3 / 2, vertices + faces);
    for (int level = 0; level < level_count(); ++level) {
      vertices += edges, edges = 2 * edges + 3 * faces, faces *= 4;
    }
    MemoryNeed need{.vertices = vertices, .triangles = faces, .floats = 3};
    // Places, once more on the limit surface, and normals in double; three half-edges of each face know their twins, and
    // each vertex one of them.
    need.making = vertices * (2 * sizeof(Vec3d) + sizeof(uint32_t)) + faces * 3 * sizeof(uint32_t);
    return need;
  }

  bool build_mesh(const PrepareContext& ctx, MeshData& out) override {
    if (is_empty()) return true;
    SubdivisionMesh mesh = base_mesh(ctx);
    for (int level = 0; level < level_count(); ++level) mesh = mesh.refined();
    mesh.p = mesh.limit();
    std::vector<Vec3d> normals(mesh.p.size(), Vec3d(0, 0, 0));
    double longest = std::numeric_limits<double>::min();
    Ring ring;
    for (uint32_t v = 0; v < mesh.p.size(); ++v) {
      if (mesh.start[v] != kNone) mesh.ring(v, ring), normals[v] = limit_normal(mesh.p[v], ring);
      longest = std::max(longest, normals[v].length());
    }
    out.owned_positions.reserve(3 * mesh.p.size());
    out.normals.reserve(3 * mesh.p.size());
    // Not unit vectors: pbrt-v3 interpolates them as they are, the longer of two neighbours weighing more.
    for (uint32_t v = 0; v < mesh.p.size(); ++v) {
      for (int c = 0; c < 3; ++c) {
        out.owned_positions.push_back(mesh.p[v][c]);
        out.normals.push_back(static_cast<float>(normals[v][c] / longest));
      }
    }
    out.positions = out.owned_positions;
    out.indices = std::move(mesh.corner);
    remove_degenerate_triangles(out);
    if (out.indices.empty()) ctx.diagnostics->warning(ctx.statement, "loopsubdiv has no area", "it is left out");
    return true;
  }

 private:
  static constexpr double kMostTriangles = 3e8;

  bool is_empty() const { return indices.size() == 0 || P.size() == 0; }
  int level_count() const { return levels < 0 ? nlevels : levels; }

  void check_indices(Diagnostics& diagnostics) const {
    if (indices.size() % 3 != 0) {
      diagnostics.error(indices.where, fmt::format("number of indices is not a multiple of three: {}", indices.size()));
    }
    for (const int32_t i : indices.values) {
      if (static_cast<size_t>(i) < P.size() / 3) continue;
      return diagnostics.error(indices.where, fmt::format("loopsubdiv refers to vertex index {}, but there are {} "
                                                          "vertices in \"P\"",
                                                          i, P.size() / 3));
    }
  }

  /// The control mesh without faces that use a vertex twice.
  SubdivisionMesh base_mesh(const PrepareContext& ctx) const {
    SubdivisionMesh mesh;
    for (size_t i = 0; i + 2 < P.size(); i += 3) mesh.p.emplace_back(P.values[i], P.values[i + 1], P.values[i + 2]);
    size_t left_out = 0;
    for (size_t f = 0; f + 2 < indices.size(); f += 3) {
      const auto at = [&](size_t k) { return static_cast<uint32_t>(indices.values[f + k]); };
      const bool line = at(0) == at(1) || at(1) == at(2) || at(2) == at(0);
      left_out += line;
      if (!line) mesh.corner.insert(mesh.corner.end(), {at(0), at(1), at(2)});
    }
    if (left_out > 0) {
      ctx.diagnostics->warning(
          indices.where,
          fmt::format("loopsubdiv has {} face{} with a vertex twice", left_out, left_out == 1 ? "" : "s"), "left out");
    }
    if (const size_t odd = find_twins(mesh)) {
      ctx.diagnostics->warning(
          indices.where,
          fmt::format("loopsubdiv is not a manifold: {} edge{} of faces cannot be joined", odd, odd == 1 ? "" : "s"),
          "they are taken as boundaries; check the winding of the faces");
    }
    return mesh;
  }
};

const Register<LoopSubdivision> loopsubdiv{
    "loopsubdiv",
    "Loop's subdivision surface over a triangle mesh.",
    param(&LoopSubdivision::indices, "indices", Unit::None,
          "Three vertex numbers per triangle, counted from 0. Required.", kNonNegative),
    param(&LoopSubdivision::P, "P", Unit::Length, "The control points. Required.", kCoordinates),
    param(&LoopSubdivision::nlevels, "nlevels", 3, Unit::None, "How often the mesh is refined.", Range{0.0, 12.0}),
    param(&LoopSubdivision::levels, "levels", -1, Unit::None, "Another name of nlevels, used unless it is -1.",
          Range{-1.0, 12.0}),
    choice(&LoopSubdivision::scheme, "scheme", {"loop"}, "The kind of subdivision; there is one.")};

}  // namespace
}  // namespace whit
