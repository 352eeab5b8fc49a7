// What stays between builds of a scene that is edited: that it does stay, that what changed does not, and that the picture
// is the one of a build that keeps nothing.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <vector>

#include "core/image/write.h"
#include "core/session/session.h"
#include "tests/base/temp_folder.h"

namespace whit {
namespace {

constexpr int kSide = 40;  // of a sheet: 3200 triangles, more than KeptGeometry::kLeast

/// A square of side 2 with waves of the given height, in a PLY file.
void write_sheet(const std::string& path, double height) {
  std::ofstream file(path, std::ios::binary);
  file << fmt::format("ply\nformat ascii 1.0\nelement vertex {}\n", (kSide + 1) * (kSide + 1))
       << "property float x\nproperty float y\nproperty float z\n"
       << fmt::format("element face {}\nproperty list uchar int vertex_indices\nend_header\n", 2 * kSide * kSide);
  for (int j = 0; j <= kSide; ++j) {
    for (int i = 0; i <= kSide; ++i) {
      const double x = 2.0 * i / kSide - 1, y = 2.0 * j / kSide - 1;
      file << fmt::format("{} {} {}\n", x, y, height * std::sin(5 * x) * std::cos(4 * y));
    }
  }
  for (int j = 0; j < kSide; ++j) {
    for (int i = 0; i < kSide; ++i) {
      const int a = j * (kSide + 1) + i, b = a + kSide + 1;
      file << fmt::format("3 {} {} {}\n3 {} {} {}\n", a, a + 1, b + 1, a, b + 1, b);
    }
  }
}

/// Two sheets, one of them mirrored, askew and by an instance, over a floor, under a lamp that they shade.
std::string scene(const std::string& folder, const std::string& eye = "0 -1 4", const std::string& turn = "30",
                  const std::string& colour = ".5 .6 .7", const std::string& lamp = "1 2 5") {
  const std::string sheet = fmt::format("Shape \"plymesh\" \"string filename\" \"{}/", folder);
  return fmt::format(
             "Film \"image\" \"integer xresolution\" 48 \"integer yresolution\" 48\n"
             "Sampler \"halton\" \"integer pixelsamples\" 4\nLookAt {}  0 0 0  0 1 0\n"
             "Camera \"perspective\" \"float fov\" 50\nWorldBegin\n"
             "LightSource \"point\" \"point from\" [{}] \"rgb I\" [25 25 25]\n"
             "Material \"matte\" \"rgb Kd\" [{}]\n",
             eye, lamp, colour) +
         fmt::format("AttributeBegin Rotate {} 0 1 0 Translate -.6 .2 .3 {}a.ply\" AttributeEnd\n", turn, sheet) +
         fmt::format(
             "ObjectBegin \"o\" Texture \"t\" \"color\" \"imagemap\" \"string filename\" \"{}/t.pfm\"\n"
             "Material \"matte\" \"texture Kd\" \"t\" {}b.ply\" ObjectEnd\n",
             folder, sheet) +
         "AttributeBegin Translate .8 0 .5 Scale -.7 .8 .9 ObjectInstance \"o\" AttributeEnd\n"
         "AttributeBegin Scale 1.2 1.2 -1.2 Translate 0 -.5 .2 " +
         sheet +
         "b.ply\" AttributeEnd\n"
         "Translate 0 0 -1 Shape \"disk\" \"float radius\" 5\nWorldEnd\n";
}

class KeptPartsTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(folder);
    write_sheet(folder + "/a.ply", 0.1);
    write_sheet(folder + "/b.ply", 0.2);
    write_texture(0.8f);
  }
  void write_texture(float value) const {
    const std::vector<float> rgb(3 * 4 * 4, value);
    ASSERT_TRUE(write_image(folder + "/t.pfm", {.width = 4, .height = 4, .rgb = rgb}).ok());
  }
  static PlannedWorld plan(const ParsedFile& file) { return plan_world(file.worlds.at(0), *file.sources); }

