// Rendering to an accuracy or to a time.

#include "core/accuracy/target.h"

#include <gtest/gtest.h>

#include <numeric>

namespace whit {
namespace {

/// A ball on a floor under a small lamp and a wide one, on the left; black on the right.
struct World {
  ParsedFile file;
  BuiltWorld built;
};
World world(const std::string& sampler = "sobol", const std::string& filter = "gaussian") {
  World out;
  out.file = read_scene_text("scene",
                             "Film \"image\" \"integer xresolution\" [64] \"integer yresolution\" [40]\n"
                             "Camera \"perspective\" \"float fov\" [50]\nPixelFilter \"" +
                                 filter + "\"\nSampler \"" + sampler +
                                 "\" WorldBegin\n"
                                 "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [20 20 20] Translate 0 4 4\n"
                                 "Rotate 90 1 0 0 Shape \"disk\" \"float radius\" [1] AttributeEnd\n"
                                 "Material \"matte\" Translate -1 0 5 Shape \"sphere\"\n"
                                 "Translate 0 -1 0 Rotate 90 1 0 0 Shape \"disk\" \"float radius\" [3] WorldEnd\n");
  out.built = build_world(plan_world(out.file.worlds.at(0), *out.file.sources));
  return out;
}

TargetOutcome render(double error, int threads = 2, const std::string& sampler = "sobol", uint32_t most = 1 << 16) {
  World w = world(sampler);
  TargetRequest request;
  request.error = error, request.max_samples = most;
  RenderOptions options;
  options.threads = threads;
  options.aovs.names = {"variance", "samples"};
  options.aovs.place = [](SourcePos) { return std::string(); };
  return render_to_target(w.built, options, request, 0);
}

TEST(Target, IsMetWithMoreSamplesWhereTheNoiseIs) {
  const TargetOutcome o = render(0.004);
  ASSERT_EQ(o.end, TargetEnd::Met);
  EXPECT_LE(o.claim.high, 0.004);
  EXPECT_LT(o.claim.value, o.claim.high);
  EXPECT_GT(o.rendered.result.samples_per_pixel, 16);
  const std::vector<float>& samples = o.rendered.result.aovs.channels.back().values;
  const float least = *std::min_element(samples.begin(), samples.end());
  const float most = *std::max_element(samples.begin(), samples.end());
  EXPECT_GE(most, 8 * least);
  EXPECT_LE(most, 64 * least);  // those that have least follow those that have most
}

TEST(Target, IsTheSamePictureForAnyThreads) {
  const TargetOutcome one = render(0.004, 1), three = render(0.004, 3);
  EXPECT_EQ(one.rendered.result.picture.rgb, three.rendered.result.picture.rgb);
  EXPECT_EQ(one.claim.high, three.claim.high);
}

TEST(Target, IsMetWithSamplersThatHaveSets) {
  for (const char* sampler : {"stratified", "halton", "maxmindist", "random"})
    EXPECT_EQ(render(0.01, 2, sampler).end, TargetEnd::Met) << sampler;
}

TEST(Target, EndsWithTheMostSamples) {
  const TargetOutcome o = render(1e-5, 2, "sobol", 128);
  EXPECT_EQ(o.end, TargetEnd::Samples);
  EXPECT_GT(o.claim.low, 1e-5);
  EXPECT_LE(o.rendered.result.samples_per_pixel, 128);
}

TEST(Target, DoubtedPixelsHaveNoKnownVariance) {
  const TargetOutcome o = render(0.01);
  const std::vector<float>& variance = o.rendered.result.aovs.channels.front().values;
  for (size_t p = 0; p < variance.size(); ++p) EXPECT_EQ(std::isinf(variance[p]), o.doubts.pixels[p] != 0);
}

TEST(Target, EndsInTimeAndTellsHowLongAPictureTakesToWrite) {
  World w = world();
  TargetRequest request;
  const auto start = std::chrono::steady_clock::now();
  request.deadline = start + std::chrono::milliseconds(1500);
  int written = 0;
  request.first_picture = [&](const RenderResult& r) {
    for (const float v : r.picture.rgb) EXPECT_GE(v, 0);
    ++written;
    return 0.2;
  };
  const TargetOutcome o = render_to_target(w.built, {}, request, 0);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  EXPECT_EQ(o.end, TargetEnd::Time);
  EXPECT_EQ(written, 1);
  EXPECT_GT(o.rendered.result.samples_per_pixel, 4);
  // A fifth of a second of it and a bit is left for writing; twice that for a machine that does other things.
  EXPECT_LT(seconds, 3);
}

TEST(Target, OfAFilmWithoutPixelsIsNothing) {
  for (const double error : {0.0, 0.01}) {
    World w = world("sobol", "box");
    TargetRequest request;
    request.error = error;
    request.deadline = std::chrono::steady_clock::now() + std::chrono::seconds(1);
    RenderOptions options;
    options.crop_given = true;
    // Between the left ends of the first two pixels, of which ceil(64 x) is 1 both times.
    options.crop[0] = 0.001, options.crop[1] = 0.0015;
    const TargetOutcome o = render_to_target(w.built, options, request, 0);
    EXPECT_NE(o.end, TargetEnd::Met);
    EXPECT_EQ(o.rendered.result.samples_per_pixel, 0);
    EXPECT_TRUE(std::isinf(o.claim.value));
  }
}

TEST(Target, IsStoppedByProgress) {
  World w = world();
  TargetRequest request;
  request.error = 1e-6;
  request.progress = [](const TargetState& s) { return s.samples_mean < 64; };
  const TargetOutcome o = render_to_target(w.built, {}, request, 0);
  EXPECT_EQ(o.end, TargetEnd::Stopped);
}

}  // namespace
}  // namespace whit
