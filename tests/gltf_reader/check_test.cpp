// What is wrong with a file is told with its place: a right model of everything, and one thing wrong after another.
#include "tests/gltf_reader/model_builder.h"

namespace whit::test {
namespace {

/// A model that has one of everything.
ModelBuilder everything() {
  ModelBuilder b;
  const int positions = b.accessor("VEC3", std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0});  // 0
  const int normals = b.accessor("VEC3", std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1});
  const int uvs = b.accessor("VEC2", std::vector<float>{0, 0, 1, 0, 0, 1});  // 2
  const int joints = b.accessor("VEC4", std::vector<uint8_t>(12, 0));
  const int weights = b.accessor("VEC4", std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});  // 4
  const int indices = b.accessor("SCALAR", std::vector<uint16_t>{0, 1, 2});
  const int matrices = b.accessor("MAT4", std::vector<float>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});  // 6
  const int times = b.accessor("SCALAR", std::vector<float>{0, 1, 2});
  const int places = b.accessor("VEC3", std::vector<float>(9, 1));  // 8
  const int turns = b.accessor("VEC4", std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1});
  const int factors = b.accessor("SCALAR", std::vector<float>(6, 0));  // 10
  const int sparse_indices = b.view(ModelBuilder::raw(std::vector<uint8_t>{0, 2})),
            sparse_values = b.view(std::string(24, '\0'));
  const int sparse = b.accessor(Json{{"componentType", 5126},
                                     {"type", "VEC3"},
                                     {"count", 3},
                                     {"sparse",
                                      {{"count", 2},
                                       {"indices", {{"bufferView", sparse_indices}, {"componentType", 5121}}},
                                       {"values", {{"bufferView", sparse_values}}}}}});  // 11
  const int picture = b.view("no picture");
  b.mesh({{"attributes",
           {{"POSITION", positions},
            {"NORMAL", normals},
            {"TEXCOORD_0", uvs},
            {"JOINTS_0", joints},
            {"WEIGHTS_0", weights}}},
          {"indices", indices},
          {"material", 0},
          {"targets", {{{"POSITION", sparse}}, {{"POSITION", positions}}}},
          {"extensions", {{"KHR_materials_variants", {{"mappings", {{{"material", 0}, {"variants", {0}}}}}}}}}});
  b.json["meshes"][0]["weights"] = {0, 0.5};
  b.json["nodes"] = {
      {{"children", {1, 2}}, {"name", "root"}},
      {{"mesh", 0}, {"skin", 0}, {"weights", {1, 0}}, {"rotation", {0, 0, 0, 1}}},
      {{"camera", 0}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}, {"children", {3}}},
      {{"extensions",
        {{"KHR_lights_punctual", {{"light", 0}}},
         {"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", places}, {"ROTATION", turns}}}}}}}}};
  b.json["scenes"] = {{{"nodes", {0}}}};
  b.json["scene"] = 0;
  b.json["skins"] = {{{"joints", {0}}, {"inverseBindMatrices", matrices}, {"skeleton", 0}}};
  b.json["animations"] = {{{"samplers",
                            {{{"input", times}, {"output", places}},
                             {{"input", times}, {"output", turns}},
                             {{"input", times}, {"output", factors}}}},
                           {"channels",
                            {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}},
                             {{"sampler", 1}, {"target", {{"node", 0}, {"path", "rotation"}}}},
                             {{"sampler", 2}, {"target", {{"node", 1}, {"path", "weights"}}}}}}}};
  b.json["cameras"] = {
      {{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", 0.1}}}},
      {{"type", "orthographic"}, {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"znear", 0}, {"zfar", 10}}}}};
  b.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}, {"metallicFactor", 0.5}}},
                          {"extensions", {{"KHR_materials_ior", {{"ior", 1.4}}}}}}};
  b.json["textures"] = {{{"source", 0}, {"sampler", 0}}};
  b.json["samplers"] = {{{"wrapS", 33071}}};
  b.json["images"] = {{{"bufferView", picture}, {"mimeType", "image/png"}}};
  b.json["extensions"] = {{"KHR_lights_punctual", {{"lights", {{{"type", "spot"}, {"spot", Json::object()}}}}}},
                          {"KHR_materials_variants", {{"variants", {{{"name", "red"}}}}}}};
  b.json["extensionsUsed"] = {"KHR_lights_punctual", "KHR_materials_variants", "EXT_mesh_gpu_instancing",
                              "KHR_materials_ior"};
  return b;
}