  std::vector<float> rebuilt(const std::string& text) {
    const ParsedFile file = read_scene_text("t", text);
    BuiltWorld built = rebuild_world(plan(file), {}, kept);
    EXPECT_FALSE(file.said.has_errors() || built.said.has_errors());
    return render_world(built).result.picture.rgb;
  }
  static std::vector<float> built(const std::string& text) {
    const ParsedFile file = read_scene_text("t", text);
    return render_world(build_world(plan(file))).result.picture.rgb;
  }
  /// Meshes that the last build found and that it built.
  std::pair<int, int> tally() const { return {kept.geometry.found(), kept.geometry.built()}; }

  const std::string folder = test::temp_folder() + "/kept parts";
  KeptParts kept;
};

/// The mean difference over the mean. Rays at edges and shadow boundaries may fall to the other side by rounding: of
/// 48 x 48 x 4 samples a handful, and single samples move the mean by less than 1e-4.
double difference(const std::vector<float>& a, const std::vector<float>& b) {
  double sum = 0, mean = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += std::abs(a[i] - b[i]), mean += std::abs(b[i]);
  return sum / mean;
}

TEST_F(KeptPartsTest, KeepWhatDidNotChange) {
  // The object's sheet and the last are of one file, but whoever builds side by side builds both; of them one stays.
  rebuilt(scene(folder));
  EXPECT_GE(kept.geometry.built(), 2);
  const std::string changes[] = {scene(folder, "1 -1 3"), scene(folder, "0 -1 4", "60"),
                                 scene(folder, "0 -1 4", "30", ".9 .1 .1"),
                                 scene(folder, "0 -1 4", "30", ".5 .6 .7", "-2 1 4")};
  for (const std::string& changed : changes) {
    const std::vector<float> again = rebuilt(changed);
    EXPECT_EQ(tally(), std::pair(3, 0));
    EXPECT_LT(difference(again, built(changed)), 1e-3) << changed;
    // To the bit what it is when all of it is new.
    KeptParts fresh;
    const ParsedFile file = read_scene_text("t", changed);
    EXPECT_EQ(again, render_world(rebuild_world(plan(file), {}, fresh)).result.picture.rgb);
  }
}

TEST_F(KeptPartsTest, BuildAMeshThatChanged) {
  rebuilt(scene(folder));
  write_sheet(folder + "/a.ply", 0.3);
  const std::vector<float> picture = rebuilt(scene(folder));
  EXPECT_EQ(tally(), std::pair(2, 1));
  EXPECT_LT(difference(picture, built(scene(folder))), 1e-3);
  // A file that is gone is an error, not yesterday's mesh.
  std::filesystem::remove(folder + "/a.ply");
  const ParsedFile file = read_scene_text("t", scene(folder));
  EXPECT_TRUE(plan(file).said.has_errors());
}

TEST_F(KeptPartsTest, ForgetWhatIsNoMoreAskedFor) {
  rebuilt(scene(folder));
  const std::string other =
      "Film \"image\" \"integer xresolution\" 8 \"integer yresolution\" 8 WorldBegin Shape \"sphere\" WorldEnd";
  rebuilt(other);
  rebuilt(other);
  rebuilt(scene(folder));
  EXPECT_GE(kept.geometry.built(), 2);
}

TEST_F(KeptPartsTest, DecodeTexturesOnceUntilTheyChange) {
  rebuilt(scene(folder));
  const int64_t decodes = kept.textures->statistics().decodes;
  EXPECT_GT(decodes, 0);
  rebuilt(scene(folder, "1 -1 3"));
  EXPECT_EQ(kept.textures->statistics().decodes, decodes);
  write_texture(0.2f);
  EXPECT_LT(difference(rebuilt(scene(folder)), built(scene(folder))), 1e-3);
}

TEST_F(KeptPartsTest, LeaveMeshesAloneThatEmitOrHaveHoles) {
  const std::string sheet = fmt::format("Shape \"plymesh\" \"string filename\" \"{}/a.ply\"", folder);
  const std::string text =
      "LookAt 0 -1 4  0 0 0  0 1 0 Camera \"perspective\" Film \"image\" \"integer xresolution\" 16 \"integer "
      "yresolution\" 16 WorldBegin\n" +
      sheet + " \"float alpha\" 0\nAreaLightSource \"diffuse\" \"rgb L\" [2 2 2] " + sheet + "\nWorldEnd";
  const std::vector<float> picture = rebuilt(text);
  EXPECT_EQ(tally(), std::pair(0, 0));
  EXPECT_EQ(picture, built(text));
}

