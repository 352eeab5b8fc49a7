// Display transforms against the formulas of their curves.
#include "core/color/display.h"

#include <Imath/half.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "tests/base/temp_folder.h"

namespace whit {
namespace {

class Display : public testing::Test {
 protected:
  void SetUp() override { unsetenv("OCIO"); }
  void TearDown() override { unsetenv("OCIO"); }
};

DisplayResult make(const std::string& view, float exposure = 0, const std::string& config = "") {
  return make_display_transform({config, view, exposure});
}

float grey(const DisplayTransform& t, float v) {
  float rgb[3] = {v, v, v};
  t.apply(rgb, 1);
  EXPECT_NEAR(rgb[0], rgb[1], 2e-4f);
  EXPECT_NEAR(rgb[0], rgb[2], 2e-4f);
  return rgb[1];
}

// IEC 61966-2-1 in double precision.
double srgb(double v) { return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055; }

// A config of two displays; its view "Plain" leaves values as they are, "Half" multiplies them by 0.5.
std::string write_config() {
  const std::string path = test::temp_folder() + "/whit_test.ocio";
  std::ofstream(path) << "ocio_profile_version: 1\n"
                         "roles:\n  scene_linear: lin\n  default: lin\n"
                         "displays:\n"
                         "  Screen:\n    - !<View> {name: Plain, colorspace: lin}\n"
                         "    - !<View> {name: Half, colorspace: half}\n"
                         "  Beamer:\n    - !<View> {name: Dim, colorspace: half}\n"
                         "active_displays: [Screen, Beamer]\n"
                         "colorspaces:\n"
                         "  - !<ColorSpace>\n    name: lin\n"
                         "  - !<ColorSpace>\n    name: half\n    from_reference: !<MatrixTransform> "
                         "{matrix: [0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 1]}\n";
  return path;
}

TEST_F(Display, default_view_is_the_exact_srgb_curve) {
  const DisplayResult r = make("");
  ASSERT_TRUE(r.transform) << r.error;
  EXPECT_EQ(r.transform->describe(), "sRGB (built-in)");
  EXPECT_NEAR(grey(*r.transform, 0.18f), 0.461, 0.002);
  // On both sides of the break at 0.0031308, and clamped beyond [0, 1].
  for (double v : {0.0, 1e-6, 0.001, 0.0031308, 0.0032, 0.01, 0.2, 0.5, 0.9, 1.0})
    EXPECT_NEAR(grey(*r.transform, float(v)), srgb(v), 1e-6) << v;
  EXPECT_EQ(grey(*r.transform, -1), 0);
  EXPECT_EQ(grey(*r.transform, 7), 1);
}

TEST_F(Display, default_view_gives_the_bytes_of_pbrt) {
  // pbrt-v3: uint8(clamp(255 encode(v) + 0.5)), all in float.
  const DisplayResult r = make("sRGB");
  ASSERT_TRUE(r.transform) << r.error;
  for (int i = 0; i <= 100000; ++i) {
    const float v = float(i) / 100000;
    const float e = v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1.f / 2.4f) - 0.055f;
    float rgb[3] = {v, v, v};
    r.transform->apply(rgb, 1);
    ASSERT_EQ(int(255 * rgb[0] + 0.5f), int(std::clamp(255.f * e + 0.5f, 0.f, 255.f))) << v;
  }
}

TEST_F(Display, aces_view) {
  const DisplayResult r = make("ACES SDR");
  ASSERT_TRUE(r.transform) << r.error;
  EXPECT_EQ(r.transform->describe(), "ACES SDR (built-in)");
  EXPECT_NEAR(grey(*r.transform, 0.18f), 0.356, 0.002);
  EXPECT_LT(grey(*r.transform, 1), 0.95f);  // it rolls off instead of clipping
}

TEST_F(Display, exposure_view_follows_its_formula_on_all_halfs) {
  for (const double e : {0.0, 0.6, 0.99}) {
    const DisplayResult r = make("exposure=" + std::to_string(e));
    ASSERT_TRUE(r.transform) << r.error;
    double worst = 0;
    // Bit patterns of positive halfs from 0 (0x0000) to 64 (0x5400).
    for (unsigned bits = 0; bits <= 0x5400; ++bits) {
      Imath::half h;
      h.setBits(static_cast<uint16_t>(bits));
      const double expected = srgb(-std::expm1(-double(float(h)) / (1 - double(float(e)))));
      float rgb[3] = {h, h, h};
      r.transform->apply(rgb, 1);
      for (float v : rgb) worst = std::max(worst, std::abs(v - expected));
    }
    RecordProperty("worst", std::to_string(worst));
    EXPECT_LT(worst, 1e-6) << e;
  }
  EXPECT_EQ(grey(*make("exposure=0.5").transform, -3), 0);
  EXPECT_NEAR(grey(*make("exposure=0.5").transform, 1e30f), 1, 1e-6);
}

TEST_F(Display, every_view_is_finite_everywhere) {
  const float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  for (const char* view : {"sRGB", "ACES SDR", "exposure=0", "exposure=0.9999"}) {
    const DisplayResult r = make(view, 3);
    ASSERT_TRUE(r.transform) << r.error;
    std::vector<float> values;
    for (float a : {0.f, -0.f, -1.f, -1e30f, 1e-40f, 1e-20f, 0.5f, 1e5f, 1e12f, 1e30f, 3e38f, inf, -inf, nan})
      for (float b : {0.f, -2.f, 1.f, 1e30f, nan}) values.insert(values.end(), {a, b, 0.2f, b, a, a});
    r.transform->apply(values.data(), values.size() / 3);
    for (float v : values) EXPECT_TRUE(v >= 0 && v <= 1) << view << " " << v;
  }
}

TEST_F(Display, brighter_light_is_not_darker) {
  for (const char* view : {"sRGB", "ACES SDR", "exposure=0.3"}) {
    const DisplayResult r = make(view);
    float last = 0;
    for (float v = 1e-4f; v < 1e8f; v *= 1.1f) {
      const float now = grey(*r.transform, v);
      EXPECT_GE(now, last - 1e-5f) << view << " at " << v;
      last = now;
    }
    // OpenColorIO 2.1.2's ACES turns 1e30 black, because its squares overflow: values are bounded before it.
    for (const float huge : {1e20f, 1e30f, std::numeric_limits<float>::infinity()})
      EXPECT_GE(grey(*r.transform, huge), 0.999f) << view << " at " << huge;
  }
}

TEST_F(Display, exposure_stops_scale_first) {
  // +2 stops: 0.045 * 4 = 0.18.
  const DisplayResult plain = make("sRGB"), up = make("sRGB", 2);
  EXPECT_EQ(grey(*up.transform, 0.045f), grey(*plain.transform, 0.18f));
  EXPECT_EQ(up.transform->describe(), "sRGB (built-in), +2 stops");
  EXPECT_FALSE(make("", std::numeric_limits<float>::quiet_NaN()).error.empty());
}

TEST_F(Display, a_pixel_does_not_depend_on_its_neighbours) {
  const DisplayResult r = make("ACES SDR");
  std::vector<float> all;
  for (int i = 0; i < 3 * 101; ++i) all.push_back(0.01f * float((i * 37) % 211));
  std::vector<float> single = all;
  r.transform->apply(all.data(), 101);
  for (int i = 0; i < 101; ++i) r.transform->apply(single.data() + 3 * i, 1);
  EXPECT_EQ(all, single);
}

TEST_F(Display, errors_say_what_there_is) {
  const std::string unknown = make("Filmic").error;
  EXPECT_NE(unknown.find("Filmic"), std::string::npos);
  EXPECT_NE(unknown.find("ACES SDR"), std::string::npos) << unknown;
  EXPECT_NE(unknown.find("exposure=e"), std::string::npos) << unknown;
  for (const char* bad :
       {"exposure", "exposure=", "exposure=1", "exposure=-0.1", "exposure=x", "exposure=0.5x", "exposure=nan"})
    EXPECT_FALSE(make(bad).error.empty()) << bad;
  const std::string missing = make("", 0, "/nowhere/c.ocio").error;
  EXPECT_NE(missing.find("/nowhere/c.ocio"), std::string::npos) << missing;
}

TEST_F(Display, built_in_views_are_listed) {
  EXPECT_EQ(make("").transform->view_names(), (std::vector<std::string>{"sRGB", "ACES SDR", "exposure=e"}));
}

TEST_F(Display, config_of_the_user) {
  const std::string path = write_config();
  const DisplayResult plain = make("", 0, path), half = make("Half", 0, path), dim = make("Beamer/Dim", 0, path);
  ASSERT_TRUE(plain.transform) << plain.error;
  ASSERT_TRUE(half.transform) << half.error;
  ASSERT_TRUE(dim.transform) << dim.error;
  EXPECT_FLOAT_EQ(grey(*plain.transform, 0.5f), 0.5f);
  EXPECT_FLOAT_EQ(grey(*half.transform, 0.5f), 0.25f);
  EXPECT_FLOAT_EQ(grey(*dim.transform, 0.5f), 0.25f);
  EXPECT_EQ(half.transform->describe(), "Half (Screen display, whit_test.ocio)");
  EXPECT_EQ(half.transform->view_names(), (std::vector<std::string>{"Plain", "Half", "Beamer/Dim"}));
  const std::string unknown = make("ACES SDR", 0, path).error;
  EXPECT_NE(unknown.find("\"Plain\", \"Half\", \"Beamer/Dim\""), std::string::npos) << unknown;
}

TEST_F(Display, the_path_wins_over_the_environment_and_that_over_the_built_in) {
  const std::string path = write_config();
  setenv("OCIO", path.c_str(), 1);
  EXPECT_EQ(make("").transform->describe(), "Plain (Screen display, whit_test.ocio)");
  setenv("OCIO", "/nowhere/else.ocio", 1);
  EXPECT_EQ(make("", 0, path).transform->describe(), "Plain (Screen display, whit_test.ocio)");
  EXPECT_NE(make("").error.find("/nowhere/else.ocio"), std::string::npos);
  setenv("OCIO", "", 1);
  EXPECT_EQ(make("").transform->describe(), "sRGB (built-in)");
}

}  // namespace
}  // namespace whit
