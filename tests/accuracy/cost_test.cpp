// Whether a study finds what is known of a scene: its error, its bias, what its effects change, and what it cannot say.
#include "core/accuracy/cost.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace whit {
namespace {

constexpr int kSide = 32;

/// A square picture in which a world unit is half a side, seen along z without perspective.
std::string square(const std::string& options, const std::string& world, int side = kSide) {
  return fmt::format(
      "Film \"image\" \"integer xresolution\" {0} \"integer yresolution\" {0} \"string filename\" \"x.exr\"\n"
      "PixelFilter \"box\"\n{1}\nCamera \"orthographic\"\nWorldBegin\n{2}\nWorldEnd\n",
      side, options, world);
}

constexpr const char* kSky = "LightSource \"infinite\" \"rgb L\" [1 1 1]\n";

/// Rectangles at depth z.
class Rectangles {
 public:
  void add(double x0, double x1, double y0, double y1) {
    points_ += fmt::format("{0} {2} 5 {1} {2} 5 {1} {3} 5 {0} {3} 5 ", x0, x1, y0, y1);
    indices_ += fmt::format("{0} {1} {2} {0} {2} {3} ", 4 * n_, 4 * n_ + 1, 4 * n_ + 2, 4 * n_ + 3);
    ++n_;
  }
  std::string shape() const {
    return fmt::format("Shape \"trianglemesh\" \"point P\" [{}] \"integer indices\" [{}]\n", points_, indices_);
  }

