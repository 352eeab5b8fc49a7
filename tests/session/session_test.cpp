// The steps from a file to a picture: what each says when it fails, and one world rendered more than once.
#include "core/session/session.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <vector>

#include "core/session/output.h"
#include "tests/base/temp_folder.h"

namespace whit {
namespace {

/// A lamp over a ball, 16 x 16 pixels.
std::string ball(const std::string& options, const std::string& material = "") {
  return options +
         "\nLookAt 0 0 5  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 40\nWorldBegin\n"
         "LightSource \"point\" \"point from\" [1 2 5] \"rgb I\" [25 25 25]\n" +
         material + "\nShape \"sphere\"\nWorldEnd\n";
}

constexpr const char* kFilm = "Film \"image\" \"integer xresolution\" 16 \"integer yresolution\" 16";

PlannedWorld plan(const ParsedFile& file) { return plan_world(file.worlds.at(0), *file.sources); }

/// "scene error at 1:1", "file error" and the like, of all errors.
std::vector<std::string> errors(const Diagnostics& said, const Sources& sources) {
  std::vector<std::string> out;
  for (const Diagnostic& d : said.all()) {
    if (d.severity != Severity::Error) continue;
    const SourcePlace p = sources.place(d.where);
    const char* kind = d.error_class == ErrorClass::Scene  ? "scene"
                       : d.error_class == ErrorClass::File ? "file"
                                                           : "usage";
    out.push_back(fmt::format("{} error", kind) + (d.where.known() ? fmt::format(" at {}:{}", p.line, p.column) : ""));
  }
  return out;
}
using Errors = std::vector<std::string>;

TEST(Session, ParsingAndPlanningSayWhatIsWrongAndWhere) {
  const ParsedFile missing = read_scene_file(test::temp_folder() + "/none.pbrt");
  EXPECT_EQ(errors(missing.said, *missing.sources), Errors{"file error"});
  EXPECT_TRUE(missing.worlds.empty());
  const ParsedFile unread = read_scene_text("t", "WorldBegin\nShape \"sphere\" \"float radius\" [x]\nWorldEnd");
  EXPECT_EQ(errors(unread.said, *unread.sources), Errors{"scene error at 2:32"});
  // The parser knows no plugins; planning does.
  const ParsedFile file = read_scene_text("t", "WorldBegin\nShape \"sphere\" \"float radius\" [-1]\nWorldEnd");
  EXPECT_TRUE(file.said.all().empty());
  EXPECT_EQ(errors(plan(file).said, *file.sources).size(), 1u);
  EXPECT_EQ(errors(all_problems(file), *file.sources).size(), 1u);
}

TEST(Session, WhatCannotBeWrittenIsToldApart) {
  const auto planned_output = [](const std::string& film, const OutputRequest& request) {
    const ParsedFile file = read_scene_text("t", ball(kFilm + film));
    return errors(plan_output(request, plan(file).bound.film).said, *file.sources);
  };
  const std::string nowhere = test::temp_folder() + "/none/a.exr", here = test::temp_folder() + "/a.exr";
  const auto request = [](const std::string& outfile, const std::string& view) {
    OutputRequest r;
    r.outfile = outfile, r.view = view;
    return r;
  };
  EXPECT_EQ(planned_output("", request(here, "")), Errors{});
  EXPECT_EQ(planned_output("", request(nowhere, "")), Errors{"file error"});
  EXPECT_EQ(planned_output(" \"string filename\" \"" + nowhere + "\"", {}), Errors{"file error at 1:1"});
  EXPECT_EQ(planned_output("", request(here, "no such view")), Errors{"usage error"});
  EXPECT_EQ(planned_output(" \"string view\" \"no such view\"", request(here, "")), Errors{"scene error at 1:1"});
}

TEST(Session, PicturesAreWrittenUnderBothNames) {
  const ParsedFile file = read_scene_text("t", ball(kFilm));
  PlannedWorld planned = plan(file);
  OutputRequest request;
  request.outfile = test::temp_folder() + "/both.exr";
  const OutputPlan output = plan_output(request, planned.bound.film);
  const RenderedWorld rendered = render_world(build_world(std::move(planned)));
  EXPECT_TRUE(rendered.said.all().empty());
  EXPECT_TRUE(write_output(output, rendered.result, {}).said.all().empty());
  EXPECT_TRUE(std::filesystem::exists(request.outfile));
  EXPECT_TRUE(std::filesystem::exists(test::temp_folder() + "/both.png"));
}

TEST(Session, ATextureThatCannotBeDecodedEndsARenderUnlessItIsToGoOn) {
  // A PNG of which the second half is missing: its header is in order, so that only looking it up shows it.
  const std::string path = test::temp_folder() + "/half.png";
  std::vector<float> noise(3 * 64 * 64);
  for (size_t i = 0; i < noise.size(); ++i) noise[i] = static_cast<float>(i * 7919 % 251) / 251;
  ASSERT_TRUE(write_image(path, {.width = 64, .height = 64, .rgb = noise}).ok());
  std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
  const ParsedFile file =
      read_scene_text("t", ball(kFilm, "Texture \"t\" \"color\" \"imagemap\" \"string filename\" \"" + path +
                                           "\"\nMaterial \"matte\" \"texture Kd\" \"t\""));
  for (const bool keep_going : {false, true}) {
    BuildOptions options;
    options.keep_going = keep_going;
    const BuiltWorld built = build_world(plan(file), options);
    ASSERT_TRUE(built.scene);
    EXPECT_TRUE(built.said.all().empty());
    const RenderedWorld rendered = render_world(built);
    EXPECT_EQ(errors(rendered.said, *file.sources), Errors{"file error at 6:50"});
    if (keep_going) { EXPECT_TRUE(rendered.result.complete); }
  }
}

TEST(Session, AWorldIsRenderedWithOtherSamplesAsIfItHadBeenBuiltWithThem) {
  for (const char* sampler :
       {"\"halton\" \"integer pixelsamples\" 4", "\"sobol\" \"integer pixelsamples\" 4",
        "\"02sequence\" \"integer pixelsamples\" 4", "\"maxmindist\" \"integer pixelsamples\" 4",
        "\"random\" \"integer pixelsamples\" 4", "\"stratified\" \"integer xsamples\" 1 \"integer ysamples\" 4"}) {
    const ParsedFile file = read_scene_text("t", ball(std::string(kFilm) + "\nSampler " + sampler));
    const auto built_with = [&](int samples, uint32_t seed) {
      BuildOptions options;
      options.samples_per_pixel = samples, options.seed = seed;
      return render_world(build_world(plan(file), options)).result.picture.rgb;
    };
    BuiltWorld world = build_world(plan(file));
    // 4 last: the grid of 1 x 4 that the scene declares must come back.
    for (const auto& [samples, seed] : std::vector<std::pair<int, uint32_t>>{{9, 0}, {2, 5}, {4, 1}, {4, 0}}) {
      EXPECT_TRUE(set_samples(world, samples, seed).all().empty());
      const std::vector<float> rgb = render_world(world).result.picture.rgb;
      EXPECT_EQ(rgb, built_with(samples, seed)) << sampler << ' ' << samples << ' ' << seed;
      EXPECT_EQ(rgb, render_world(world).result.picture.rgb) << "rendering changes nothing";
    }
  }
}

TEST(Session, FootprintsAreOfTheNumberOfSamplesThatTheSceneAsksFor) {
  const ParsedFile file =
      read_scene_text("t", ball(std::string(kFilm) + "\nSampler \"maxmindist\" \"integer pixelsamples\" 9"));
  const auto footprint = [&](BuildOptions options) {
    BuiltWorld world = build_world(plan(file), options);
    const int built = world.scene->footprint_samples;
    EXPECT_TRUE(set_samples(world, 64, 1).all().empty());
    EXPECT_EQ(world.scene->samples_per_pixel, 64);
    EXPECT_EQ(world.scene->footprint_samples, built);
    return built;
  };
  EXPECT_EQ(footprint({}), 16) << "as the sampler rounds it";
  EXPECT_EQ(footprint({.samples_per_pixel = 1}), 16);
  EXPECT_EQ(footprint({.quick = true}), 16);
  EXPECT_EQ(footprint({.footprint_samples = 3}), 3);
  EXPECT_EQ(footprint({.samples_per_pixel = 1, .footprint_samples = 3, .quick = true}), 3);
}

}  // namespace
}  // namespace whit
