// Baking meshes: positions rounded once, triangles without area dropped, normals carried by the inverse transpose.
#include "core/scene/bake.h"

#include <gtest/gtest.h>

#include <cmath>

namespace whit {
namespace {

Mat4d scaling(double x, double y, double z) { return Mat4d().setScale(Vec3d(x, y, z)); }

/// A mesh whose positions are in `points`, which must outlive it.
MeshData mesh_of(const std::vector<double>& points, std::vector<uint32_t> indices) {
  MeshData data;
  data.positions = points;
  data.indices = std::move(indices);
  return data;
}

TEST(BakeMesh, DropsTrianglesWithoutArea) {
  const std::vector<double> points = {0, 0, 0, 1, 0, 0, 0, 1, 0, 2, 0, 0, 1, 0, 0};
  // Good; a corner twice; three on the x axis; two corners in one place; good, turned.
  const MeshData data = mesh_of(points, {0, 1, 2, 0, 0, 2, 0, 1, 3, 1, 4, 2, 2, 1, 0});
  size_t degenerate = 99;
  const auto mesh = bake_mesh(data, Mat4d(), degenerate);
  EXPECT_EQ(degenerate, 3u);
  EXPECT_EQ(mesh->indices, (std::vector<uint32_t>{0, 1, 2, 2, 1, 0}));
  EXPECT_EQ(mesh->positions.size(), 3 * 5 + 1u);  // one of padding
}

TEST(BakeMesh, ATinyTriangleHasAnArea) {
  // The area of 0.5e-40 underflows in float, in double it does not.
  const std::vector<double> points = {0, 0, 0, 1e-20, 0, 0, 0, 1e-20, 0};
  size_t degenerate = 99;
  EXPECT_EQ(bake_mesh(mesh_of(points, {0, 1, 2}), Mat4d(), degenerate)->triangle_count(), 1u);
  EXPECT_EQ(degenerate, 0u);
}

TEST(BakeMesh, PositionsAreRoundedAfterTheTransform) {
  // At 1e9 floats are 64 apart, so rounding before the translation back would leave 0 or 64; the answer is exact.
  const std::vector<double> points = {1e9 + 0.25, 0, 0, 1e9 + 1, 0, 0, 1e9, 1, 0};
  size_t degenerate = 0;
  const auto mesh = bake_mesh(mesh_of(points, {0, 1, 2}), Mat4d().setTranslation(Vec3d(-1e9, 0, 0)), degenerate);
  EXPECT_EQ(mesh->position(0), Vec3f(0.25f, 0, 0));
  EXPECT_EQ(mesh->position(1), Vec3f(1, 0, 0));
}

TEST(BakeMesh, NormalsUnderNonUniformScaleStayPerpendicular) {
  // The plane x + y = 1: tangents (1,-1,0) and (0,0,1), normal (1,1,0). Scaled by (2,1,1) its tangent is (2,-1,0), so its
  // normal is along (1,2,0), where the transformed normal itself would be along (2,1,0).
  const std::vector<double> points = {1, 0, 0, 0, 1, 0, 1, 0, 1};
  MeshData data = mesh_of(points, {0, 1, 2});
  data.normals = {1, 1, 0, 1, 1, 0, 1, 1, 0};
  data.tangents = {1, -1, 0, 1, -1, 0, 1, -1, 0};
  size_t degenerate = 0;
  const auto mesh = bake_mesh(data, scaling(2, 1, 1), degenerate);
  const Vec3f n = mesh->normal(0).normalized();
  EXPECT_NEAR(n.x, 1 / std::sqrt(5.0), 1e-6);
  EXPECT_NEAR(n.y, 2 / std::sqrt(5.0), 1e-6);
  EXPECT_NEAR(n.z, 0, 1e-6);
  EXPECT_EQ(mesh->tangent(1), Vec3f(2, -1, 0));
}

TEST(NormalMatrix, IsOfOrdinarySizeWhateverTheScale) {
  // The inverse transpose of a scale by 1e-30 has entries of 1e30, whose squares floats cannot hold.
  for (const double size : {1e-30, 1.0, 1e30}) {
    const Mat4d n = normal_matrix(scaling(size, 2 * size, -4 * size) * Mat4d().setTranslation(Vec3d(5, 6, 7)));
    EXPECT_NEAR(n[0][0], 1, 1e-12);
    EXPECT_NEAR(n[1][1], 0.5, 1e-12);
    EXPECT_NEAR(n[2][2], -0.25, 1e-12);
    EXPECT_EQ(transform_point(n, Vec3d(0, 0, 0)), Vec3d(0, 0, 0));
  }
}

TEST(NormalMatrix, IsTheInverseTransposeButForItsScale) {
  // Sheared, and mirrored or not. The largest entry of the result is 1 or -1.
  for (const double z : {3.0, -3.0}) {
    const Mat4d m(1, 2, 0.5, 0, -1, 0.25, 1, 0, 0, 1, z, 0, 7, 8, 9, 1);
    const Mat4d n = normal_matrix(m), expected = m.inverse().transposed();
    double largest = 0;
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) largest = std::max(largest, std::abs(expected[r][c]));
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(n[r][c], expected[r][c] / largest, 1e-14) << r << c;
  }
}

TEST(MeshBounds, AreThoseOfTheTransformedPoints) {
  const std::vector<double> points = {1, 0, 0, -2, 3, 0, 0, 0, 4};
  const Box3d box =
      mesh_bounds(mesh_of(points, {0, 1, 2}), scaling(-1, 2, 1) * Mat4d().setTranslation(Vec3d(10, 0, 0)));
  EXPECT_EQ(box.min, Vec3d(9, 0, 0));
  EXPECT_EQ(box.max, Vec3d(12, 6, 4));
}

TEST(BakeCurves, KeepTheirObjectSpaceAroundTheirMiddle) {
  CurveData data;
  data.control_points = {1e6, 0, 0, 1e6 + 1, 0, 0, 1e6 + 2, 0, 0, 1e6 + 3, 0, 0};
  data.widths = {0.2f, 0.25f, 0.3f, 0.4f};
  data.u_range = {0, 1};
  data.split_depth = 2;
  const auto curves = bake_curves(data, scaling(1, 2, 4));
  ASSERT_EQ(curves->segment_count(), 1u);
  EXPECT_FLOAT_EQ(curves->control_points[0], -1.5f);
  EXPECT_FLOAT_EQ(curves->control_points[12], 1.5f);
  EXPECT_FLOAT_EQ(curves->control_points[3], 0.1f);  // Half the width, whatever the placement.
  EXPECT_FLOAT_EQ(curves->control_points[15], 0.2f);
  EXPECT_EQ(transform_point(curves->to_group, Vec3d(1.5, 1, 1)), Vec3d(1e6 + 3, 2, 4));
  EXPECT_EQ(transform_point(curves->from_group, Vec3d(1e6 + 3, 2, 4)), Vec3d(1.5, 1, 1));
  EXPECT_EQ(curves->view().piece_count(), 4u);
  EXPECT_EQ(curves->view().normals, nullptr);
}

}  // namespace
}  // namespace whit
