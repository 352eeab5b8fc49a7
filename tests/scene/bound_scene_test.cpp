// From statements to plugins: names that pbrt-v3 knows, and which of several values a material takes.
#include "core/scene/bound_scene.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/plugin/registry.h"
#include "parser/lexer.h"
#include "tests/plugin/shading_points.h"
#include "tests/scene/scene_text.h"

namespace whit {
namespace {

/// A parsed and bound scene that may have been warned about.
struct Loose {
  Sources sources;
  ParseResult parsed;
  Diagnostics said;
  BoundScene bound;

  explicit Loose(const std::string& world, const std::string& options = "")
      : parsed(parse_text(sources, "test.pbrt", options + "WorldBegin\n" + world + "\nWorldEnd\n", "")) {
    bound = bind_scene(
        parsed.scenes[0], [this](const Parameter& p, size_t i) { return value_position(sources, p, i); }, said);
  }
  Loose(const Loose&) = delete;
  Loose& operator=(const Loose&) = delete;

  /// The weight of the only lobe of the last shape's material: Kd if it is matte.
  RGB weight() const {
    test::ShadingPoints points(1);
    LobeSet lobes(points.arena);
    bound.materials[static_cast<size_t>(bound.shape_material.back())].plugin->lobes(points.s, lobes);
    EXPECT_EQ(lobes.count, 1);
    return lobes.lobes[0].weight[0];
  }
};

const std::string kRed = "\"rgb Kd\" [0.5 0 0] ", kGreen = "\"rgb Kd\" [0 0.5 0] ",
                  kTexture = "\"texture Kd\" \"blue\" ";
const RGB kIsRed(0.5f, 0, 0), kIsGreen(0, 0.5f, 0), kIsBlue(0, 0, 0.5f);
const std::string kBlue = "Texture \"blue\" \"spectrum\" \"constant\" \"rgb value\" [0 0 0.5]\n";

TEST(BoundScene, NamesThatPbrtKnows) {
  EXPECT_EQ(find_plugin("area light", "area"), find_plugin("area light", "diffuse"));
  EXPECT_EQ(find_plugin("light", "exinfinite"), find_plugin("light", "infinite"));
}

TEST(BoundScene, NoNameIsAsUnknownAsAnyOther) {
  // Such a statement once counted as none, and the default plugin was then looked for by the name that it has not.
  for (const std::string name : {"", "nobody"}) {
    const std::string named = " \"" + name + "\"\n";
    const Loose scene("Shape \"sphere\"", "Sampler" + named + "Integrator" + named + "PixelFilter" + named);
    EXPECT_TRUE(scene.bound.sampler.plugin && scene.bound.sampler.replaced);
    EXPECT_TRUE(scene.bound.integrator.plugin && scene.bound.integrator.replaced);
    EXPECT_TRUE(scene.bound.filter.plugin);
    EXPECT_EQ(scene.said.all().size(), 3u);
    EXPECT_FALSE(scene.said.has_errors());
  }
}

TEST(BoundScene, AShapesParametersGoBeforeItsMaterials) {
  // pbrt-v3 asks the shape first, for a texture and then for a value, and then the material in the same way.
  const auto weight = [](const std::string& material, const std::string& shape) {
    return Loose(kBlue + "Material \"matte\" " + material + "\nShape \"sphere\" " + shape).weight();
  };
  EXPECT_EQ(weight(kRed, ""), kIsRed);
  EXPECT_EQ(weight(kRed, kGreen), kIsGreen);
  EXPECT_EQ(weight(kRed, kTexture), kIsBlue);
  EXPECT_EQ(weight(kTexture, kGreen), kIsGreen);
  EXPECT_EQ(weight(kRed + kTexture, ""), kIsBlue);
  EXPECT_EQ(weight(kRed, kGreen + kTexture), kIsBlue);
  // A value of another type is not one.
  EXPECT_EQ(weight(kRed, "\"float Kd\" 0.3"), kIsRed);
}

TEST(BoundScene, AnUnknownMaterialBecomesMatteOfItsColour) {
  const Loose scene("Material \"velvet\" " + kRed + "\"float gloss\" 2\nShape \"sphere\"");
  EXPECT_EQ(scene.weight(), kIsRed);
  ASSERT_EQ(scene.said.all().size(), 1u);
  EXPECT_EQ(scene.said.all()[0].severity, Severity::Warning);
  EXPECT_EQ(Loose("Material \"velvet\" " + kRed + "\nShape \"sphere\" " + kGreen).weight(), kIsGreen);
}

TEST(BoundScene, AnUnknownIntegratorIsSaidWithItsHintOnALineOfItsOwn) {
  const auto remedy = [](const std::string& name) {
    Sources sources;
    const ParseResult parsed =
        parse_text(sources, "test.pbrt", "Integrator \"" + name + "\"\nWorldBegin\nWorldEnd\n", "");
    Diagnostics said;
    bind_scene(parsed.scenes[0], {}, said);
    EXPECT_EQ(said.all().size(), 1u);
    return said.all().empty() ? "" : said.all()[0].remedy;
  };
  EXPECT_EQ(remedy("mypath"), "the picture is made with whitted\ndid you mean \"path\"?");
  EXPECT_EQ(remedy("wited"), "the picture is made with whitted\ndid you mean \"whitted\"?");
  EXPECT_EQ(remedy("photonmap"), "the picture is made with whitted");
  EXPECT_EQ(remedy("volpath"), "the picture is made with path");
  Sources sources;
  EXPECT_EQ(sources.render_diagnostic({Severity::Warning, ErrorClass::Scene, {}, "a", "b\nc"}, false),
            "warning: a\n  b\n  c\n");
}

TEST(BoundScene, AFilterThatDoesNotFitIntoMemoryIsAMistakeAtItsPlace) {
  const auto said_of = [](const std::string& filter) {
    Sources sources;
    const ParseResult parsed = parse_text(
        sources, "test.pbrt",
        "Film \"image\" \"integer xresolution\" 64 \"integer yresolution\" 64\n" + filter + "\nWorldBegin WorldEnd\n",
        "");
    Diagnostics said;
    bind_scene(
        parsed.scenes[0], [&](const Parameter& p, size_t i) { return value_position(sources, p, i); }, said);
    std::string text;
    for (const Diagnostic& d : said.all()) text += sources.render_diagnostic(d, false);
    return text;
  };
  // Tiles of 16 x 16 with borders of 20: (104 / 16)^2 = 49 of 56 x 56 sums.
  EXPECT_EQ(said_of("PixelFilter \"box\" \"float xwidth\" 20 \"float ywidth\" 20"), "");
  // (64 + 2e5) / 16 = 12504 by 5 tiles of (16 + 2e5) x 17 sums of 32 bytes: 6.8e12 bytes. The figures to widths of 3e38
  // must be as finite as this.
  for (const char* width : {"1e5", "3e9", "3e38"}) {
    for (const char* filter : {"box", "gaussian", "mitchell", "sinc", "triangle"}) {
      const std::string said =
          said_of(fmt::format("PixelFilter \"{}\" \"float ywidth\" .5 \"float xwidth\" {}", filter, width));
      const size_t column = 49 + std::string(filter).size();
      EXPECT_EQ(said.find(fmt::format("test.pbrt:2:{}: error: a filter of radius ", column)), 0u) << said;
      EXPECT_NE(said.find(" GiB of memory for 64 x 64 pixels"), std::string::npos) << said;
    }
  }
}

}  // namespace
}  // namespace whit