struct Wrong {
  const char* place;  ///< What is changed.
  Json value;         ///< Into what; null: it is taken away.
  const char* message;
};

std::string messages_of(const Wrong& wrong) {
  ModelBuilder b = everything();
  const Json::json_pointer place(wrong.place);
  if (wrong.value.is_null()) b.json[place.parent_pointer()].erase(place.back());
  else b.json[place] = wrong.value;
  Diagnostics diagnostics;
  EXPECT_FALSE(b.load(diagnostics)) << wrong.place << " " << wrong.value;
  EXPECT_TRUE(diagnostics.has_errors());
  for (const Diagnostic& d : diagnostics.all()) {
    if (d.severity == Severity::Error) { EXPECT_FALSE(d.remedy.empty()) << d.message; }
  }
  return messages(diagnostics);
}

void expect_all(const std::vector<Wrong>& all) {
  for (const Wrong& wrong : all) {
    const std::string said = messages_of(wrong);
    EXPECT_NE(said.find(std::string("model.glb: ") + wrong.message), said.npos)
        << wrong.place << " = " << wrong.value << " says\n"
        << said;
  }
}

const Json kNone = nullptr;

TEST(GltfCheck, TheModelItselfIsRight) {
  const auto model = everything().load();
  ASSERT_TRUE(model);
  EXPECT_EQ(model->nodes[1].parent, 0);
  EXPECT_EQ(model->nodes[3].light, 0);
  EXPECT_EQ(model->lights[0].outer_cone, 0.7853981634);
  EXPECT_EQ(model->meshes[0].primitives[0].variant_material, (std::vector<int>{0}));
  EXPECT_EQ(model->meshes[0].primitives[0].targets.size(), 2u);
  EXPECT_EQ(model->materials[0].ior, 1.4);
  EXPECT_EQ(model->textures[0].sampler.wrap_s, gltf::Sampler::Wrap::Clamp);
  EXPECT_EQ(std::string(model->images[0].inside->bytes.begin(), model->images[0].inside->bytes.end()), "no picture");
  EXPECT_EQ(model->images[0].inside->name, "model.glb: /images/0");
  EXPECT_EQ(model->animations[0].channels.size(), 3u);
}

TEST(GltfCheck, VersionsAndExtensions) {
  expect_all({{"/asset", kNone, "/asset: is missing"},
              {"/asset/version", kNone, "/asset/version: is missing"},
              {"/asset/version", "1.0", "/asset/version: is \"1.0\": glTF 1.0 is not read (re-export as glTF 2.0)"},
              {"/asset/version", 1, "/asset/version: is \"1.0\": glTF 1.0 is not read"},
              {"/asset/version", "two", "/asset/version: must be a version like \"2.0\", and is \"two\""},
              {"/asset/minVersion", "2.1", "/asset/minVersion: is \"2.1\", and glTF 2.0 is read"},
              {"/extensionsRequired",
               {"KHR_texture_basisu"},
               "/extensionsRequired/0: the file requires the extension \"KHR_texture_basisu\", which is not read "
               "(re-export without \"KHR_texture_basisu\")"},
              {"/extensions/KHR_lights_punctual", 7, "/extensions/KHR_lights_punctual: must be an object, and is 7"}});
}

TEST(GltfCheck, UnreadExtensionsAreWarnedOfOnce) {
  ModelBuilder b = everything();
  b.json["extensionsUsed"].push_back("KHR_materials_pbrSpecularGlossiness");
  Diagnostics diagnostics;
  EXPECT_TRUE(b.load(diagnostics));
  EXPECT_EQ(messages(diagnostics),
            "model.glb: /extensionsUsed: the extension \"KHR_materials_pbrSpecularGlossiness\" is not read (its "
            "materials are taken as "
            "metallic-roughness)\n");
}

