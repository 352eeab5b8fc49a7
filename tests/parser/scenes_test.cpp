// What statements mean: options, scopes of names and state, objects, includes.
#include <cctype>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "tests/base/temp_folder.h"
#include "tests/parser/parser_test_support.h"

namespace whit {
namespace {

TEST(Scenes, OptionsArePluginsWithParameters) {
  const Parsed parsed(
      "Film \"image\" \"integer xresolution\" 32\nSampler \"halton\"\nIntegrator \"whitted\"\nFilter \"box\"\n"
      "PixelFilter \"gaussian\"\nAccelerator \"bvh\"\nCamera \"perspective\" \"float fov\" 40\nWorldBegin\nWorldEnd\n");
  expect_clean(parsed);
  const SceneDescription& scene = parsed.scene();
  EXPECT_EQ(scene.film.plugin, "image");
  EXPECT_EQ(scene.film.params.at(0).integers(), (std::vector<int32_t>{32}));
  EXPECT_EQ(scene.sampler.plugin, "halton");
  EXPECT_EQ(scene.integrator.plugin, "whitted");
  EXPECT_EQ(scene.filter.plugin, "gaussian");  // The later of two wins, and Filter is the same as PixelFilter.
  EXPECT_EQ(scene.accelerator.plugin, "bvh");
  EXPECT_EQ(scene.camera.plugin, "perspective");
  EXPECT_EQ(parsed.sources.location(scene.camera.where), "test.pbrt:7:1");
  EXPECT_EQ(parsed.sources.location(scene.camera.plugin_at), "test.pbrt:7:8");
  EXPECT_EQ(parsed.sources.location(scene.world_begin), "test.pbrt:8:1");
  EXPECT_EQ(scene.folder, "/nowhere");
  EXPECT_EQ(Parsed("WorldBegin WorldEnd").scene().film.plugin, "");
}

TEST(Scenes, SeveralWorldsShareNothing) {
  const Parsed parsed(
      "Translate 0 0 5 Camera \"perspective\" Sampler \"halton\" TransformTimes 0 2\nWorldBegin\n"
      "Material \"mirror\" Translate 1 0 0 ReverseOrientation\n"
      "Texture \"t\" \"float\" \"constant\" MakeNamedMaterial \"m\" \"string type\" \"glass\"\nObjectBegin \"o\" "
      "ObjectEnd\n"
      "WorldEnd\nFilm \"image\"\nWorldBegin\nShape \"s\" \"texture alpha\" \"t\"\nNamedMaterial \"m\" ObjectInstance "
      "\"o\" CoordSysTransform \"camera\"\n"
      "WorldEnd\n");
  ASSERT_EQ(parsed.result.scenes.size(), 2u);
  EXPECT_EQ(parsed.result.scenes[0].film.plugin, "");
  const SceneDescription& second = parsed.result.scenes[1];
  EXPECT_EQ(second.folder, "/nowhere");
  EXPECT_EQ(second.film.plugin, "image");
  EXPECT_EQ(second.sampler.plugin, "");
  EXPECT_EQ(second.camera.plugin, "");
  EXPECT_EQ(second.camera_transform, 0);
  EXPECT_EQ(second.time_end, 1);
  EXPECT_EQ(second.shapes.at(0).transform, 0);
  EXPECT_EQ(second.shapes.at(0).material, 0);
  EXPECT_FALSE(second.shapes.at(0).reverse_orientation);
  EXPECT_EQ(second.materials.size(), 1u);
  EXPECT_EQ(parsed.all().size(), 3u) << parsed.messages();  // m, o and "camera" are not known any more,
  EXPECT_EQ(second.shapes.at(0).params.at(0).textures().at(0).float_texture, -1);  // and neither is t
}

TEST(Scenes, MaterialsAndAreaLightsFollowAttributeBlocksOnly) {
  const Parsed parsed(in_world(
      "Shape \"s\"\nMaterial \"glass\"\nAttributeBegin Material \"mirror\" AreaLightSource \"diffuse\" Shape \"s\" "
      "AttributeEnd\nShape \"s\"\nTransformBegin Material \"metal\" Translate 1 0 0 TransformEnd Shape \"s\"\n"
      "AreaLightSource \"diffuse\" AreaLightSource \"\" Shape \"s\""));
  expect_clean(parsed);
  const SceneDescription& scene = parsed.scene();
  const auto plugin = [&](size_t i) {
    return scene.materials.at(static_cast<size_t>(scene.shapes.at(i).material)).plugin;
  };
  EXPECT_EQ(plugin(0), "matte");  // pbrt's default.
  EXPECT_EQ(plugin(1), "mirror");
  EXPECT_EQ(scene.shapes[1].area_light, 0);
  EXPECT_EQ(plugin(2), "glass");
  EXPECT_EQ(scene.shapes[2].area_light, -1);
  EXPECT_EQ(plugin(3), "metal");  // TransformEnd does not restore it.
  EXPECT_EQ(scene.shapes[3].transform, 0);
  EXPECT_EQ(scene.shapes[4].area_light, -1);
}

TEST(Scenes, ReverseOrientationToggles) {
  const Parsed parsed(in_world(
      "ReverseOrientation Shape \"s\" AttributeBegin ReverseOrientation Shape \"s\" AttributeEnd Shape \"s\""));
  EXPECT_TRUE(parsed.scene().shapes[0].reverse_orientation);
  EXPECT_FALSE(parsed.scene().shapes[1].reverse_orientation);
  EXPECT_TRUE(parsed.scene().shapes[2].reverse_orientation);
}

TEST(Scenes, TexturesHaveTwoNameSpacesAndScopes) {
  const Parsed parsed(
      in_world("Texture \"t\" \"float\" \"constant\"\nTexture \"t\" \"color\" \"checkerboard\"\nShape \"s\" \"texture "
               "a\" \"t\"\n"
               "AttributeBegin Texture \"t\" \"float\" \"fbm\" Shape \"s\" \"texture a\" \"t\" AttributeEnd\n"
               "Shape \"s\" \"texture a\" \"t\""));
  expect_clean(parsed);
  const auto ref = [&](size_t i) { return parsed.scene().shapes.at(i).params.at(0).textures().at(0); };
  EXPECT_EQ(ref(0).float_texture, 0);
  EXPECT_EQ(ref(0).spectrum_texture, 1);
  EXPECT_EQ(ref(1).float_texture, 2);
  EXPECT_EQ(ref(1).spectrum_texture, 1);
  EXPECT_EQ(ref(2).float_texture, 0);
  EXPECT_TRUE(parsed.scene().textures[1].spectrum);
  EXPECT_EQ(parsed.scene().textures[1].plugin, "checkerboard");
}

TEST(Scenes, RedefinedTextureDoesNotChangeEarlierMaterials) {
  const Parsed parsed(
      in_world("Texture \"t\" \"spectrum\" \"constant\" Material \"matte\" \"texture Kd\" \"t\" Texture \"t\" "
               "\"spectrum\" \"fbm\" "
               "Material \"matte\" \"texture Kd\" \"t\""));
  EXPECT_EQ(parsed.scene().materials[1].params[0].textures()[0].spectrum_texture, 0);
  EXPECT_EQ(parsed.scene().materials[2].params[0].textures()[0].spectrum_texture, 1);
}

TEST(Scenes, NamedMaterials) {
  const Parsed parsed(in_world(
      "MakeNamedMaterial \"a\" \"string type\" \"glass\" \"float index\" 1.3\nMakeNamedMaterial \"b\" \"string type\" "
      "\"mirror\"\nMaterial \"mix\" \"string namedmaterial1\" \"a\" \"string namedmaterial2\" \"b\" \"string x\" "
      "\"c\"\n"
      "NamedMaterial \"b\" Shape \"s\""));
  expect_clean(parsed);
  const SceneDescription& scene = parsed.scene();
  EXPECT_EQ(scene.materials[1].plugin, "glass");
  EXPECT_EQ(scene.materials[1].name, "a");
  EXPECT_EQ(parsed.sources.location(scene.materials[1].plugin_at), "test.pbrt:2:37");
  ASSERT_EQ(scene.materials[1].params.size(), 1u);  // The type became the plugin.
  EXPECT_EQ(scene.materials[1].params[0].name, "index");
  const std::vector<std::pair<std::string, int>> named = {{"a", 1}, {"b", 2}};
  EXPECT_EQ(scene.materials[3].named, named);
  EXPECT_EQ(scene.shapes[0].material, 2);
}

TEST(Scenes, Objects) {
  const Parsed parsed(
      in_world("ObjectBegin \"o\" Translate 1 0 0 Material \"glass\" Shape \"s\" ObjectEnd\nShape \"s\"\n"
               "Translate 0 2 0 ObjectInstance \"o\"\nObjectBegin \"o\" ObjectEnd ObjectInstance \"o\""));
  expect_clean(parsed);
  const SceneDescription& scene = parsed.scene();
  EXPECT_EQ(scene.shapes[0].object, 0);
  EXPECT_EQ(scene.shapes[1].object, -1);
  EXPECT_EQ(scene.shapes[1].transform, 0);  // ObjectEnd restores like AttributeEnd.
  EXPECT_EQ(scene.shapes[1].material, 0);
  EXPECT_EQ(scene.instances[0].object, 0);
  EXPECT_EQ(transform_point(scene.transforms[static_cast<size_t>(scene.instances[0].transform)].start, {0, 0, 0}),
            Vec3d(0, 2, 0));
  EXPECT_EQ(scene.instances[1].object, 1);  // The name means the later object from then on.
}

TEST(Scenes, Media) {
  const Parsed parsed(
      "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\"\nWorldBegin\nMediumInterface \"fog\" \"\"\n"
      "MediumInterface \"fog\"\nWorldEnd\n");
  expect_clean(parsed);
  EXPECT_EQ(parsed.scene().media.at(0).plugin, "homogeneous");
  EXPECT_EQ(parsed.scene().media_uses.size(), 2u);
  EXPECT_EQ(parsed.sources.location(parsed.scene().first_medium()), "test.pbrt:1:1");
}

TEST(Scenes, MediaThatAreNotThere) {
  // No name is no medium, and one that is put nowhere changes no picture.
  const std::string made = "MakeNamedMedium \"a\" \"string type\" \"homogeneous\"\n";
  for (const std::string& body : {std::string("MediumInterface \"\" \"\""), "MediumInterface \"\"\n" + made}) {
    const Parsed parsed(in_world(body));
    expect_clean(parsed);
    EXPECT_FALSE(parsed.scene().has_media()) << body;
  }
  // Made behind its use, and made again: the last one counts.
  const Parsed late(in_world("MediumInterface \"\" \"a\"\n" + made + made));
  EXPECT_EQ(late.sources.location(late.scene().first_medium()), "test.pbrt:4:1");
}

/// Where the shapes of a world are along x, with the names of their materials and "in" for those in an object.
std::vector<std::string> shapes_of(const SceneDescription& scene) {
  std::vector<std::string> out;
  for (const ShapeDescription& shape : scene.shapes) {
    const Mat4d m = scene.transforms[static_cast<size_t>(shape.transform)].start;
    out.push_back(std::to_string(static_cast<int>(transform_point(m, {0, 0, 0}).x)) + " " +
                  scene.materials[static_cast<size_t>(shape.material)].plugin + (shape.object >= 0 ? " in" : ""));
  }
  return out;
}

/// Begins and ends of blocks that cross, with a shape behind each: what pbrt-v3's two stacks make of it. AttributeBegin
/// and ObjectBegin push graphics state and transform, TransformBegin the transform alone; an end pops what lies on top.
struct CrossingCase {
  const char* statements;  ///< A and a, T and t, O and o: begin and end of an attribute, a transform, an object.
  std::vector<std::string> shapes;
  int warnings = 1;
};

class CrossingBlocks : public testing::TestWithParam<CrossingCase> {};

TEST_P(CrossingBlocks, AreReadAsByPbrtWithAWarning) {
  // Each begin changes both states behind it: the n-th moves by 10^(n-1) and sets the material "mn".
  std::string body;
  int n = 0, distance = 1;
  for (const char* c = GetParam().statements; *c; ++c) {
    const std::string kind = std::strchr("Aa", *c) ? "Attribute" : std::strchr("Tt", *c) ? "Transform" : "Object";
    body += kind + (std::isupper(*c) ? "Begin" : "End") + (*c == 'O' ? " \"o\"\n" : "\n");
    if (std::isupper(*c)) {
      body += "Translate " + std::to_string(distance) + " 0 0\nMaterial \"m" + std::to_string(++n) + "\"\n";
      distance *= 10;
    } else {
      body += "Shape \"s\"\n";
    }
  }
  const Parsed parsed(in_world(body));
  EXPECT_EQ(shapes_of(parsed.scene()), GetParam().shapes) << body;
  EXPECT_EQ(parsed.all().size(), static_cast<size_t>(GetParam().warnings)) << parsed.messages();
  for (const Diagnostic& d : parsed.all()) {
    EXPECT_TRUE(d.excused) << parsed.messages();
    EXPECT_TRUE(d.other.known());
    EXPECT_NE(d.message.find("crosses"), std::string::npos) << d.message;
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, CrossingBlocks,
    testing::Values(
        // A well-known courtyard: the end of the attribute around the object stands before the object's.
        CrossingCase{"AOAaao", {"11 m2 in", "1 m1 in", "0 matte"}}, CrossingCase{"AOao", {"1 m1 in", "0 matte"}},
        CrossingCase{"OAoa", {"1 m1", "0 matte"}}, CrossingCase{"AOAoaa", {"11 m2", "1 m1", "0 matte"}},
        CrossingCase{"ATat", {"1 matte", "0 matte"}}, CrossingCase{"TAta", {"1 m2", "0 m1"}},
        CrossingCase{"OTot", {"1 matte", "0 matte"}}, CrossingCase{"TOto", {"1 m2 in", "0 m1"}},
        // An end before its begin, where another block lends it what it takes.
        CrossingCase{"AtTa", {"0 m1", "0 matte"}}, CrossingCase{"OaAo", {"0 matte in", "0 matte"}},
        // Three blocks, and two pairs one behind the other.
        CrossingCase{"AOTato", {"11 m1 in", "1 m1 in", "0 matte"}, 2},
        CrossingCase{"AOaoAOao", {"1 m1 in", "0 matte", "100 m3 in", "0 matte"}, 2},
        // None crosses.
        CrossingCase{"AOTtoaTAat", {"11 m3 in", "1 m1", "0 matte", "1000 m4", "0 m4"}, 0}));

TEST(Scenes, NamesEndWithTheBlockThatIsPopped) {
  // The first AttributeEnd goes back to what ObjectBegin remembered, where "inner" was not yet known.
  const Parsed parsed(in_world(
      "AttributeBegin MakeNamedMaterial \"outer\" \"string type\" \"glass\" ObjectBegin \"o\"\n"
      "MakeNamedMaterial \"inner\" \"string type\" \"mirror\" AttributeEnd NamedMaterial \"outer\" Shape \"s\"\n"
      "NamedMaterial \"inner\" Shape \"s\" ObjectEnd Shape \"s\""));
  EXPECT_EQ(shapes_of(parsed.scene()), (std::vector<std::string>{"0 glass in", "0 glass in", "0 matte"}));
  EXPECT_EQ(parsed.all().size(), 2u) << parsed.messages();
}

TEST(Scenes, AreaLightInsideAnObject) {
  const Parsed parsed(in_world("ObjectBegin \"o\" AreaLightSource \"diffuse\"\nShape \"s\" Shape \"s\"\nObjectEnd"));
  expect_only(parsed, Severity::Warning, 3, 1, "area light inside an object", "by chance");
}

class Files : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(test::temp_folder()) /
              (std::string("whit_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_ / "sub");
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
    return (folder_ / name).string();
  }
  std::filesystem::path folder_;
  Sources sources_;
};

TEST_F(Files, IncludesAreRelativeToTheMainFileAndShareItsState) {
  const std::string main =
      write("main.pbrt", in_world("Include \"sub/a.pbrt\"\nShape \"s\" AttributeEnd\nInclude \"sub/b.pbrt\""));
  // Found beside the main file, although a.pbrt is in sub.
  write("sub/a.pbrt", "Include \"sub/b.pbrt\"\nAttributeBegin Material \"glass\"");
  write("sub/b.pbrt", "Translate 1 0 0\n");
  const ParseResult result = parse_file(sources_, main);
  ASSERT_TRUE(result.diagnostics.all().empty());
  EXPECT_EQ(result.scenes.at(0).shapes.at(0).material, 1);
  EXPECT_EQ(transform_point(result.scenes[0].transforms[1].start, {0, 0, 0}), Vec3d(1, 0, 0));
  EXPECT_EQ(result.scenes[0].folder, std::filesystem::absolute(folder_).lexically_normal().string());
  EXPECT_EQ(sources_.size(), 3u);  // b.pbrt is open once.
  EXPECT_GT(result.bytes, sources_.text(0).size());
}

TEST_F(Files, ParametersBehindAnIncludeBelongToItsLastStatement) {
  // As in pbrt-v3's clouds: the file holds a grid, the scene says how dense it is.
  const std::string main = write("main.pbrt", in_world("Texture \"t\" \"float\" \"constant\"\n"
                                                       "Include \"a.pbrt\" \"color c\" [1 2 3] \"float r\" 4\n"
                                                       "  \"texture alpha\" \"t\"\nShape \"disk\""));
  write("a.pbrt", "Shape \"cone\"\nInclude \"sub/b.pbrt\"  # the end");
  write("sub/b.pbrt", "Shape \"sphere\" \"float r\" 9 # replaced\n");
  const ParseResult result = parse_file(sources_, main);
  ASSERT_EQ(result.diagnostics.all().size(), 1u);
  EXPECT_EQ(result.diagnostics.all()[0].message, "parameter \"r\" is given twice");
  const auto& shapes = result.scenes.at(0).shapes;
  ASSERT_EQ(shapes.size(), 3u);
  EXPECT_TRUE(shapes[0].params.empty());
  ASSERT_EQ(shapes[1].params.size(), 3u);
  EXPECT_EQ(shapes[1].params[0].numbers(), (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(shapes[1].params[1].numbers(), (std::vector<double>{4}));
  EXPECT_EQ(shapes[1].params[2].textures().at(0).float_texture, 0);
  EXPECT_TRUE(shapes[2].params.empty());
}

TEST_F(Files, ParametersBehindAnIncludeThatTakesNone) {
  const std::string main = write("main.pbrt", in_world("Include \"a.pbrt\" \"float r\" 4\n"
                                                       "Include \"empty.pbrt\" \"float r\" 4"));
  write("a.pbrt", "Translate 1 2 3");
  write("empty.pbrt", "# nothing");
  const ParseResult result = parse_file(sources_, main);
  ASSERT_EQ(result.diagnostics.all().size(), 2u);
  for (size_t i = 0; i < 2; ++i) {
    const Diagnostic& d = result.diagnostics.all()[i];
    EXPECT_EQ(d.severity, Severity::Error);
    EXPECT_EQ(sources_.place(d.where).line, 2 + i);
    EXPECT_NE(d.message.find("no statement to take the parameters"), std::string::npos) << d.message;
  }
}

TEST_F(Files, UnclosedBlockFromAnInclude) {
  const std::string main = write("main.pbrt", in_world("Include \"a.pbrt\""));
  write("a.pbrt", "\nAttributeBegin");
  const ParseResult result = parse_file(sources_, main);
  ASSERT_EQ(result.diagnostics.all().size(), 1u);
  EXPECT_EQ(sources_.location(result.diagnostics.all()[0].where), (folder_ / "a.pbrt").string() + ":2:1");
}

TEST_F(Files, IncludeMistakes) {
  const std::string main = write("main.pbrt", in_world("Include \"none.pbrt\"\nInclude \"a.pbrt\"\nInclude \"bin\""));
  write("a.pbrt", "Include \"b.pbrt\"\nInclude \"a.pbrt\"");
  write("b.pbrt", "Include \"main.pbrt\"");
  write("bin", std::string("\0\0", 2));
  const std::vector<Diagnostic> all = parse_file(sources_, main).diagnostics.all();
  ASSERT_EQ(all.size(), 4u);
  EXPECT_EQ(all[0].error_class, ErrorClass::File);
  EXPECT_NE(all[0].message.find("No such file"), std::string::npos);
  EXPECT_EQ(sources_.place(all[0].where).line, 2u);
  EXPECT_NE(all[1].message.find("includes itself"), std::string::npos);  // By way of a.pbrt and b.pbrt.
  EXPECT_EQ(sources_.name(all[1].where.file), (folder_ / "b.pbrt").string());
  EXPECT_NE(all[2].message.find("includes itself"), std::string::npos);  // a.pbrt, directly.
  EXPECT_EQ(sources_.place(all[2].where).line, 2u);
  EXPECT_NE(all[3].message.find("not a scene file"), std::string::npos);
}

TEST_F(Files, MissingMainFile) {
  const ParseResult result = parse_file(sources_, (folder_ / "no.pbrt").string());
  ASSERT_EQ(result.diagnostics.all().size(), 1u);
  EXPECT_EQ(result.diagnostics.all()[0].error_class, ErrorClass::File);
  EXPECT_FALSE(result.diagnostics.all()[0].where.known());
}

}  // namespace
}  // namespace whit