/// A glTF model of one sheet, with its numbers in a file beside it.
void write_model(const std::string& folder, double height) {
  std::vector<float> points;
  std::vector<uint16_t> indices;
  for (int j = 0; j <= kSide; ++j) {
    for (int i = 0; i <= kSide; ++i) {
      const double x = 2.0 * i / kSide - 1, y = 2.0 * j / kSide - 1;
      for (const double v : {x, y, height * std::sin(5 * x)}) points.push_back(static_cast<float>(v));
    }
  }
  for (int j = 0; j < kSide; ++j) {
    for (int i = 0; i < kSide; ++i) {
      const int a = j * (kSide + 1) + i, b = a + kSide + 1;
      for (const int k : {a, a + 1, b + 1, a, b + 1, b}) indices.push_back(static_cast<uint16_t>(k));
    }
  }
  const size_t point_bytes = points.size() * sizeof(float), index_bytes = indices.size() * sizeof(uint16_t);
  std::ofstream buffer(folder + "/model.bin", std::ios::binary);
  buffer.write(reinterpret_cast<const char*>(points.data()), static_cast<std::streamsize>(point_bytes));
  buffer.write(reinterpret_cast<const char*>(indices.data()), static_cast<std::streamsize>(index_bytes));
  std::ofstream(folder + "/model.gltf") << fmt::format(
      R"({{"asset":{{"version":"2.0"}},"scenes":[{{"nodes":[0]}}],"scene":0,"nodes":[{{"mesh":0}}],
"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],
"buffers":[{{"uri":"model.bin","byteLength":{}}}],
"bufferViews":[{{"buffer":0,"byteLength":{}}},{{"buffer":0,"byteOffset":{},"byteLength":{}}}],
"accessors":[{{"bufferView":0,"componentType":5126,"type":"VEC3","count":{},"min":[-1,-1,-{}],"max":[1,1,{}]}},
{{"bufferView":1,"componentType":5123,"type":"SCALAR","count":{}}}]}})",
      point_bytes + index_bytes, point_bytes, point_bytes, index_bytes, points.size() / 3, height, height,
      indices.size());
  // What was written while it is read counts as changed, and this was long ago.
  buffer.close();
  const auto hours = std::chrono::hours(height > 0.3 ? 1 : 2);
  std::filesystem::last_write_time(folder + "/model.bin", std::filesystem::file_time_type::clock::now() - hours);
}

TEST_F(KeptPartsTest, ReadModelsOnceUntilTheyChange) {
  write_model(folder, 0.25);
  const std::string path = folder + "/scene.pbrt";
  const auto write = [&](const std::string& eye) {
    std::ofstream(path) << "LookAt " << eye
                        << "  0 0 0  0 1 0 Camera \"perspective\" Film \"image\" \"integer xresolution\" 16 \"integer "
                           "yresolution\" 16 WorldBegin LightSource \"point\" \"point from\" [0 0 5]\n"
                           "Shape \"gltf\" \"string filename\" \"model.gltf\" WorldEnd";
  };
  const auto again = [&] {
    const ParsedFile file = reread_scene_file(path, {}, kept);
    EXPECT_FALSE(file.said.has_errors());
    return render_world(rebuild_world(plan(file), {}, kept)).result.picture.rgb;
  };
  write("0 -1 4");
  again();
  EXPECT_EQ(tally(), std::pair(0, 1));
  write("0 -1 3");
  const std::vector<float> picture = again();
  EXPECT_EQ(tally(), std::pair(1, 0));
  const ParsedFile file = read_scene_file(path);
  EXPECT_LT(difference(picture, render_world(build_world(plan(file))).result.picture.rgb), 1e-3);
  // Its numbers are in another file than the model's own.
  write_model(folder, 0.5);
  again();
  EXPECT_EQ(tally(), std::pair(0, 1));
}

}  // namespace
}  // namespace whit