TEST(GltfCheck, WhatIsClearAllTheSameIsExcused) {
  ModelBuilder b = everything();
  b.json["extensionsRequired"] = {"KHR_texture_transform"};
  b.json["extensionsUsed"].push_back("KHR_materials_ior");
  // Three bytes for each vertex, which graphics cards dislike.
  b.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] =
      b.accessor("VEC3", std::vector<uint8_t>(9, 255), true);
  Diagnostics diagnostics;
  EXPECT_TRUE(b.load(diagnostics));
  EXPECT_EQ(messages(diagnostics),
            "model.glb: /extensionsUsed/4: \"KHR_materials_ior\" is there twice (once would do)\n"
            "model.glb: /extensionsRequired: names \"KHR_texture_transform\", which is not under \"extensionsUsed\" "
            "(it is read "
            "all the same)\n"
            "model.glb: /meshes/0/primitives/0/attributes/COLOR_0: names an accessor whose elements do not begin at "
            "multiples "
            "of four bytes (it is read all the same)\n");
  for (const Diagnostic& d : diagnostics.all()) EXPECT_TRUE(d.excused);
}

TEST(GltfCheck, Buffers) {
  expect_all({{"/buffers", Json::array({{{"byteLength", 100000}}}), "/buffers/0/byteLength: is 100000, and there are"},
              {"/buffers", Json::array({{{"byteLength", 0}}}), "/buffers/0/byteLength: must be at least 1, and is 0"},
              {"/buffers", Json::object(), "/buffers: must be an array"},
              {"/bufferViews/0/buffer", 1, "/bufferViews/0/buffer: is 1, and the last of the file's buffers is 0"},
              {"/bufferViews/0/buffer", kNone, "/bufferViews/0/buffer: is missing"},
              {"/bufferViews/0/byteOffset", -4, "/bufferViews/0/byteOffset: must be at least 0, and is -4"},
              {"/bufferViews/0/byteOffset", 1.5, "/bufferViews/0/byteOffset: must be a whole number, and is 1.5"},
              {"/bufferViews/0/byteOffset", 1e30, "/bufferViews/0/byteOffset: must be a whole number, and is 1e+30"},
              {"/bufferViews/0/byteOffset", 100000, "/bufferViews/0: ends at byte 100036 of a buffer of"},
              {"/bufferViews/0/byteLength", 4000000000u, "/bufferViews/0: ends at byte 4000000000 of a buffer of"},
              {"/bufferViews/0/byteLength", 18446744073709551615u, "/bufferViews/0/byteLength: must be at most"},
              {"/bufferViews/0/byteStride", 2, "/bufferViews/0/byteStride: must be at least 4, and is 2"},
              {"/bufferViews/0/byteStride", 14, "/bufferViews/0/byteStride: must be a multiple of 4, and is 14"},
              {"/bufferViews/0/byteStride", 8, "/accessors/0: has elements of 12 bytes at a byteStride of 8"},
              {"/bufferViews/0/target", 1, "/bufferViews/0/target: must be one of 34962, 34963, and is 1"}});
}

