// A triangle mesh written out in the scene file: corners by index, points, and optionally normals, tangents and
// surface parameters per point. Triangles without area are left out.

#include <fmt/format.h>

#include "core/plugin/memory_need.h"
#include "core/plugin/registry.h"
#include "core/plugin/shape.h"

namespace whit {

/// Pairs of surface parameters, which pbrt-v3 takes as point2 or as float; point2 first, whatever the order.
struct SurfaceParameters : UvList {
  bool as_points = false;
};

template <>
struct detail::Binding<SurfaceParameters> {
  static std::vector<ParamType> accepts() { return Binding<UvList>::accepts(); }
  static std::string to_text(const SurfaceParameters&) { return {}; }
  static bool read(const Parameter& p, const BindContext& ctx, const Range& range, SurfaceParameters& out) {
    if (out.as_points) return true;
    out.as_points = p.type == ParamType::Point2;
    return Binding<UvList>::read(p, ctx, range, out);
  }
};

namespace {

std::vector<float> to_floats(std::span<const double> values) { return {values.begin(), values.end()}; }

struct TriangleMesh final : MeshShape, NeedsMemory {
  IntegerList indices;
  Point3List P;
  NormalList N;
  Vector3List S;
  SurfaceParameters uv, st;

  void check(Diagnostics& diagnostics, SourcePos statement) override {
    if (is_empty()) {
      const char* lacks = indices.size() + P.size() == 0 ? "triangles" : P.size() == 0 ? "\"P\"" : "\"indices\"";
      return diagnostics.warning(statement, fmt::format("trianglemesh has no {}", lacks), "it is left out");
    }
    check_indices(diagnostics);
    check_per_vertex(diagnostics, N, "N", "normals");
    check_per_vertex(diagnostics, S, "S", "tangents");
    if (surface_parameters().given) check_uvs(diagnostics, surface_parameters());
  }

  MemoryNeed memory_need(const MeshAttributes&) const override {
    MemoryNeed need{.vertices = vertex_count(), .triangles = indices.size() / 3, .owns_vertices = false};
    need.floats = (N.given ? 3 : 0) + (S.given ? 3 : 0) + (surface_parameters().given ? 2 : 0);
    return need;
  }

  bool build_mesh(const PrepareContext&, MeshData& out) override {
    if (is_empty()) return true;
    out.positions = P.values;
    out.indices.assign(indices.values.begin(), indices.values.end());
    out.normals = to_floats(N.values);
    out.tangents = to_floats(S.values);
    if (surface_parameters().given) out.uvs = to_floats(surface_parameters().values.first(2 * vertex_count()));
    out.degenerate = remove_degenerate_triangles(out);
    return true;
  }

 private:
  bool is_empty() const { return indices.size() == 0 || P.size() == 0; }
  size_t vertex_count() const { return P.size() / 3; }
  /// As pbrt-v3 looks for them: point2 uv, point2 st, float uv, float st.
  const SurfaceParameters& surface_parameters() const { return uv.given && (uv.as_points || !st.as_points) ? uv : st; }

  void check_indices(Diagnostics& diagnostics) const {
    if (indices.size() % 3 != 0) {
      diagnostics.error(indices.where, fmt::format("number of indices is not a multiple of three: {}", indices.size()));
    }
    for (const int32_t i : indices.values) {
      if (static_cast<size_t>(i) < vertex_count()) continue;
      return diagnostics.error(indices.where, fmt::format("trianglemesh refers to vertex index {}, but there are {} "
                                                          "vertices in \"P\"",
                                                          i, vertex_count()));
    }
  }

  void check_per_vertex(Diagnostics& diagnostics, const List<double>& list, const char* name, const char* what) const {
    if (!list.given || list.size() == P.size()) return;
    diagnostics.error(list.where, fmt::format("\"{}\" has {} {}, but \"P\" has {} vertices", name, list.size() / 3,
                                              what, vertex_count()));
  }

  void check_uvs(Diagnostics& diagnostics, const SurfaceParameters& list) const {
    const char* name = &list == &uv ? "uv" : "st";
    if (list.size() < 2 * vertex_count()) {
      diagnostics.error(list.where, fmt::format("\"{}\" has {} numbers, but {} vertices need {}", name, list.size(),
                                                vertex_count(), 2 * vertex_count()));
    } else if (list.size() > 2 * vertex_count()) {
      diagnostics.warning(list.where,
                          fmt::format("\"{}\" has {} numbers, but {} vertices need only {}", name, list.size(),
                                      vertex_count(), 2 * vertex_count()),
                          "the rest is not used");
    }
  }
};

const Register<TriangleMesh> trianglemesh{
    "trianglemesh",
    "A triangle mesh given in the scene file.",
    param(&TriangleMesh::indices, "indices", Unit::None, "Three vertex numbers per triangle, counted from 0. Required.",
          kNonNegative),
    param(&TriangleMesh::P, "P", Unit::Length, "The vertices. Required.", kCoordinates),
    param(&TriangleMesh::N, "N", Unit::None, "Shading normals, one per vertex.", kCoordinates),
    param(&TriangleMesh::S, "S", Unit::None, "Shading tangents, one per vertex.", kCoordinates),
    param(&TriangleMesh::uv, "uv", Unit::None, "Surface parameters, one pair per vertex.", kCoordinates),
    param(&TriangleMesh::st, "st", Unit::None,
          "Another name of uv, used when uv is absent, or is of floats and this of points.", kCoordinates),
    alpha_param(),
    shadowalpha_param()};

}  // namespace
}  // namespace whit
