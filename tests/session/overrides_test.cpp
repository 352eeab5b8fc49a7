// What stands instead of a scene's statements: that it is in force, and that the rest is as the scene says.
#include "core/session/overrides.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "core/image/write.h"
#include "core/plugin/registry.h"
#include "tests/base/temp_folder.h"

namespace whit {
namespace {

constexpr const char* kFilm = "Film \"image\" \"integer xresolution\" 16 \"integer yresolution\" 16\n";

/// A square that fills the view of 16 x 16 pixels, u to the right and v up.
std::string square(const std::string& options, const std::string& world) {
  return kFilm + options + "\nCamera \"orthographic\"\nWorldBegin\n" + world +
         "\nTranslate 0 0 5\nShape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] "
         "\"point P\" [-1 -1 0  1 -1 0  1 1 0  -1 1 0] \"float uv\" [0 0 1 0 1 1 0 1]\nWorldEnd\n";
}
const std::string kMirror = "LightSource \"infinite\" \"rgb L\" [1 1 1]\nMaterial \"mirror\" \"rgb Kr\" [.5 .5 .5]";

ParsedFile read(const std::string& text, const Overrides& overrides, const std::string& problem = "") {
  ParsedFile file = read_scene_text("t", text);
  EXPECT_EQ(usage_problem(overrides), "");
  EXPECT_EQ(override_worlds(file, overrides), problem);
  return file;
}

PlannedWorld plan(const ParsedFile& file, size_t world = 0) { return plan_world(file.worlds.at(world), *file.sources); }

/// The picture of a file's only world, which nothing is said of.
std::vector<float> picture(const ParsedFile& file) {
  PlannedWorld planned = plan(file);
  EXPECT_TRUE(planned.said.all().empty()) << planned.said.all().front().message;
  return render_world(build_world(std::move(planned))).result.picture.rgb;
}
std::vector<float> picture(const std::string& text, const Overrides& overrides) {
  return picture(read(text, overrides));
}

/// Overrides of which one is given.
template <class T, class V>
Overrides with(T Overrides::*member, V value) {
  Overrides o;
  o.*member = value;
  return o;
}

TEST(Overrides, MaxdepthIsThatOfTheIntegratorInForce) {
  // A mirror that reflects half of white light shows 0.5 where there is a second round of rays, and nothing where not.
  // A path that ends after 0 bounces is black as well; after one it has met the light.
  for (const char* scene : {"Integrator \"whitted\" \"integer maxdepth\" 9", "Integrator \"directlighting\"", ""}) {
    const std::string text = square(scene, kMirror);
    for (const float v : picture(text, with(&Overrides::max_depth, 1))) ASSERT_EQ(v, 0) << scene;
    for (const float v : picture(text, with(&Overrides::max_depth, 2))) ASSERT_NEAR(v, 0.5f, 1e-6f) << scene;
    Overrides path = with(&Overrides::max_depth, 0);
    path.integrator = "path";
    for (const float v : picture(text, path)) ASSERT_EQ(v, 0) << scene;
    path.max_depth = 1;
    for (const float v : picture(text, path)) ASSERT_NEAR(v, 0.5f, 1e-6f) << scene;
  }
  // One that is not simulated is replaced by path, whose depth it is then.
  ParsedFile file = read(square("Integrator \"bdpt\"", kMirror), with(&Overrides::max_depth, 0));
  for (const float v : render_world(build_world(plan(file))).result.picture.rgb) ASSERT_EQ(v, 0);
}

TEST(Overrides, WhatTheIntegratorInForceDoesNotHaveIsAProblem) {
  const Overrides depth = with(&Overrides::max_depth, 3), roulette = with(&Overrides::rr_threshold, 0.5);
  const std::string no_threshold = "--rrthreshold: integrator \"whitted\" has no parameter \"rrthreshold\"; path has";
  read(square("", kMirror), roulette, no_threshold);
  read(square("Integrator \"whitted\"", kMirror), roulette, no_threshold);
  read(square("Integrator \"ambientocclusion\"", ""), depth,
       "--maxdepth: integrator \"ambientocclusion\" has no parameter \"maxdepth\"; directlighting, path, whitted have");
  // The second world's.
  const std::string path = square("Integrator \"path\"", kMirror);
  read(path + square("Integrator \"whitted\"", kMirror), roulette, no_threshold);
  Overrides both = roulette;
  both.integrator = "path";
  read(square("", kMirror), both);
  read(square("", kMirror), with(&Overrides::max_depth, 2000000),
       "--maxdepth: maxdepth must be at most 1e+06, not 2000000");
  const ParsedFile file = read(path, roulette);
  ASSERT_EQ(file.worlds[0].integrator.params.size(), 1u);
  EXPECT_EQ(file.worlds[0].integrator.params[0].name, "rrthreshold");
  EXPECT_EQ(file.worlds[0].integrator.params[0].numbers(), std::vector<double>{0.5});
}

TEST(Overrides, TheLastOfAParameterIsReplacedToo) {
  const std::string twice = "Integrator \"whitted\" \"integer maxdepth\" 4 \"integer maxdepth\" 5";
  for (const float v : picture(square(twice, kMirror), with(&Overrides::max_depth, 1))) ASSERT_EQ(v, 0);
}

TEST(Overrides, AnotherSamplerTakesAsManySamples) {
  struct Case {
    const char *statement, *name;
    int samples;
  };
  for (const Case& c : {Case{"Sampler \"halton\" \"integer pixelsamples\" 12", "random", 12},
                        {"Sampler \"halton\" \"integer pixelsamples\" 12", "stratified", 12},  // 3 x 4
                        {"Sampler \"halton\" \"integer pixelsamples\" 7", "stratified", 7},    // 1 x 7
                        {"Sampler \"stratified\" \"integer xsamples\" 3 \"integer ysamples\" 5", "halton", 15},
                        {"Sampler \"stratified\" \"integer xsamples\" 2 \"integer ysamples\" 8", "sobol", 16},
                        {"Sampler \"stratified\" \"integer ysamples\" 2", "random", 8},  // 4 across by default
                        {"Sampler \"lowdiscrepancy\" \"integer pixelsamples\" 32", "maxmindist", 32},
                        {"Sampler \"adaptive\" \"integer pixelsamples\" 9", "random", 9},  // halton stands in
                        {"Sampler \"random\" \"integer pixelsamples\" 5000000", "stratified", 1 << 22},  // its most
                        {"", "random", 16},  // the default's, not its own
                        {"Sampler \"random\"", "halton", 4}}) {
    const ParsedFile file = read(square(c.statement, kMirror), with(&Overrides::sampler, c.name));
    EXPECT_EQ(sampler_in_force(file.worlds[0]).name, c.name);
    const PlannedWorld planned = plan(file);
    EXPECT_TRUE(planned.said.all().empty()) << c.statement;
    EXPECT_EQ(planned.bound.sampler.plugin->samples_per_pixel(), c.samples) << c.statement << ' ' << c.name;
  }
}

TEST(Overrides, ASamplerThatIsInForceAlreadyStaysAsItIs) {
  const char* own = "Sampler \"stratified\" \"integer xsamples\" 1 \"integer ysamples\" 8 \"bool jitter\" \"false\"";
  EXPECT_EQ(picture(square(own, kMirror), with(&Overrides::sampler, "stratified")), picture(square(own, kMirror), {}));
  const ParsedFile file = read(square(own, kMirror), with(&Overrides::sampler, "stratified"));
  EXPECT_EQ(file.worlds[0].sampler.params.size(), 3u);
  EXPECT_TRUE(plan(file).bound.sampler.plugin->is_regular());
}

TEST(Overrides, AnotherSamplerChangesPixelsAndKeepsTheMean) {
  // A ball before black, whose rim is in the pixels, so that these depend on where samples fall.
  const std::string text = std::string(kFilm) + "Sampler \"sobol\" \"integer pixelsamples\" 64\nWorldBegin\n" +
                           "LightSource \"point\" \"rgb I\" [9 9 9]\nTranslate 0 0 3\nShape \"sphere\"\nWorldEnd\n";
  const std::vector<float> own = picture(text, {}), other = picture(text, with(&Overrides::sampler, "random"));
  EXPECT_NE(own, other);
  const auto mean = [](const std::vector<float>& v) {
    return std::accumulate(v.begin(), v.end(), 0.0) / static_cast<double>(v.size());
  };
  // Samples of 256 pixels, 64 each: the standard deviation of their mean is at most half the brightest over 128.
  EXPECT_NEAR(mean(other), mean(own), 4 * 0.5 * static_cast<double>(*std::max_element(own.begin(), own.end())) / 128);
}

TEST(Overrides, ASamplerWhoseStatementIsWrongIsAnErrorAsEver) {
  const ParsedFile file =
      read(square("Sampler \"halton\" \"integer pixelsamples\" -1", kMirror), with(&Overrides::sampler, "random"));
  EXPECT_TRUE(plan(file).said.has_errors());
}

/// A picture of 16 x 16 numbers from 0 to 1, and its path.
std::vector<float> texels(std::string& path) {
  path = test::temp_folder() + "/texels.pfm";
  std::vector<float> rgb(16 * 16 * 3);
  for (size_t i = 0; i < rgb.size(); ++i) rgb[i] = static_cast<float>(i * 7919 % 257) / 256;
  EXPECT_TRUE(write_image(path, {.width = 16, .height = 16, .rgb = rgb}).ok());
  return rgb;
}

TEST(Overrides, PointFilteredTexturesGiveTheirTexels) {
  std::string path;
  const std::vector<float> rgb = texels(path);
  const auto text = [&](const std::string& filter) {
    return square(
        "Sampler \"random\" \"integer pixelsamples\" 4",
        "LightSource \"infinite\" \"rgb L\" [1 1 1]\nTexture \"t\" \"color\" \"imagemap\" \"string filename\" \"" +
            path + "\" " + filter + "\nMaterial \"mirror\" \"texture Kr\" \"t\"");
  };
  // A texel fills a pixel, so that every sample of the pixel, wherever it is, reflects white times that texel.
  for (const char* own : {"", "\"bool trilinear\" \"true\"", "\"string filter\" \"trilinear\""}) {
    const std::vector<float> got = picture(text(own), with(&Overrides::texture_filter, "point"));
    for (size_t i = 0; i < rgb.size(); ++i) ASSERT_NEAR(got[i], rgb[i], 1e-6f) << own << ' ' << i;
  }
  const std::vector<float> ewa = picture(text(""), {}), trilinear = picture(text("\"bool trilinear\" \"true\""), {});
  const std::vector<float> point = picture(text("\"string filter\" \"point\""), {});
  EXPECT_NE(ewa, trilinear);
  EXPECT_NE(ewa, point);
  EXPECT_NE(trilinear, point);
  // As the parameters ask for.
  EXPECT_EQ(picture(text("\"string filter\" \"ewa\""), {}), ewa);
  EXPECT_EQ(picture(text("\"string filter\" \"trilinear\""), {}), trilinear);
  EXPECT_EQ(picture(text("\"bool trilinear\" \"true\" \"string filter\" \"point\""), {}), point);
  EXPECT_EQ(picture(text(""), with(&Overrides::texture_filter, "trilinear")), trilinear);
  EXPECT_EQ(picture(text("\"bool trilinear\" \"true\""), with(&Overrides::texture_filter, "ewa")), ewa);
}

TEST(Overrides, PointFilteredTexturesCallForNoFootprints) {
  std::string path;
  texels(path);
  const std::string map = "\"color\" \"imagemap\" \"string filename\" \"" + path + "\"";
  const std::string text =
      square("", "Texture \"t\" " + map + "\nTexture \"s\" \"color\" \"scale\" \"texture tex1\" \"t\"\n" +
                     "Material \"matte\" \"texture Kd\" \"s\"\nLightSource \"distant\"");
  EXPECT_TRUE(plan(read(text, {})).plan.live(Effect::TextureFiltering));
  EXPECT_TRUE(plan(read(text, with(&Overrides::texture_filter, "trilinear"))).plan.live(Effect::TextureFiltering));
  const ParsedFile file = read(text, with(&Overrides::texture_filter, "point"));
  EXPECT_FALSE(plan(file).plan.live(Effect::TextureFiltering));
  EXPECT_TRUE(plan(file).plan.live(Effect::Textures));
}

TEST(Overrides, AllWorldsOfAFileAreOverridden) {
  Overrides o = with(&Overrides::max_depth, 1);
  o.sampler = "random", o.integrator = "whitted";
  const ParsedFile file = read(square("Integrator \"path\"", kMirror) + square("", kMirror), o);
  ASSERT_EQ(file.worlds.size(), 2u);
  for (size_t world = 0; world < 2; ++world) {
    EXPECT_EQ(integrator_in_force(file.worlds[world]).name, "whitted");
    EXPECT_EQ(sampler_in_force(file.worlds[world]).name, "random");
    for (const float v : render_world(build_world(plan(file, world))).result.picture.rgb) ASSERT_EQ(v, 0);
  }
}

TEST(Overrides, VariantsOfAWorldLeaveItAsItWas) {
  std::string path;
  texels(path);
  ParsedFile file = read(
      square("",
             "LightSource \"infinite\" \"rgb L\" [1 1 1]\nTexture \"t\" \"color\" \"imagemap\" \"string filename\" \"" +
                 path + "\"\nMaterial \"mirror\" \"texture Kr\" \"t\""),
      {});
  Overrides o = with(&Overrides::max_depth, 3);
  o.sampler = "random", o.texture_filter = "point";
  const std::vector<float> own = picture(file);
  const auto build_variant = [&] {
    const ScopedOverrides scope(file.worlds[0], o);
    EXPECT_EQ(scope.problem(), "");
    return build_world(plan(file));
  };
  const BuiltWorld variant = build_variant();
  EXPECT_EQ(picture(file), own);
  // It keeps what it was built with.
  ParsedFile overridden = read_scene_text("t", std::string());
  overridden.worlds.push_back(file.worlds[0]);
  EXPECT_EQ(override_worlds(overridden, o), "");
  EXPECT_EQ(render_world(variant).result.picture.rgb, picture(overridden));
  EXPECT_NE(picture(overridden), own);
  o.rr_threshold = 1;
  EXPECT_NE(ScopedOverrides(file.worlds[0], o).problem(), "");
  EXPECT_EQ(picture(file), own);
}

TEST(Overrides, NamesThatNobodyHasAreTold) {
  EXPECT_EQ(usage_problem({}), "");
  EXPECT_EQ(usage_problem(with(&Overrides::integrator, "pth")),
            "--integrator: there is no integrator \"pth\"; did you mean \"path\"?");
  EXPECT_EQ(usage_problem(with(&Overrides::sampler, "sobel")),
            "--sampler: there is no sampler \"sobel\"; did you mean \"sobol\"?");
  EXPECT_EQ(usage_problem(with(&Overrides::texture_filter, "Trilinear")),
            "--texture-filter: there is no filter \"Trilinear\"; did you mean \"trilinear\"?");
  EXPECT_EQ(usage_problem(with(&Overrides::texture_filter, "box")),
            "--texture-filter: there is no filter \"box\"; there are ewa, trilinear, point");
}

}  // namespace
}  // namespace whit