TEST(GltfCheck, Accessors) {
  expect_all(
      {{"/accessors/0/bufferView", 99, "/accessors/0/bufferView: is 99, and the last of the file's bufferViews is"},
       {"/accessors/0/count", 4000000000u,
        "/accessors/0: has 4000000000 elements of 12 bytes at a stride of 12 from byte 0 on, and its buffer view 36 "
        "bytes"},
       {"/accessors/0/count", 9007199254740992u, "/accessors/0: has 9007199254740992 elements"},
       {"/accessors/0/count", 0, "/accessors/0/count: must be at least 1, and is 0"},
       {"/accessors/0/count", kNone, "/accessors/0/count: is missing"},
       {"/accessors/0/componentType", 5124, "/accessors/0/componentType: must be one of 5120, 5121"},
       {"/accessors/0/type", "VEC5",
        "/accessors/0/type: must be one of SCALAR, VEC2, VEC3, VEC4, MAT2, MAT3, MAT4, and is \"VEC5\""},
       {"/accessors/0/byteOffset", 2,
        "/accessors/0/byteOffset: makes its numbers begin at byte 2, which is not a multiple of 4"},
       {"/accessors/0/byteOffset", 4, "/accessors/0: has 3 elements of 12 bytes at a stride of 12 from byte 4 on"},
       {"/accessors/0/normalized", true, "/accessors/0/normalized: must not be true"},
       {"/accessors/0/min", {1, 2}, "/accessors/0/min: must be an array of 3 numbers, and has 2"},
       {"/accessors/11/count", 4000000000u, "/accessors/11/count: is 4000000000, of an accessor without a bufferView"},
       {"/accessors/11/sparse/count", 4, "/accessors/11/sparse/count: must be at most 3, and is 4"},
       {"/accessors/11/sparse/indices", kNone, "/accessors/11/sparse/indices: is missing"},
       {"/accessors/11/sparse/indices/bufferView", 99, "/accessors/11/sparse/indices/bufferView: is 99"},
       {"/accessors/11/sparse/indices/componentType", 5126,
        "/accessors/11/sparse/indices/componentType: must be one of 5121, 5123, 5125"},
       {"/accessors/11/sparse/indices/byteOffset", 1,
        "/accessors/11/sparse/indices: has 2 elements of 1 bytes at a stride of 1 from byte 1 on"},
       {"/accessors/11/sparse/values/byteOffset", 4, "/accessors/11/sparse/values: has 2 elements of 12 bytes"},
       {"/accessors/11/count", 2, "/accessors/11/sparse/indices: 2 is not below the accessor's count of 2"}});
}

TEST(GltfCheck, SparseIndicesIncrease) {
  for (const std::vector<uint8_t>& indices : {std::vector<uint8_t>{2, 0}, {1, 1}, {2, 255}}) {
    ModelBuilder b = everything();
    const auto view = b.json["accessors"][11]["sparse"]["indices"]["bufferView"].get<size_t>();
    const auto offset = b.json["bufferViews"][view]["byteOffset"].get<size_t>();
    b.bytes[offset] = static_cast<char>(indices[0]), b.bytes[offset + 1] = static_cast<char>(indices[1]);
    Diagnostics diagnostics;
    EXPECT_FALSE(b.load(diagnostics));
    const std::string wanted = indices[1] == 255 ? "255 is not below the accessor's count of 3" : "must increase, and ";
    EXPECT_NE(messages(diagnostics).find("model.glb: /accessors/11/sparse/indices: " + wanted), std::string::npos)
        << messages(diagnostics);
  }
}