 private:
  std::string points_, indices_;
  int n_ = 0;
};

/// A black surface that emits 1 covers a quarter of each pixel, nothing the rest.
std::string stripes() {
  Rectangles stripes;
  for (int i = 0; i < kSide; ++i) {
    const double left = -1 + 2.0 * i / kSide;
    stripes.add(left, left + 0.25 * 2 / kSide, -1, 1);
  }
  return "Material \"matte\" \"rgb Kd\" [0 0 0]\n"
         "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] \"bool twosided\" \"true\"\n" +
         stripes.shape();
}

/// A mirror over the left half of the picture, before a sky of radiance 1.
std::string half_mirror() {
  Rectangles half;
  half.add(-1, 0, -1, 1);
  return kSky + std::string("Material \"mirror\" \"rgb Kr\" [1 1 1]\n") + half.shape();
}

struct Asked {
  double seconds = 1.5;
  bool quick = true;
  std::function<bool(double, const std::string&)> progress = {};
};

CostStudy study(const std::string& text, const Asked& asked = {}) {
  ParsedFile file = read_scene_text("test", text);
  EXPECT_FALSE(file.said.has_errors());
  CostRequest request;
  request.seconds = asked.seconds, request.quick = asked.quick, request.progress = asked.progress;
  request.scene_path = "a scene.pbrt";
  return study_cost(file, 0, request);
}

bool says(const CostReport& report, const std::string& words) {
  return std::any_of(report.not_known.begin(), report.not_known.end(),
                     [&](const std::string& s) { return s.find(words) != std::string::npos; });
}

const CostSetting* setting(const CostReport& report, const std::string& knob, const std::string& value) {
  for (const CostSetting& s : report.settings) {
    if (s.knob == knob && s.value == value) return &s;
  }
  return nullptr;
}

std::vector<CostSetting> levels(const CostReport& report) {
  std::vector<CostSetting> out;
  for (const CostSetting& s : report.settings) {
    if (s.knob == "samples") out.push_back(s);
  }
  return out;
}

TEST(Cost, FindsAKnownVariance) {
  // A sample is 1 with p = 1/4, else 0: variance p (1 - p), and the mean is p, so that n of them have an nRMSE of
  // sqrt(p (1 - p) / n) / p = sqrt(3 / n). It is estimated by 8 x 32 x 32 pixels, whose squares scatter by
  // sqrt(2 / 8192) = 1.6 % and their root by half of that; at 4 samples, which are far from normal, by a bit more. Four
  // times this makes 4 %.
  const CostReport r = study(square("Sampler \"random\" \"integer pixelsamples\" 16", stripes())).report;
  ASSERT_GE(levels(r).size(), 2u);
  EXPECT_EQ(r.replicates, 8);
  EXPECT_NEAR(r.mean_radiance, 0.25, 0.01);
  for (const CostSetting& s : levels(r)) {
    const double truth = std::sqrt(3.0 / s.samples);
    EXPECT_NEAR(s.nrmse.value, truth, 0.04 * truth) << s.samples;
    EXPECT_LT(s.nrmse.low, s.nrmse.value) << s.samples;
    EXPECT_GT(s.nrmse.high, s.nrmse.value) << s.samples;
    EXPECT_GE(s.upper95, s.nrmse.value) << s.samples;
    EXPECT_EQ(s.command, fmt::format("whit 'a scene.pbrt' --spp {}", s.samples));
  }
  // The reference has 16 times the samples of the last level.
  EXPECT_EQ(r.reference_samples, 16 * levels(r).back().samples);
  EXPECT_NEAR(r.reference_noise, std::sqrt(3.0 / r.reference_samples), 0.1 * std::sqrt(3.0 / r.reference_samples));
  EXPECT_LE(r.order.low, 0.5);
  EXPECT_GE(r.order.high, 0.5);
  EXPECT_NEAR(r.order.value, 0.5, 0.06);
}

TEST(Cost, AnswersWhatItMeasured) {
  const CostReport r = study(square("Sampler \"random\" \"integer pixelsamples\" 16", stripes())).report;
  ASSERT_FALSE(r.answers.empty());
  for (const CostAnswer& a : r.answers) {
    EXPECT_EQ(a.command.rfind("whit 'a scene.pbrt' --spp ", 0), 0u) << a.command;
    EXPECT_LE(a.nrmse.low, a.nrmse.high) << a.text;
    EXPECT_LE(a.cpu_seconds.low, a.cpu_seconds.high) << a.text;
    const int samples = std::stoi(a.command.substr(a.command.find("--spp ") + 6));
    const int last = levels(r).back().samples;
    EXPECT_LE(samples, 4 * last) << a.text;
    EXPECT_EQ(a.extrapolated, samples > last) << a.text;
    // The truth is within what is predicted; extrapolated or not.
    const double truth = std::sqrt(3.0 / samples);
    EXPECT_LE(a.nrmse.low, 1.02 * truth) << a.text;
    EXPECT_GE(a.nrmse.high, 0.98 * truth) << a.text;
  }
}

TEST(Cost, HasNoErrorWhereAllIsOneColour) {
  const CostReport r = study(square("", kSky), {.seconds = 0.7}).report;
  ASSERT_FALSE(levels(r).empty());
  for (const CostSetting& s : levels(r)) EXPECT_EQ(s.nrmse, Estimate{}) << s.samples;
  EXPECT_EQ(r.half_error_pixels, 0u);
  EXPECT_TRUE(r.worst.empty());
  EXPECT_TRUE(says(r, "no error")) << r.not_known.size();
}

TEST(Cost, MeasuresTheBiasOfADepth) {
  // Rays that are not followed leave the mirror black: half of the pixels fall from 1 to 0. Over a mean radiance of 1 that
  // is a bias of sqrt(1/2), half of the light, and half of the pixels. No sample has noise.
  const CostReport r =
      study(square("Integrator \"whitted\" \"integer maxdepth\" 2", half_mirror()), {.seconds = 2.5, .quick = false})
          .report;
  const CostSetting* shallow = setting(r, "maxdepth", "1");
  ASSERT_TRUE(shallow && shallow->bias && shallow->change);
  EXPECT_NEAR(shallow->bias->value, std::sqrt(0.5), 1e-6);
  EXPECT_NEAR(shallow->bias->low, std::sqrt(0.5), 1e-6);
  EXPECT_NEAR(shallow->nrmse.value, std::sqrt(0.5), 1e-6);
  EXPECT_NEAR(shallow->change->pixels_changed, 0.5, 1e-9);
  EXPECT_NEAR(shallow->change->mean_change, -0.5, 1e-6);
  EXPECT_EQ(shallow->change->from, "2");
  EXPECT_NE(shallow->command.find("--maxdepth 1"), std::string::npos);
  const CostSetting* deep = setting(r, "maxdepth", "3");
  ASSERT_TRUE(deep && deep->bias);
  EXPECT_EQ(*deep->bias, Estimate{});
  EXPECT_EQ(deep->change->pixels_changed, 0);

  const auto mirror =
      std::find_if(r.effects.begin(), r.effects.end(), [](const CostEffect& e) { return e.name == "reflection"; });
  ASSERT_NE(mirror, r.effects.end());
  EXPECT_NEAR(mirror->mean_change, 0.5, 1e-6);
  EXPECT_NEAR(mirror->pixels_changed, 0.5, 1e-9);
  EXPECT_NE(mirror->command.find("--without reflection"), std::string::npos);
  EXPECT_GT(mirror->where.width, 0);
}

TEST(Cost, NamesWhatCarriesTheError) {
  // All of the error is at the lamp, which covers a part of a pixel in the middle; the sky has none.
  Rectangles lamp;
  lamp.add(0, 0.02, 0, 0.02);
  const CostReport r =
      study(
          square("", kSky + std::string("AreaLightSource \"diffuse\" \"rgb L\" [9 9 9] \"bool twosided\" \"true\"\n") +
                         lamp.shape()),
          {.seconds = 0.7})
          .report;
  ASSERT_EQ(r.worst.size(), 1u);
  EXPECT_EQ(r.half_error_pixels, 1u);
  EXPECT_NEAR(r.worst[0].share, 1, 1e-6);
  EXPECT_TRUE(r.worst[0].pixel.x == 15 || r.worst[0].pixel.x == 16) << r.worst[0].pixel.x;
}

TEST(Cost, TellsSamplersOfAnotherLimit) {
  // A stripe covers the middle quarter of each pixel. Samples in the middle of pixels see nothing else: the picture is 1
  // and has no noise. Of random ones it is 1/4, which is a bias of 3/4 over that mean.
  Rectangles stripes;
  for (int i = 0; i < kSide; ++i) {
    const double middle = -1 + (i + 0.5) * 2 / kSide;
    stripes.add(middle - 0.25 / kSide, middle + 0.25 / kSide, -1, 1);
  }
  const std::string text = square("Sampler \"halton\" \"integer pixelsamples\" 4 \"bool samplepixelcenter\" \"true\"",
                                  "Material \"matte\" \"rgb Kd\" [0 0 0]\n"
                                  "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] \"bool twosided\" \"true\"\n" +
                                      stripes.shape());
  const CostReport r = study(text, {.seconds = 2, .quick = false}).report;
  EXPECT_EQ(r.mean_radiance, 1);
  const CostSetting* random = setting(r, "sampler", "random");
  ASSERT_TRUE(random && random->bias);
  // Known from 4 pairs or more of 4 samples or more: sqrt(3/16 / 16 / 1024 pixels) is 0.3 % of it; five times that.
  EXPECT_NEAR(random->bias->value, 0.75, 0.02);
}

TEST(Cost, KeepsToItsTime) {
  for (bool quick : {true, false}) {
    const auto start = std::chrono::steady_clock::now();
    const CostReport r = study(square("", stripes(), 200), {.seconds = 2, .quick = quick}).report;
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    EXPECT_LT(seconds, 2.2);
    EXPECT_FALSE(r.settings.empty());
  }
}

TEST(Cost, ReportsWhatItHasWhenInterrupted) {
  const CostReport r =
      study(square("", stripes()),
            {.seconds = 60, .quick = false, .progress = [](double share, const std::string&) { return share < 0.01; }})
          .report;
  EXPECT_FALSE(r.complete);
  EXPECT_FALSE(levels(r).empty());
  EXPECT_FALSE(r.answers.empty());
}

TEST(Cost, SaysWhatIsNotDefined) {
  const CostReport black = study(square("", "LightSource \"infinite\" \"rgb L\" [0 0 0]"), {.seconds = 0.5}).report;
  EXPECT_TRUE(says(black, "black"));
  EXPECT_TRUE(black.settings.empty());
  const CostReport slow =
      study(square("Sampler \"random\" \"integer pixelsamples\" 16", stripes(), 2000), {.seconds = 0.05}).report;
  EXPECT_TRUE(says(slow, "--time")) << slow.not_known.size();
  EXPECT_FALSE(slow.complete);
  // A sky that is darker than black: no sample that meets it has a luminance one could compare.
  const std::string negative = "LightSource \"infinite\" \"rgb L\" [-90 1 1]\n" + stripes();
  EXPECT_TRUE(says(study(square("", negative), {.seconds = 0.5}).report, "no valid radiance"));
  const CostReport one = study(square("", stripes(), 1), {.seconds = 0.5}).report;
  EXPECT_FALSE(levels(one).empty());
}

TEST(Cost, TakesNoSceneWithErrors) {
  const CostStudy s = study(square("", "Shape \"sphere\" \"float radius\" -1"), {.seconds = 0.5});
  EXPECT_TRUE(s.said.has_errors());
  EXPECT_TRUE(s.report.settings.empty());
}

}  // namespace
}  // namespace whit
