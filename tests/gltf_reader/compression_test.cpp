// EXT_meshopt_compression and KHR_draco_mesh_compression: what their own encoders make of a mesh is read as the mesh.
#include <draco/compression/expert_encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <meshoptimizer.h>

#include <cmath>

#include "core/gltf/accessor.h"
#include "core/gltf/primitive.h"
#include "tests/gltf_reader/model_builder.h"

namespace whit::test {
namespace {

const std::vector<float> kPositions{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 2};
const std::vector<uint16_t> kIndices{0, 1, 2, 2, 3, 0};

/// A buffer view that is compressed; its own buffer has no bytes.
int compressed_view(ModelBuilder& b, const std::string& encoded, size_t count, size_t stride, const std::string& mode,
                    const std::string& filter = "NONE") {
  const int source = b.view(encoded);
  Json extension = b.json["bufferViews"][static_cast<size_t>(source)];
  extension.update({{"count", count}, {"byteStride", stride}, {"mode", mode}, {"filter", filter}});
  Json view = {{"buffer", 1}, {"byteLength", count * stride}, {"extensions", {{"EXT_meshopt_compression", extension}}}};
  if (mode == "ATTRIBUTES") view["byteStride"] = stride;
  b.json["bufferViews"].push_back(view);
  return source + 1;
}

/// Both buffers, when the bytes of the first are complete.
void add_buffers(ModelBuilder& b) {
  b.json["buffers"] = {{{"byteLength", b.bytes.size()}},
                       {{"byteLength", 100000}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}};
  b.json["extensionsUsed"] = b.json["extensionsRequired"] = {"EXT_meshopt_compression"};
}

template <class T>
std::string encoded_vertices(const std::vector<T>& values, size_t count) {
  const size_t stride = values.size() * sizeof(T) / count;
  std::string out(meshopt_encodeVertexBufferBound(count, stride), '\0');
  out.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(out.data()), out.size(), values.data(), count,
                                        stride));
  return out;
}

std::string encoded_indices(bool sequence) {
  std::string out(1000, '\0');
  auto* bytes = reinterpret_cast<unsigned char*>(out.data());
  out.resize(sequence ? meshopt_encodeIndexSequence(bytes, out.size(), kIndices.data(), kIndices.size())
                      : meshopt_encodeIndexBuffer(bytes, out.size(), kIndices.data(), kIndices.size()));
  return out;
}

ModelBuilder meshopt_model(bool sequence) {
  ModelBuilder b;
  const int positions = compressed_view(b, encoded_vertices(kPositions, 4), 4, 12, "ATTRIBUTES");
  const int indices = compressed_view(b, encoded_indices(sequence), 6, 2, sequence ? "INDICES" : "TRIANGLES");
  add_buffers(b);
  b.mesh({{"attributes",
           {{"POSITION",
             b.accessor(Json{{"bufferView", positions}, {"componentType", 5126}, {"type", "VEC3"}, {"count", 4}})}}},
          {"indices",
           b.accessor(Json{{"bufferView", indices}, {"componentType", 5123}, {"type", "SCALAR"}, {"count", 6}})}});
  return b;
}

/// The triangle's corners, whatever its first one is.
std::vector<std::array<uint32_t, 3>> triangles_of(const MeshData& mesh) {
  std::vector<std::array<uint32_t, 3>> out;
  for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    std::array<uint32_t, 3> t{mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]};
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    out.push_back(t);
  }
  return out;
}

TEST(GltfMeshopt, VerticesTrianglesAndSequences) {
  meshopt_encodeVertexVersion(0);
  for (const int version : {0, 1}) {
    meshopt_encodeIndexVersion(version);
    for (const bool sequence : {false, true}) {
      const auto model = meshopt_model(sequence).load();
      ASSERT_TRUE(model);
      MeshData mesh;
      ASSERT_EQ(gltf::read_primitive(*model, model->meshes[0].primitives[0], {}, {}, mesh), "");
      EXPECT_EQ(std::vector<double>(mesh.positions.begin(), mesh.positions.end()),
                std::vector<double>(kPositions.begin(), kPositions.end()));
      EXPECT_EQ(triangles_of(mesh), (std::vector<std::array<uint32_t, 3>>{{0, 1, 2}, {0, 2, 3}}));
    }
  }
}