TEST(GltfCheck, Meshes) {
  expect_all(
      {{"/meshes/0/primitives", kNone, "/meshes/0/primitives: is missing"},
       {"/meshes/0/primitives", 3, "/meshes/0/primitives: must be an array"},
       {"/meshes/0/primitives/0/attributes", kNone, "/meshes/0/primitives/0/attributes: is missing"},
       {"/meshes/0/primitives/0/mode", 7, "/meshes/0/primitives/0/mode: must be at most 6, and is 7"},
       {"/meshes/0/primitives/0/material", 1,
        "/meshes/0/primitives/0/material: is 1, and the last of the file's materials is 0"},
       {"/meshes/0/primitives/0/indices", 0,
        "/meshes/0/primitives/0/indices: must name a SCALAR of UNSIGNED_BYTE, _SHORT or _INT, and accessor 0 is a VEC3 "
        "of FLOAT"},
       {"/meshes/0/primitives/0/indices", 4000000000u, "/meshes/0/primitives/0/indices: must be at most"},
       {"/meshes/0/primitives/0/attributes/POSITION", 99,
        "/meshes/0/primitives/0/attributes/POSITION: is 99, and the last of the file's accessors is 11"},
       {"/meshes/0/primitives/0/attributes/POSITION", "0",
        "/meshes/0/primitives/0/attributes/POSITION: must be a whole number, and is \"0\""},
       {"/meshes/0/primitives/0/attributes/POSITION", 2,
        "/meshes/0/primitives/0/attributes/POSITION: must name a VEC3 of FLOAT, and accessor 2 is a VEC2 of FLOAT"},
       {"/meshes/0/primitives/0/attributes/TANGENT", 0,
        "/meshes/0/primitives/0/attributes/TANGENT: must name a VEC4 of FLOAT"},
       {"/meshes/0/primitives/0/attributes/COLOR_0", 5,
        "/meshes/0/primitives/0/attributes/COLOR_0: must name a VEC3 or VEC4 of FLOAT"},
       {"/meshes/0/primitives/0/attributes/JOINTS_0", 4,
        "/meshes/0/primitives/0/attributes/JOINTS_0: must name a VEC4 of UNSIGNED_BYTE"},
       {"/meshes/0/primitives/0/attributes/WEIGHTS_0", kNone,
        "/meshes/0/primitives/0/attributes: has JOINTS_0, and not the other of JOINTS_0 and WEIGHTS_0"},
       {"/accessors/1/count", 2, "/meshes/0/primitives/0/attributes/"},
       {"/meshes/0/primitives/0/targets/0/POSITION", 2, "/meshes/0/primitives/0/targets/0/POSITION: must name a VEC3"},
       {"/meshes/0/primitives/0/targets/0", 5, "/meshes/0/primitives/0/targets/0: must be an object"},
       {"/meshes/0/weights", {1}, "/meshes/0/weights: has 1 numbers for 2 morph targets"},
       {"/meshes/0/primitives/1",
        {{"attributes", {{"POSITION", 0}}}},
        "/meshes/0/primitives/1/targets: has 0 morph targets, and the mesh's first primitive 2"},
       {"/meshes/0/primitives/0/extensions/KHR_materials_variants/mappings/0/variants/0", 1,
        "/meshes/0/primitives/0/extensions/KHR_materials_variants/mappings/0/variants/0: is 1"},
       {"/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression",
        {{"bufferView", 99}, {"attributes", {{"POSITION", 0}}}},
        "/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression/bufferView: is 99"},
       {"/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression",
        {{"bufferView", 0}, {"attributes", {{"NONE", -1}}}},
        "/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression/attributes/NONE: must be at least 0"}});
}

TEST(GltfCheck, QuantizationIsAskedFor) {
  ModelBuilder b = everything();
  b.json["accessors"][1] = {{"bufferView", b.view(std::string(12, '\1'), 4)},
                            {"componentType", 5120},
                            {"normalized", true},
                            {"type", "VEC3"},
                            {"count", 3}};
  Diagnostics diagnostics;
  EXPECT_FALSE(b.load(diagnostics));
  EXPECT_NE(
      messages(diagnostics)
          .find("/attributes/NORMAL: names accessor 1, a VEC3 of normalized BYTE, which needs KHR_mesh_quantization"),
      std::string::npos)
      << messages(diagnostics);
  b.json["extensionsUsed"].push_back("KHR_mesh_quantization");
  EXPECT_TRUE(b.load());
}

