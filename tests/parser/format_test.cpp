#include "parser/format.h"

#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "tests/base/temp_folder.h"
#include "tests/parser/parser_test_support.h"

namespace whit {
namespace {

std::string formatted(const std::string& text, const FormatOptions& options = {},
                      const std::string& folder = "/nowhere") {
  Sources sources;
  std::ostringstream out;
  format_text(sources, "test.pbrt", text, folder, out, options);
  return out.str();
}

/// A scene that holds every directive and every type of parameter.
const char* const kEverything = R"(# A scene
TransformTimes 0   2
LookAt 0 -5 1  0 0 .5  0 0 1
Camera   "perspective" "float fov" [40]   # the lens
Film "image" "string filename" "a\"b\\c.exr" "integer xresolution" [ 32 ] "float cropwindow" [ 0 1 0 .5 ]


Sampler "halton"
PixelFilter "box"
Accelerator "bvh"
Integrator "whitted"
MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [1 2 3]
WorldBegin
CoordinateSystem "here" MediumInterface "fog" ""
  # light
LightSource "point" "color I" [ 20 20 20 ] "point from" [ 2 -4 4 ] "blackbody L" [ 3000 1 ]
Texture "t" "spectrum" "imagemap" "string filename" "x.png" "bool trilinear" "true" "spectrum s" "gold.spd"
AttributeBegin # first
Material "matte"
   "texture Kd" "t"   # inner
   "xyz Ks" [ .1 .2 .3 ] "spectrum k" [ 400 1 700 1e-30 ]
TransformBegin Rotate 30 0 0 1 Scale 2 2 2 TransformEnd
Transform [ 1 0 0 0  0 1 0 0  0 0 1 0  .1 .2 .3 1 ]
ConcatTransform [ 1 0 0 0  0 1 0 0  0 0 1 0  0 0 0 1 ]
ActiveTransform EndTime Translate 1e10 -0.1 123456789 ActiveTransform All
ReverseOrientation
AreaLightSource "diffuse" "rgb L" [ 1 1 1 ]
Shape "sphere" "vector v" [0 0 1] "normal n" [0 0 1] "point2 p" [1 2] "vector2 w" [1 2] "integer i" [-1 2147483647]
  # last of the block
AttributeEnd
MakeNamedMaterial "m" "string type" "glass" NamedMaterial "m"
Identity CoordSysTransform "camera"
ObjectBegin "o" Shape "sphere" ObjectEnd
ObjectInstance "o"
WorldEnd
# the end)";

TEST(Format, NormalForm) {
  EXPECT_EQ(formatted("WorldBegin AttributeBegin Translate 1.0 2. .5   #why\n\n\n\n# Two\nShape\n\"sphere\"  # r\n "
                      "\"float radius\" [ 1.50 ] \"color c\" [1 2 3]\nAttributeEnd\nWorldEnd"),
            "WorldBegin\n"
            "AttributeBegin\n"
            "  Translate 1 2 0.5  #why\n"
            "\n"
            "  # Two\n"
            "  # r\n"
            "  Shape \"sphere\" \"float radius\" 1.5 \"rgb c\" [ 1 2 3 ]\n"
            "AttributeEnd\n"
            "WorldEnd\n");
}

TEST(Format, TwiceIsOnce) {
  const std::string once = formatted(kEverything);
  EXPECT_EQ(formatted(once), once);
}

TEST(Format, MeansTheSame) {
  const Parsed before(kEverything), after(formatted(kEverything));
  EXPECT_FALSE(before.result.diagnostics.has_errors()) << before.messages();
  EXPECT_EQ(before.all().size(), after.all().size()) << after.messages();
  EXPECT_EQ(dump(before.scene()), dump(after.scene()));
}

TEST(Format, CommentsStay) {
  const std::string out = formatted(kEverything);
  for (const char* comment : {"# A scene\n", "  # the lens\n", "# light\n", "AttributeBegin  # first\n", "  # inner\n",
                              "  # last of the block\nAttributeEnd", "# the end\n"})
    EXPECT_NE(out.find(comment), std::string::npos) << comment << "\n" << out;
}

TEST(Format, MistakesAreReportedAndCopied) {
  const std::string text = "WorldBegin\nShape \"s\" \"rgb c\" [ 1 2 ]  \"float r\" [ 1 # c\n 2 ]\nFoo  1\nWorldEnd\n";
  Sources sources;
  std::ostringstream out;
  const Diagnostics diagnostics = format_text(sources, "t", text, "", out);
  EXPECT_EQ(diagnostics.all().size(), 2u);
  EXPECT_EQ(out.str(), text);
}

TEST(Format, AnOpenStringBehindAGoodStatement) {
  const std::string text = "WorldBegin\nIdentity \"open\nWorldEnd\n";
  EXPECT_EQ(formatted(text), "WorldBegin\nIdentity\n\"open\nWorldEnd\n");
}

class FormatFiles : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = (std::filesystem::path(test::temp_folder()) /
               (std::string("whit_") + testing::UnitTest::GetInstance()->current_test_info()->name()))
                  .string();
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string folder_;
};

TEST_F(FormatFiles, IncludesStayOrAreExpanded) {
  std::ofstream(folder_ + "/a.pbrt") << "# in a\nShape \"s\"";
  const std::string text = "WorldBegin\nAttributeBegin\nInclude \"a.pbrt\"\nAttributeEnd\nWorldEnd\n";
  EXPECT_EQ(formatted(text, {}, folder_), "WorldBegin\nAttributeBegin\n  Include \"a.pbrt\"\nAttributeEnd\nWorldEnd\n");
  FormatOptions options;
  options.expand_includes = true;
  EXPECT_EQ(formatted(text, options, folder_),
            "WorldBegin\nAttributeBegin\n  # in a\n  Shape \"s\"\nAttributeEnd\nWorldEnd\n");
}

TEST_F(FormatFiles, ParametersBehindAnInclude) {
  std::ofstream(folder_ + "/a.pbrt") << "Shape \"s\" \"float r\" 1  # in a\n";
  const std::string text = "WorldBegin\nInclude \"a.pbrt\"\n  \"float q\" 2\nWorldEnd\n";
  EXPECT_EQ(formatted(text, {}, folder_), "WorldBegin\nInclude \"a.pbrt\" \"float q\" 2\nWorldEnd\n");
  FormatOptions options;
  options.expand_includes = true;
  EXPECT_EQ(formatted(text, options, folder_),
            "WorldBegin\nShape \"s\" \"float r\" 1 \"float q\" 2  # in a\nWorldEnd\n");
}

/// A fan of `triangles` triangles around vertex 0, far from the origin when `offset` is large.
std::string fan(int triangles, double offset) {
  std::ostringstream out;
  out.precision(17);
  out << "Shape \"trianglemesh\" \"float alpha\" 1 \"integer indices\" [";
  for (int i = 0; i < triangles; ++i) out << " 0 " << i + 1 << " " << i + 2;
  out << " ] \"point P\" [";
  for (int i = 0; i < triangles + 2; ++i) out << " " << offset + i * 0.5 << " " << i * i << " 0";
  return out.str() + " ]\n";
}

TEST_F(FormatFiles, LargeMeshesBecomePlyFiles) {
  FormatOptions options;
  options.to_ply = true;
  options.ply_folder = folder_;
  // 166 triangles have 498 indices and stay; 167 have 501.
  EXPECT_EQ(formatted(fan(166, 0), options), formatted(fan(166, 0)));
  EXPECT_EQ(formatted(fan(167, 0) + fan(167, 1e9), options),
            "Shape \"plymesh\" \"string filename\" \"mesh_00001.ply\" \"float alpha\" 1\n"
            "Shape \"plymesh\" \"string filename\" \"mesh_00002.ply\" \"float alpha\" 1\n");
  std::ifstream file(folder_ + "/mesh_00001.ply", std::ios::binary);
  const std::string ply((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  const std::string header =
      "ply\nformat binary_little_endian 1.0\nelement vertex 169\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 167\nproperty list uint8 int vertex_indices\nend_header\n";
  ASSERT_EQ(ply.substr(0, header.size()), header);
  // 169 vertices of three floats, 167 faces of a count and three integers.
  ASSERT_EQ(ply.size(), header.size() + 169 * 12 + 167 * 13);
  float second_x = 0;
  std::memcpy(&second_x, ply.data() + header.size() + 12, 4);
  EXPECT_EQ(second_x, 0.5f);
  int32_t last = 0;
  std::memcpy(&last, ply.data() + ply.size() - 4, 4);
  EXPECT_EQ(last, 168);
  // At 1e9 a float resolves 64 units: positions are written as doubles.
  std::ifstream far(folder_ + "/mesh_00002.ply", std::ios::binary);
  const std::string text((std::istreambuf_iterator<char>(far)), std::istreambuf_iterator<char>());
  EXPECT_NE(text.find("property double x"), std::string::npos);
}

TEST_F(FormatFiles, MeshesTakeNamesThatAreFree) {
  std::vector<std::string> written;
  FormatOptions options;
  options.to_ply = true;
  options.ply_folder = folder_;
  options.written = &written;
  const auto path = [this](const std::string& name) { return folder_ + "/" + name; };
  std::ofstream(path("mesh_00001.ply")) << "another scene's";
  std::filesystem::create_symlink(path("not-there"), path("mesh_00002.ply"));
  std::filesystem::create_directory(path("mesh_00003.ply"));
  const std::string once = formatted(fan(167, 0) + fan(168, 0), options);
  EXPECT_NE(once.find("\"mesh_00004.ply\""), std::string::npos) << once;
  EXPECT_NE(once.find("\"mesh_00005.ply\""), std::string::npos) << once;
  EXPECT_EQ(written, (std::vector<std::string>{path("mesh_00004.ply"), path("mesh_00005.ply")}));
  EXPECT_EQ(std::filesystem::file_size(path("mesh_00001.ply")), 15u);
  EXPECT_FALSE(std::filesystem::exists(path("not-there")));
  // Once more: the very same meshes are there already.
  written.clear();
  EXPECT_EQ(formatted(fan(167, 0) + fan(168, 0), options), once);
  EXPECT_TRUE(written.empty());
}

TEST(Format, AnEmptyFileMayBeIncluded) {
  EXPECT_EQ(formatted(""), "");
  EXPECT_EQ(formatted(" \n\n"), "");
}

TEST_F(FormatFiles, WrongMeshesStayInline) {
  FormatOptions options;
  options.to_ply = true;
  options.ply_folder = folder_;
  std::string wrong = fan(167, 0);
  wrong.replace(wrong.find(" 0 1 2"), 6, " 0 1 999");
  EXPECT_EQ(formatted(wrong, options), formatted(wrong));
  EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

TEST_F(FormatFiles, UnwritablePlyIsAFileErrorAndLeavesTheMesh) {
  FormatOptions options;
  options.to_ply = true;
  options.ply_folder = folder_ + "/not/there";
  Sources sources;
  std::ostringstream out;
  const Diagnostics diagnostics = format_text(sources, "t", fan(167, 0), "", out, options);
  ASSERT_EQ(diagnostics.all().size(), 1u);
  EXPECT_EQ(diagnostics.all()[0].error_class, ErrorClass::File);
  EXPECT_EQ(out.str(), formatted(fan(167, 0)));
}

}  // namespace
}  // namespace whit