TEST(GltfMeshopt, Filters) {
  meshopt_encodeVertexVersion(0);
  // Unit vectors as octahedra of 8 bits, quaternions of 16 bits, and floats with a shared exponent.
  const std::vector<float> vectors{0, 0, 1, 0, 0.6f, 0, 0.8f, 0}, quaternions{0, 0, 0, 1, 0.6f, 0, 0, 0.8f},
      numbers{1.5f, -2, 1024, 0.25f};
  std::vector<int8_t> octahedra(8);
  std::vector<int16_t> turns(8);
  std::vector<uint32_t> exponents(4);
  meshopt_encodeFilterOct(octahedra.data(), 2, 4, 8, vectors.data());
  meshopt_encodeFilterQuat(turns.data(), 2, 8, 16, quaternions.data());
  meshopt_encodeFilterExp(exponents.data(), 1, 16, 20, numbers.data());
  ModelBuilder b;
  const int views[] = {compressed_view(b, encoded_vertices(octahedra, 2), 2, 4, "ATTRIBUTES", "OCTAHEDRAL"),
                       compressed_view(b, encoded_vertices(turns, 2), 2, 8, "ATTRIBUTES", "QUATERNION"),
                       compressed_view(b, encoded_vertices(exponents, 1), 1, 16, "ATTRIBUTES", "EXPONENTIAL")};
  add_buffers(b);
  const int accessors[] = {
      b.accessor(Json{
          {"bufferView", views[0]}, {"componentType", 5120}, {"normalized", true}, {"type", "VEC4"}, {"count", 2}}),
      b.accessor(Json{
          {"bufferView", views[1]}, {"componentType", 5122}, {"normalized", true}, {"type", "VEC4"}, {"count", 2}}),
      b.accessor(Json{{"bufferView", views[2]}, {"componentType", 5126}, {"type", "VEC4"}, {"count", 1}})};
  const auto model = b.load();
  ASSERT_TRUE(model);
  const std::vector<float>* wanted[] = {&vectors, &quaternions, &numbers};
  // Half a step of 1/127 in each coordinate of the octahedron, of sqrt(1/2)/32767, and of 2^-20 times 1024.
  const double tolerances[] = {0.02, 1e-4, 0.002};
  for (size_t k = 0; k < 3; ++k) {
    std::vector<float> out;
    ASSERT_EQ(gltf::read_floats(*model, accessors[k], out), "");
    for (size_t i = 0; i < out.size(); ++i) EXPECT_NEAR(out[i], (*wanted[k])[i], tolerances[k]) << k << " " << i;
  }
}

TEST(GltfMeshopt, DamagedBytesAreErrors) {
  const ModelBuilder right = meshopt_model(false);
  const auto error_with = [](const ModelBuilder& b) {
    const auto model = b.load();
    MeshData mesh;
    return model ? gltf::read_primitive(*model, model->meshes[0].primitives[0], {}, {}, mesh) : "refused";
  };
  ModelBuilder b = right;
  b.bytes[0] = 0;
  EXPECT_EQ(error_with(b), "model.glb: /bufferViews/1/extensions/EXT_meshopt_compression: its bytes cannot be decoded");
  const auto refused = [&](const char* key, const Json& value, const std::string& wanted) {
    ModelBuilder c = right;
    c.json["bufferViews"][1]["extensions"]["EXT_meshopt_compression"][key] = value;
    Diagnostics diagnostics;
    EXPECT_FALSE(c.load(diagnostics));
    EXPECT_NE(messages(diagnostics).find("model.glb: /bufferViews/1/extensions/EXT_meshopt_compression" + wanted),
              std::string::npos)
        << messages(diagnostics);
  };
  refused("count", 4000000000u, "/count: is 4000000000, which");
  refused("count", 3, ": is 36 bytes when decompressed, and the buffer view is 48");
  refused("byteStride", 10, "/byteStride: must be a multiple of 4");
  refused("mode", "LINES", "/mode: must be one of ATTRIBUTES, TRIANGLES, INDICES");
  refused("filter", "QUATERNION", "/filter: does not go with the mode and the byteStride");
  refused("buffer", 1, "/buffer: names a buffer without bytes");
  refused("byteOffset", 100000, ": ends at byte");
  ModelBuilder plain = right;
  plain.json["bufferViews"][1].erase("extensions");
  Diagnostics diagnostics;
  EXPECT_FALSE(plain.load(diagnostics));
  EXPECT_NE(messages(diagnostics).find("model.glb: /bufferViews/1/buffer: names a buffer without bytes"),
            std::string::npos)
      << messages(diagnostics);
}

/// A quad of two triangles with colours, as Draco has it.
std::string draco_bytes(int method, int& position_id, int& color_id) {
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(2);
  position_id = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  color_id = builder.AddAttribute(draco::GeometryAttribute::COLOR, 4, draco::DT_UINT8, true);
  for (uint32_t f = 0; f < 2; ++f) {
    const auto at = [&](size_t k) { return kPositions.data() + size_t{kIndices[f * 3 + k]} * 3; };
    const uint8_t colors[3][4] = {{255, 0, 51, 255}, {255, 0, 51, 255}, {255, 0, 51, 255}};
    builder.SetAttributeValuesForFace(position_id, draco::FaceIndex(f), at(0), at(1), at(2));
    builder.SetAttributeValuesForFace(color_id, draco::FaceIndex(f), colors[0], colors[1], colors[2]);
  }
  const auto mesh = builder.Finalize();
  position_id = static_cast<int>(mesh->attribute(position_id)->unique_id());
  color_id = static_cast<int>(mesh->attribute(color_id)->unique_id());
  draco::ExpertEncoder encoder(*mesh);
  encoder.SetEncodingMethod(method);
  draco::EncoderBuffer buffer;
  EXPECT_TRUE(encoder.EncodeToBuffer(&buffer).ok());
  return {buffer.data(), buffer.size()};
}