TEST(GltfCheck, NodesAndScenes) {
  expect_all(
      {{"/scene", 1, "/scene: is 1, and the last of the file's scenes is 0"},
       {"/scene", "first", "/scene: must be a whole number, and is \"first\""},
       {"/scenes/0/nodes/0", 9, "/scenes/0/nodes/0: is 9"},
       {"/scenes/0/nodes/1", 1, "/scenes/0/nodes: has node 1, which is a child of node 0"},
       {"/nodes/0/children/1", 1, "/nodes/0/children/1: 1 is there twice"},
       {"/nodes/3/children", {1}, "/nodes/3/children: has node 1, which is a child of node 0 already"},
       {"/nodes/3/children", {0}, "/nodes/0: is its own ancestor"},
       {"/nodes/1/children", {1}, "/nodes/1/children: has node 1, which is a child of node 0 already"},
       {"/nodes/1/mesh", 4, "/nodes/1/mesh: is 4"},
       {"/nodes/1/skin", 4, "/nodes/1/skin: is 4"},
       {"/nodes/2/camera", 4, "/nodes/2/camera: is 4"},
       {"/nodes/1/weights", {1}, "/nodes/1/weights: has 1 numbers for 2 morph targets"},
       {"/nodes/1/rotation", {0, 0, 0, 0}, "/nodes/1/rotation: is the quaternion 0"},
       {"/nodes/1/rotation", {0, 0, 1}, "/nodes/1/rotation: must be an array of 4 numbers, and has 3"},
       {"/nodes/1/translation", {0, 0, "x"}, "/nodes/1/translation/2: must be a number, and is \"x\""},
       {"/nodes/1/translation", {0, true, 0}, "/nodes/1/translation/1: must be a number, and is true"},
       {"/nodes/2/matrix/3", 1, "/nodes/2/matrix: is not that of a rotation"},
       {"/nodes/0/name", 7, "/nodes/0/name: must be a string"},
       {"/nodes/3/extensions/KHR_lights_punctual/light", 2, "/nodes/3/extensions/KHR_lights_punctual/light: is 2"},
       {"/nodes/3/extensions/EXT_mesh_gpu_instancing/attributes/ROTATION", 0,
        "/nodes/3/extensions/EXT_mesh_gpu_instancing/attributes/ROTATION: must name a VEC4"},
       {"/nodes/3/extensions/EXT_mesh_gpu_instancing/attributes/SCALE", 99,
        "/nodes/3/extensions/EXT_mesh_gpu_instancing/attributes/SCALE: is 99"},
       {"/skins/0/joints", Json::array(), "/skins/0/joints: is empty"},
       {"/skins/0/joints", {0, 1}, "/skins/0/inverseBindMatrices: has 1 matrices for 2 joints"},
       {"/skins/0/inverseBindMatrices", 4, "/skins/0/inverseBindMatrices: must name a MAT4 of FLOAT"}});
}

TEST(GltfCheck, CyclesAndDepth) {
  ModelBuilder cycle;
  cycle.json["nodes"] = {{{"children", {1}}}, {{"children", {2}}}, {{"children", {0}}}};
  Diagnostics said;
  EXPECT_FALSE(cycle.load(said));
  EXPECT_EQ(messages(said),
            "model.glb: /nodes/0: is its own ancestor (the file is damaged, or what wrote it is wrong: export the "
            "model again)\n");
  for (const int depth : {gltf::kMostDepth, gltf::kMostDepth + 1}) {
    ModelBuilder chain;
    // The root is the last one, so that no order of the file helps.
    for (int i = 0; i < depth; ++i)
      chain.json["nodes"].push_back(i == 0 ? Json::object() : Json{{"children", {i - 1}}});
    Diagnostics diagnostics;
    EXPECT_EQ(chain.load(diagnostics) != nullptr, depth == gltf::kMostDepth) << messages(diagnostics);
    if (depth > gltf::kMostDepth) {
      EXPECT_NE(messages(diagnostics).find("/nodes/0: lies deeper than 1000 nodes"), std::string::npos);
    }
  }
}

TEST(GltfCheck, RotationsAreBroughtToLengthOne) {
  ModelBuilder b = everything();
  b.json["nodes"][1]["rotation"] = {0, 3, 0, 4};
  EXPECT_NEAR(b.load()->nodes[1].rotation[1], 0.6, 1e-15);
  EXPECT_NEAR(b.load()->nodes[1].rotation[3], 0.8, 1e-15);
}

