// Tangents made by MikkTSpace's rules, and those of files.
#include <cmath>

#include "core/gltf/primitive.h"
#include "tests/gltf_reader/model_builder.h"

namespace whit::test {
namespace {

MeshData with_tangents(const ModelBuilder& b) {
  gltf::MeshNeeds needs;
  needs.tangents = needs.uv0 = true;
  MeshData out;
  const auto model = b.load();
  if (model) { EXPECT_EQ(gltf::read_primitive(*model, model->meshes[0].primitives[0], {}, needs, out), ""); }
  return out;
}

void expect_vector(const std::vector<float>& all, size_t vertex, const Vec3d& wanted) {
  ASSERT_GE(all.size(), vertex * 3 + 3);
  for (size_t k = 0; k < 3; ++k)
    EXPECT_NEAR(all[vertex * 3 + k], wanted[static_cast<int>(k)], 1e-6) << "vertex " << vertex;
}

const std::vector<float> kQuad{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
const std::vector<float> kFacing{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
const std::vector<uint16_t> kTwo{0, 1, 2, 0, 2, 3};

ModelBuilder quad(const std::vector<float>& uvs, bool normals = true) {
  ModelBuilder b;
  Json attributes = {{"POSITION", b.accessor("VEC3", kQuad)}, {"TEXCOORD_0", b.accessor("VEC2", uvs)}};
  if (normals) attributes["NORMAL"] = b.accessor("VEC3", kFacing);
  b.mesh({{"attributes", attributes}, {"indices", b.accessor("SCALAR", kTwo)}});
  return b;
}

TEST(GltfTangents, AlongGrowingU) {
  // A picture upright on a quad: the file's v is 1 at the bottom. u grows along +X, and the top is along
  // +Y = cross(N, T) = cross(+Z, +X).
  const MeshData mesh = with_tangents(quad({0, 1, 1, 1, 1, 0, 0, 0}));
  ASSERT_EQ(mesh.positions.size(), 12u);
  for (size_t v = 0; v < 4; ++v) {
    expect_vector(mesh.tangents, v, {1, 0, 0});
    EXPECT_EQ(mesh.bitangent_signs[v], 1);
  }
}

TEST(GltfTangents, MirroredPicturesHaveTheOtherSign) {
  // u runs from right to left: T = -X, and the top is still +Y = -cross(N, T).
  const MeshData mesh = with_tangents(quad({1, 1, 0, 1, 0, 0, 1, 0}));
  for (size_t v = 0; v < 4; ++v) {
    expect_vector(mesh.tangents, v, {-1, 0, 0});
    EXPECT_EQ(mesh.bitangent_signs[v], -1);
  }
}

TEST(GltfTangents, TurnedPictures) {
  // u grows along +Y and v, upward, along -X: a quarter turn.
  const MeshData mesh = with_tangents(quad({0, 0, 0, 1, 1, 1, 1, 0}));
  for (size_t v = 0; v < 4; ++v) {
    expect_vector(mesh.tangents, v, {0, 1, 0});
    // Unmirrored: cross(+Z, +Y) = -X is where v grows.
    EXPECT_EQ(mesh.bitangent_signs[v], 1);
  }
}

TEST(GltfTangents, WithoutNormalsTrianglesAreFlat) {
  const MeshData mesh = with_tangents(quad({0, 1, 1, 1, 1, 0, 0, 0}, false));
  EXPECT_EQ(mesh.positions.size(), 18u);
  EXPECT_EQ(mesh.indices, (std::vector<uint32_t>{0, 1, 2, 3, 4, 5}));
  for (size_t v = 0; v < 6; ++v) {
    expect_vector(mesh.normals, v, {0, 0, 1});
    expect_vector(mesh.tangents, v, {1, 0, 0});
  }
}

/// Two triangles that share the edge from (0, 0) to (0, 1), with coordinates u of their far corners.
ModelBuilder butterfly(float left_u, float right_u) {
  ModelBuilder b;
  b.mesh({{"attributes",
           {{"POSITION", b.accessor("VEC3", std::vector<float>{0, 0, 0, 0, 1, 0, 1, 0, 0, -1, 0, 0})},
            {"NORMAL", b.accessor("VEC3", kFacing)},
            {"TEXCOORD_0", b.accessor("VEC2", std::vector<float>{0, 1, 0, 0, right_u, 1, left_u, 1})}}},
          {"indices", b.accessor("SCALAR", std::vector<uint16_t>{0, 2, 1, 0, 1, 3})}});
  return b;
}

TEST(GltfTangents, VerticesAreSplitWherePicturesAreMirrored) {
  // u grows away from the shared edge on both sides: the left triangle is mirrored, and the shared vertices become two.
  const MeshData mesh = with_tangents(butterfly(1, 1));
  EXPECT_EQ(mesh.positions.size(), 18u);
  for (size_t c = 0; c < 6; ++c) {
    const uint32_t v = mesh.indices[c];
    expect_vector(mesh.tangents, v, c < 3 ? Vec3d(1, 0, 0) : Vec3d(-1, 0, 0));
    EXPECT_EQ(mesh.bitangent_signs[v], c < 3 ? 1 : -1);
    // Copies are at the same place, with the same coordinates.
    EXPECT_EQ(mesh.positions[v * 3 + 1], c == 2 || c == 4 ? 1 : 0);
    EXPECT_EQ(mesh.uvs[v * 2 + 1], c == 2 || c == 4 ? 1 : 0);
  }
  // And stay shared where they are not.
  EXPECT_EQ(with_tangents(butterfly(-1, 1)).positions.size(), 12u);
}

TEST(GltfTangents, AnglesWeighDirections) {
  // Two triangles with unmirrored pictures meet at the origin. Right: (0,0) (1,0) (0,1), with u = x + y and v = y: P = (u - v, v),
  // so u grows along +X. Left: (0,0) (0,1) (-1,1), with u = y and v = y - x: P = (u - v, u), so u grows along (1, 1).
  // The shared corners have the same coordinates in both. At the origin the right triangle has 90 degrees, the left 45:
  // T ~ 2 (1, 0) + (1, 1) / sqrt 2.
  ModelBuilder b;
  b.mesh({{"attributes",
           {{"POSITION", b.accessor("VEC3", std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, -1, 1, 0})},
            {"NORMAL", b.accessor("VEC3", kFacing)},
            // The file's v is 1 - v.
            {"TEXCOORD_0", b.accessor("VEC2", std::vector<float>{0, 1, 1, 1, 1, 0, 1, -1})}}},
          {"indices", b.accessor("SCALAR", std::vector<uint16_t>{0, 1, 2, 0, 2, 3})}});
  const MeshData mesh = with_tangents(b);
  const Vec3d wanted = Vec3d(2 + std::sqrt(0.5), std::sqrt(0.5), 0).normalized();
  expect_vector(mesh.tangents, 0, wanted);
  EXPECT_EQ(mesh.bitangent_signs[0], 1);
}

TEST(GltfTangents, PicturesWithoutAreaHaveSomeTangent) {
  const MeshData mesh = with_tangents(quad({0, 0, 0, 0, 0, 0, 0, 0}));
  for (size_t v = 0; v < 4; ++v) expect_vector(mesh.tangents, v, {1, 0, 0});
}

TEST(GltfTangents, OfTheFile) {
  ModelBuilder b;
  b.mesh({{"attributes",
           {{"POSITION", b.accessor("VEC3", kQuad)},
            {"NORMAL", b.accessor("VEC3", kFacing)},
            {"TANGENT", b.accessor("VEC4", std::vector<float>{0, 1, 0, -1, 0, 1, 0, 1, 1, 0, 0, 1, 1, 0, 0, -1})}}},
          {"indices", b.accessor("SCALAR", kTwo)}});
  const MeshData mesh = with_tangents(b);
  EXPECT_EQ(mesh.tangents, (std::vector<float>{0, 1, 0, 0, 1, 0, 1, 0, 0, 1, 0, 0}));
  EXPECT_EQ(mesh.bitangent_signs, (std::vector<float>{-1, 1, 1, -1}));
}

}  // namespace
}  // namespace whit::test
