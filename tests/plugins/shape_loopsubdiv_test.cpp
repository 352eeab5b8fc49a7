// Loop subdivision: limits that are known in closed form, and meshes that are not as they should be.
#include <cmath>
#include <map>

#include "shape_support.h"

namespace whit::shape_test {
namespace {

const std::vector<int32_t> kOctahedron{0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
const std::vector<double> kOctahedronPoints{1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1};

MeshData build(Made& made) {
  MeshData mesh;
  EXPECT_TRUE(made.ok() && made.build(mesh)) << made.said();
  return mesh;
}
Vec3d position(const MeshData& m, size_t i) {
  return {m.positions[3 * i], m.positions[3 * i + 1], m.positions[3 * i + 2]};
}

TEST(LoopSubdivision, CornersGoToTheirLimitAtEveryLevel) {
  // A limit is a limit: refining does not move it. For valence 4, beta is 3/32 and gamma 1/(4 + 4) = 1/8, so a
  // corner keeps half of its place; the opposite weights cancel.
  for (const int levels : {0, 1, 2, 4}) {
    Made made("loopsubdiv",
              {integers("indices", kOctahedron), points("P", kOctahedronPoints), integers("nlevels", {levels})});
    const MeshData mesh = build(made);
    EXPECT_EQ(mesh.indices.size(), 24u << (2 * levels));
    EXPECT_EQ(mesh.positions.size() / 3, static_cast<size_t>(4 << (2 * levels)) + 2);  // Euler
    for (size_t v = 0; v < 6; ++v) {
      const Vec3d corner(kOctahedronPoints[3 * v], kOctahedronPoints[3 * v + 1], kOctahedronPoints[3 * v + 2]);
      EXPECT_LT((position(mesh, v) - corner / 2).length(), 1e-12);
      const Vec3d n = Vec3d(mesh.normals[3 * v], mesh.normals[3 * v + 1], mesh.normals[3 * v + 2]).normalized();
      // Faces wind outwards; pbrt's normals point the other way.
      EXPECT_LT((n + corner).length(), 1e-6);
    }
  }
}

TEST(LoopSubdivision, ChildrenShareTheirVerticesAndKeepTheirWinding) {
  Made made("loopsubdiv", {integers("indices", kOctahedron), points("P", kOctahedronPoints), integers("levels", {3})});
  const MeshData mesh = build(made);
  std::map<std::pair<uint32_t, uint32_t>, int> edges;
  for (size_t t = 0; t < mesh.indices.size(); t += 3) {
    for (size_t k = 0; k < 3; ++k) ++edges[{mesh.indices[t + k], mesh.indices[t + (k + 1) % 3]}];
    const Vec3d a = position(mesh, mesh.indices[t]), b = position(mesh, mesh.indices[t + 1]),
                c = position(mesh, mesh.indices[t + 2]);
    EXPECT_GT((b - a).cross(c - a).dot(a + b + c), 0);
  }
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1);
    EXPECT_EQ(edges.count({edge.second, edge.first}), 1u);
  }
}

TEST(LoopSubdivision, BoundariesAreSplinesAndPlanesStayPlane) {
  // A square of two triangles. The limit of a boundary corner is 3/5 of itself and 1/5 of each neighbour.
  Made made("loopsubdiv", {integers("indices", {0, 1, 2, 0, 2, 3}), points("P", {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}),
                           integers("nlevels", {0})});
  const MeshData mesh = build(made);
  EXPECT_LT((position(mesh, 0) - Vec3d(0.2, 0.2, 0)).length(), 1e-12);
  EXPECT_LT((position(mesh, 2) - Vec3d(0.8, 0.8, 0)).length(), 1e-12);
  Made fine("loopsubdiv", {integers("indices", {0, 1, 2, 0, 2, 3}), points("P", {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0})});
  const MeshData smooth = build(fine);
  EXPECT_EQ(smooth.indices.size(), 6u << 6);  // 3 levels by default
  for (size_t v = 0; v < smooth.positions.size() / 3; ++v) {
    EXPECT_EQ(smooth.positions[3 * v + 2], 0);
    EXPECT_LT(smooth.normals[3 * v + 2], 0);
    EXPECT_EQ(smooth.normals[3 * v], 0);
  }
}

TEST(LoopSubdivision, MistakesAreSaid) {
  const auto said = [](ParameterList list, const char* what, bool error) {
    Made made("loopsubdiv", std::move(list));
    MeshData mesh;
    if (made.ok()) made.build(mesh);
    EXPECT_EQ(made.ok(), !error) << made.said();
    EXPECT_TRUE(made.says(what)) << made.said();
    for (const float n : mesh.normals) EXPECT_TRUE(std::isfinite(n));
  };
  const Parameter p = points("P", {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 1, 1, 1});
  said({p}, "no \"indices\"", false);
  said({integers("indices", {0, 1, 2})}, "no \"P\"", false);
  said({integers("indices", {0, 1}), p}, "not a multiple of three", true);
  said({integers("indices", {0, 1, 9}), p}, "refers to vertex index 9", true);
  said({integers("indices", {0, 1, 1, 0, 1, 2}), p}, "1 face with a vertex twice", false);
  said({integers("indices", {0, 1, 2, 0, 1, 3}), p}, "not a manifold", false);
  std::vector<int32_t> many;
  for (int i = 0; i < 100; ++i) many.insert(many.end(), {0, 1, 2});
  said({integers("indices", many), p, integers("levels", {12})}, "triangles, more than", true);
}

}  // namespace
}  // namespace whit::shape_test
