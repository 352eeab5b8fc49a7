// Primitives as meshes: modes, indices, what is absent, morph targets and skins.
#include "core/gltf/primitive.h"

#include <cmath>

#include "tests/gltf_reader/model_builder.h"

namespace whit::test {
namespace {

using Indices = std::vector<uint32_t>;

MeshData read(const ModelBuilder& b, const gltf::MeshNeeds& needs = {}, const gltf::Pose& pose = {}) {
  MeshData out;
  const auto model = b.load();
  if (model) { EXPECT_EQ(gltf::read_primitive(*model, model->meshes[0].primitives[0], pose, needs, out), ""); }
  return out;
}

std::string error_of(const ModelBuilder& b, const gltf::MeshNeeds& needs = {}, const gltf::Pose& pose = {}) {
  MeshData out;
  const auto model = b.load();
  return model ? gltf::read_primitive(*model, model->meshes[0].primitives[0], pose, needs, out) : "refused";
}

/// A row of vertices in zigzag, no three on a line.
std::vector<float> zigzag(int n) {
  std::vector<float> out;
  for (int i = 0; i < n; ++i)
    out.insert(out.end(), {static_cast<float>(i), static_cast<float>(i % 2), static_cast<float>(i * i) / 8});
  return out;
}

Indices triangles_of(int mode, int vertices, const std::vector<uint8_t>& indices = {}) {
  ModelBuilder b;
  Json primitive = {{"attributes", {{"POSITION", b.accessor("VEC3", zigzag(vertices))}}}, {"mode", mode}};
  if (!indices.empty()) primitive["indices"] = b.accessor("SCALAR", indices);
  b.mesh(primitive);
  return read(b).indices;
}

TEST(GltfPrimitive, ModesBecomeLists) {
  EXPECT_EQ(triangles_of(4, 6), (Indices{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(triangles_of(4, 5), (Indices{0, 1, 2}));
  // Section 3.7.2.1: strips have {v_i, v_(i+1+i%2), v_(i+2-i%2)}, fans {v_(i+1), v_(i+2), v_0}.
  EXPECT_EQ(triangles_of(5, 5), (Indices{0, 1, 2, 1, 3, 2, 2, 3, 4}));
  EXPECT_EQ(triangles_of(6, 5), (Indices{1, 2, 0, 2, 3, 0, 3, 4, 0}));
  EXPECT_EQ(triangles_of(5, 5, {4, 3, 2, 1}), (Indices{4, 3, 2, 3, 1, 2}));
  EXPECT_EQ(triangles_of(4, 5, {2, 1, 0, 4}), (Indices{2, 1, 0}));
  for (int mode = 0; mode < 4; ++mode) EXPECT_EQ(triangles_of(mode, 6), Indices{});
}

template <class T>
Indices through() {
  ModelBuilder b;
  b.mesh({{"attributes", {{"POSITION", b.accessor("VEC3", zigzag(4))}}},
          {"indices", b.accessor("SCALAR", std::vector<T>{3, 1, 2})}});
  return read(b).indices;
}

TEST(GltfPrimitive, IndicesOfAllTypes) {
  EXPECT_EQ(through<uint8_t>(), (Indices{3, 1, 2}));
  EXPECT_EQ(through<uint16_t>(), (Indices{3, 1, 2}));
  EXPECT_EQ(through<uint32_t>(), (Indices{3, 1, 2}));
}

TEST(GltfPrimitive, IndicesBeyondTheVerticesAreErrors) {
  ModelBuilder b;
  b.mesh({{"attributes", {{"POSITION", b.accessor("VEC3", zigzag(4))}}},
          {"indices", b.accessor("SCALAR", std::vector<uint16_t>{0, 1, 4})}});
  EXPECT_EQ(error_of(b), "model.glb: /meshes/0/primitives/0/indices: number 2 is 4, and there are 4 vertices");
}

TEST(GltfPrimitive, DegenerateTrianglesAreCounted) {
  ModelBuilder b;
  b.mesh({{"attributes", {{"POSITION", b.accessor("VEC3", zigzag(4))}}},
          {"indices", b.accessor("SCALAR", std::vector<uint16_t>{0, 1, 1, 0, 1, 2})}});
  const MeshData mesh = read(b);
  EXPECT_EQ(mesh.indices, (Indices{0, 1, 2}));
  EXPECT_EQ(mesh.degenerate, 1u);
}

TEST(GltfPrimitive, VPointsUpAndColorsHaveFourNumbers) {
  ModelBuilder b;
  b.mesh({{"attributes",
           {{"POSITION", b.accessor("VEC3", zigzag(3))},
            {"TEXCOORD_0", b.accessor("VEC2", std::vector<float>{0, 0, 1, 0.25f, 0.5f, 1})},
            {"TEXCOORD_1", b.accessor("VEC2", std::vector<uint16_t>{0, 65535, 65535, 0, 13107, 26214}, true)},
            {"COLOR_0", b.accessor("VEC3", std::vector<float>{1, 0, 0, 0, 2, 0, 0, 0, 0.5f})}}}});
  gltf::MeshNeeds needs;
  needs.uv0 = needs.uv1 = needs.colors = true;
  const MeshData mesh = read(b, needs);
  EXPECT_EQ(mesh.uvs, (std::vector<float>{0, 1, 1, 0.75f, 0.5f, 0}));
  // 13107 / 65535 = 0.2 and 1 - 26214 / 65535 = 0.6.
  const std::vector<float> wanted{0, 0, 1, 1, 0.2f, 0.6f};
  ASSERT_EQ(mesh.uvs1.size(), wanted.size());
  for (size_t i = 0; i < wanted.size(); ++i) EXPECT_NEAR(mesh.uvs1[i], wanted[i], 1e-7f);
  EXPECT_EQ(mesh.colors, (std::vector<float>{1, 0, 0, 1, 0, 2, 0, 1, 0, 0, 0.5f, 1}));
  EXPECT_TRUE(mesh.normals.empty());
  // What nobody asks for is not read.
  const MeshData bare = read(b);
  EXPECT_TRUE(bare.uvs.empty() && bare.uvs1.empty() && bare.colors.empty());
}

TEST(GltfPrimitive, QuantizedPositions) {
  ModelBuilder b;
  b.json["extensionsUsed"] = b.json["extensionsRequired"] = {"KHR_mesh_quantization"};
  // Four bytes for each vertex, the last one unused, since attributes begin at multiples of four.
  const int view = b.view(ModelBuilder::raw(std::vector<int8_t>{127, 0, 0, 0, 0, 127, 0, 0, 0, 0, -128, 0}), 4);
  b.mesh({{"attributes",
           {{"POSITION", b.accessor(Json{{"bufferView", view},
                                         {"componentType", 5120},
                                         {"normalized", true},
                                         {"type", "VEC3"},
                                         {"count", 3}})}}}});
  const MeshData mesh = read(b);
  EXPECT_EQ(std::vector<double>(mesh.positions.begin(), mesh.positions.end()),
            (std::vector<double>{1, 0, 0, 0, 1, 0, 0, 0, -1}));
}

TEST(GltfPrimitive, MorphTargetsAreAddedByWeight) {
  ModelBuilder b;
  const int zero = b.accessor("VEC3", std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0});
  const int normals = b.accessor("VEC3", std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1});
  const int up = b.accessor("VEC3", std::vector<float>{0, 0, 2, 0, 0, 2, 0, 0, 2}),
            right = b.accessor("VEC3", std::vector<float>{4, 0, 0, 4, 0, 0, 4, 0, 0});
  b.mesh({{"attributes", {{"POSITION", zero}, {"NORMAL", normals}}},
          {"targets", {{{"POSITION", up}, {"NORMAL", right}}, {{"POSITION", right}}}}});
  gltf::Pose pose;
  pose.weights = {0.5, 0.25};
  const MeshData mesh = read(b, {}, pose);
  // (0, 0, 0) + 0.5 (0, 0, 2) + 0.25 (4, 0, 0) = (1, 0, 1).
  EXPECT_EQ(std::vector<double>(mesh.positions.begin(), mesh.positions.end()),
            (std::vector<double>{1, 0, 1, 2, 0, 1, 1, 1, 1}));
  // (0, 0, 1) + 0.5 (4, 0, 0) = (2, 0, 1), of length sqrt 5.
  EXPECT_NEAR(mesh.normals[0], 2 / std::sqrt(5.0), 1e-7);
  EXPECT_NEAR(mesh.normals[2], 1 / std::sqrt(5.0), 1e-7);
  EXPECT_EQ(read(b).positions[2], 0);
}

ModelBuilder skinned(const std::vector<float>& weights) {
  ModelBuilder b;
  b.mesh({{"attributes",
           {{"POSITION", b.accessor("VEC3", std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0})},
            {"NORMAL", b.accessor("VEC3", std::vector<float>{0, 1, 1, 0, 1, 1, 0, 1, 1})},
            {"JOINTS_0", b.accessor("VEC4", std::vector<uint8_t>{0, 1, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0})},
            {"WEIGHTS_0", b.accessor("VEC4", weights)}}}});
  return b;
}

TEST(GltfPrimitive, SkinsBlendMatrices) {
  const ModelBuilder b = skinned({1, 0, 0, 0, 2, 0, 0, 0, 1, 1, 0, 0});
  gltf::Pose pose;
  pose.joints.resize(2);
  pose.joints[0].setTranslation(Vec3d(0, 0, 5));
  pose.joints[1].setScale(Vec3d(1, 1, 3));
  const MeshData mesh = read(b, {}, pose);
  // The first follows joint 0; the second joint 1, whose weight of 2 is 1 when they are brought to a sum of 1; the third the
  // mean of both: a shift by 2.5 and a scale of (1 + 3) / 2.
  EXPECT_EQ(std::vector<double>(mesh.positions.begin(), mesh.positions.end()),
            (std::vector<double>{0, 0, 5, 1, 0, 0, 0, 1, 2.5}));
  // Under a scale of 3 along z the normal (0, 1, 1) becomes (0, 1, 1/3), and so (0, 3, 1) / sqrt 10.
  EXPECT_NEAR(mesh.normals[4], 3 / std::sqrt(10.0), 1e-7);
  EXPECT_NEAR(mesh.normals[5], 1 / std::sqrt(10.0), 1e-7);
}

TEST(GltfPrimitive, JointsBeyondTheSkinAreErrors) {
  gltf::Pose pose;
  pose.joints.resize(1);
  EXPECT_EQ(error_of(skinned({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}), {}, pose),
            "model.glb: /meshes/0/primitives/0/attributes/JOINTS_0: vertex 1 names joint 1, and the skin has 1");
  // Where the weight is 0 anything may be written.
  EXPECT_EQ(error_of(skinned({1, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0}), {}, pose), "");
}

}  // namespace
}  // namespace whit::test