TEST(GltfCheck, Animations) {
  expect_all(
      {{"/animations/0/channels", kNone, "/animations/0/channels: is missing"},
       {"/animations/0/channels/0/sampler", 3, "/animations/0/channels/0/sampler: is 3"},
       {"/animations/0/channels/0/target", kNone, "/animations/0/channels/0/target: is missing"},
       {"/animations/0/channels/0/target/node", 99, "/animations/0/channels/0/target/node: is 99"},
       {"/animations/0/channels/0/target/path", "color",
        "/animations/0/channels/0/target/path: must be one of translation, rotation, scale, weights, and is \"color\""},
       {"/animations/0/channels/1/target/path", "translation",
        "/animations/0/channels/1/target: node 0 has another channel of this path"},
       {"/animations/0/channels/0/sampler", 1, "/animations/0/channels/0/sampler: must name a VEC3 of FLOAT"},
       {"/animations/0/channels/2/target/node", 0, "/animations/0/channels/2/target: node 0 has no morph targets"},
       {"/animations/0/samplers/0/input", 0, "/animations/0/samplers/0/input: must name a SCALAR of FLOAT"},
       {"/animations/0/samplers/0/input", 10,
        "/animations/0/samplers/0/input: must increase, and 0 follows 0 at number 1"},
       {"/animations/0/samplers/0/output", 99, "/animations/0/samplers/0/output: is 99"},
       {"/animations/0/samplers/0/interpolation", "SMOOTH",
        "/animations/0/samplers/0/interpolation: must be one of LINEAR, STEP, CUBICSPLINE"},
       {"/animations/0/samplers/0/interpolation", "CUBICSPLINE",
        "/animations/0/channels/0/sampler: has 3 output values, and its 3 times ask for 9"}});
}

TEST(GltfCheck, CamerasAndLights) {
  const char* light = "/extensions/KHR_lights_punctual/lights/0/color";
  expect_all(
      {{"/cameras/0/type", "fisheye", "/cameras/0/type: must be one of perspective, orthographic, and is \"fisheye\""},
       {"/cameras/0/perspective", kNone, "/cameras/0/perspective: is missing"},
       {"/cameras/0/perspective/yfov", 0, "/cameras/0/perspective/yfov: must be above 0, and is 0"},
       {"/cameras/0/perspective/yfov", 45, "/cameras/0/perspective/yfov: must be at most 3.14"},
       {"/cameras/0/perspective/aspectRatio", -1,
        "/cameras/0/perspective/aspectRatio: must be at least 1e-05, and is -1"},
       {"/cameras/1/orthographic/xmag", 0, "/cameras/1/orthographic/xmag: must be above 0, and is 0"},
       {"/cameras/1/orthographic/zfar", 0, "/cameras/1/orthographic/zfar: must be above 0, and is 0"},
       {"/extensions/KHR_lights_punctual/lights/0/type", "area",
        "/extensions/KHR_lights_punctual/lights/0/type: must be one of directional, point, spot"},
       {"/extensions/KHR_lights_punctual/lights/0/intensity", -1,
        "/extensions/KHR_lights_punctual/lights/0/intensity: must be at least 0, and is -1"},
       {"/extensions/KHR_lights_punctual/lights/0/intensity", 1e300,
        "/extensions/KHR_lights_punctual/lights/0/intensity: must be at most 1e+30"},
       {light, {1, 1}, "/extensions/KHR_lights_punctual/lights/0/color: must be an array of 3 numbers, and has 2"},
       {"/extensions/KHR_lights_punctual/lights/0/spot", kNone,
        "/extensions/KHR_lights_punctual/lights/0/spot: is missing"},
       {"/extensions/KHR_lights_punctual/lights/0/spot/innerConeAngle", 1.2,
        "/extensions/KHR_lights_punctual/lights/0/spot/innerConeAngle: must be below outerConeAngle"},
       {"/extensions/KHR_lights_punctual/lights/0/spot/outerConeAngle", 3,
        "/extensions/KHR_lights_punctual/lights/0/spot/outerConeAngle: must be at most 1.57"}});
}