ModelBuilder draco_model(int method) {
  ModelBuilder b;
  int position_id = 0, color_id = 0;
  const int view = b.view(draco_bytes(method, position_id, color_id));
  b.json["extensionsUsed"] = b.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  b.mesh(
      {{"attributes",
        {{"POSITION", b.accessor(Json{{"componentType", 5126}, {"type", "VEC3"}, {"count", 4}})},
         {"COLOR_0", b.accessor(Json{{"componentType", 5121}, {"normalized", true}, {"type", "VEC4"}, {"count", 4}})}}},
       {"indices", b.accessor(Json{{"componentType", 5121}, {"type", "SCALAR"}, {"count", 6}})},
       {"extensions",
        {{"KHR_draco_mesh_compression",
          {{"bufferView", view}, {"attributes", {{"POSITION", position_id}, {"COLOR_0", color_id}}}}}}}});
  return b;
}

std::string read_draco(const ModelBuilder& b, MeshData& mesh) {
  const auto model = b.load();
  gltf::MeshNeeds needs;
  needs.colors = true;
  return model ? gltf::read_primitive(*model, model->meshes[0].primitives[0], {}, needs, mesh) : "refused";
}

TEST(GltfDraco, BothMethods) {
  for (const int method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING}) {
    MeshData mesh;
    ASSERT_EQ(read_draco(draco_model(method), mesh), "");
    EXPECT_EQ(mesh.positions.size(), 12u);
    // Draco orders vertices and triangles as it likes: the sum over triangles of a x b . c does not change.
    ASSERT_EQ(mesh.indices.size(), 6u);
    double area = 0;
    for (size_t i = 0; i < 6; i += 3) {
      const auto p = [&](size_t k) {
        const double* v = mesh.positions.data() + size_t{mesh.indices[i + k]} * 3;
        return Vec3d(v[0], v[1], v[2]);
      };
      area += (p(1) - p(0)).cross(p(2) - p(0)).z / 2;
    }
    EXPECT_EQ(area, 1);
    ASSERT_EQ(mesh.colors.size(), 16u);
    for (size_t v = 0; v < 4; ++v) {
      EXPECT_EQ(mesh.colors[v * 4], 1);
      EXPECT_EQ(mesh.colors[v * 4 + 1], 0);
      EXPECT_NEAR(mesh.colors[v * 4 + 2], 0.2f, 1e-7f);
      EXPECT_EQ(mesh.colors[v * 4 + 3], 1);
    }
  }
}

TEST(GltfDraco, DamagedBytesAreErrors) {
  const std::string place = "model.glb: /meshes/0/primitives/0/extensions/KHR_draco_mesh_compression: ";
  MeshData mesh;
  for (const int method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING}) {
    const ModelBuilder right = draco_model(method);
    ModelBuilder b = right;
    b.bytes[0] = 'X';
    EXPECT_EQ(read_draco(b, mesh), place + "its bytes cannot be decoded");
    b = right, b.bytes[6] = 7;
    EXPECT_EQ(read_draco(b, mesh), place + "its bytes have version 2.7, and 2.2 is read");
    // The count of triangles, which Draco would believe: five bytes for 2^32 - 1.
    b = right;
    b.bytes.replace(method == draco::MESH_SEQUENTIAL_ENCODING ? 11 : 13, 5, "\xff\xff\xff\xff\x0f");
    EXPECT_EQ(read_draco(b, mesh).substr(0, place.size() + 24), place + "has 4294967295 triangles");
    // Whatever else is wrong, it is an error or a mesh.
    for (size_t i = 11; i < right.bytes.size(); ++i) {
      b = right;
      b.bytes[i] = static_cast<char>(b.bytes[i] ^ 0x55);
      read_draco(b, mesh);
    }
    b = right;
    b.json["accessors"][1]["count"] = 5, b.json["accessors"][0]["count"] = 5;
    EXPECT_EQ(read_draco(b, mesh), "");
    b = right;
    b.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"]["attributes"]["POSITION"] = 9;
    EXPECT_EQ(read_draco(b, mesh),
              "model.glb: /meshes/0/primitives/0/attributes/POSITION: its bytes have no attribute 9");
  }
}

}  // namespace
}  // namespace whit::test