TEST(GltfCheck, MaterialsAndTextures) {
  expect_all(
      {{"/materials/0", 7, "/materials/0: must be an object, and is 7"},
       {"/materials/0/pbrMetallicRoughness", Json::array(),
        "/materials/0/pbrMetallicRoughness: must be an object, and is an array"},
       {"/materials/0/pbrMetallicRoughness/baseColorFactor",
        {1, 1, 1},
        "/materials/0/pbrMetallicRoughness/baseColorFactor: must be an array of 4 numbers, and has 3"},
       {"/materials/0/pbrMetallicRoughness/baseColorTexture/index", 1,
        "/materials/0/pbrMetallicRoughness/baseColorTexture/index: is 1"},
       {"/materials/0/pbrMetallicRoughness/baseColorTexture/index", kNone,
        "/materials/0/pbrMetallicRoughness/baseColorTexture/index: is missing"},
       {"/materials/0/pbrMetallicRoughness/baseColorTexture/texCoord", -1,
        "/materials/0/pbrMetallicRoughness/baseColorTexture/texCoord: must be at least 0"},
       {"/materials/0/pbrMetallicRoughness/baseColorTexture/extensions",
        {{"KHR_texture_transform", 7}},
        "/materials/0/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform: must be an object"},
       {"/materials/0/pbrMetallicRoughness/metallicFactor", "1",
        "/materials/0/pbrMetallicRoughness/metallicFactor: must be a number, and is \"1\""},
       {"/materials/0/emissiveFactor", {-1, 0, 0}, "/materials/0/emissiveFactor/0: must be at least 0, and is -1"},
       {"/materials/0/alphaMode", "CUT", "/materials/0/alphaMode: must be one of OPAQUE, MASK, BLEND, and is \"CUT\""},
       {"/materials/0/doubleSided", 1, "/materials/0/doubleSided: must be true or false, and is 1"},
       {"/materials/0/extensions/KHR_materials_ior/ior", 0.5,
        "/materials/0/extensions/KHR_materials_ior/ior: must be 0 or at least 1, and is 0.5"},
       {"/textures/0/source", 1, "/textures/0/source: is 1"},
       {"/textures/0/sampler", 1, "/textures/0/sampler: is 1"},
       {"/samplers/0/wrapS", 5, "/samplers/0/wrapS: must be one of 10497, 33071, 33648, and is 5"},
       {"/samplers/0/magFilter", 9984, "/samplers/0/magFilter: must be one of 9728, 9729"},
       {"/images/0/bufferView", 99, "/images/0/bufferView: is 99"},
       {"/images/0/bufferView", kNone, "/images/0: has neither a \"uri\" nor a \"bufferView\""},
       {"/images/0/uri", "a.png", "/images/0: has both a \"uri\" and a \"bufferView\""}});
}

TEST(GltfCheck, FactorsAreBroughtIntoTheirRange) {
  ModelBuilder b = everything();
  b.json["materials"][0]["pbrMetallicRoughness"]["metallicFactor"] = 1.0000001;
  Diagnostics diagnostics;
  const auto model = b.load(diagnostics);
  ASSERT_TRUE(model);
  EXPECT_EQ(model->materials[0].metallic, 1);
  ASSERT_EQ(diagnostics.all().size(), 1u);
  EXPECT_TRUE(diagnostics.all()[0].excused);
  EXPECT_EQ(messages(diagnostics),
            "model.glb: /materials/0/pbrMetallicRoughness/metallicFactor: must be from 0 to 1, and is 1.0000001 (1 is "
            "taken)\n");
}

TEST(GltfCheck, WholeNumbersMayBeWrittenWithAPoint) {
  ModelBuilder b = everything();
  b.json["nodes"][1]["mesh"] = 0.0;
  b.json["accessors"][0]["count"] = 3.0;
  EXPECT_EQ(b.load()->nodes[1].mesh, 0);
}

TEST(GltfCheck, AllErrorsAreToldUpToFifty) {
  ModelBuilder b = everything();
  for (int i = 0; i < 60; ++i) b.json["nodes"].push_back({{"mesh", 5 + i}});
  Diagnostics diagnostics;
  EXPECT_FALSE(b.load(diagnostics));
  ASSERT_EQ(diagnostics.all().size(), 51u);
  EXPECT_EQ(diagnostics.all().back().message, "model.glb: and 10 more errors");
}

}  // namespace
}  // namespace whit::test
