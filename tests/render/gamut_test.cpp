// Lights of colours outside the gamut of Rec.709, as saturated spectra are: their negative components count until the
// picture is made.
#include <gtest/gtest.h>

#include "core/render/render.h"
#include "tests/scene/scene_text.h"

namespace whit {
namespace {

/// One pixel of a matte wall of reflectance 0.5 that parallel light meets along its normal: L * 0.5 / pi for each light.
RGB wall_under(const std::string& lights) {
  const test::BuiltScene built(
      "Film \"image\" \"integer xresolution\" 1 \"integer yresolution\" 1\n"
      "Camera \"orthographic\"\nWorldBegin\n" +
      lights + "Translate 0 0 5 Shape \"disk\" \"float radius\" 9\nWorldEnd\n");
  const RenderResult result = render(*built.scene, {});
  EXPECT_EQ(result.statistics.invalid_samples, 0);
  const std::vector<float>& p = result.picture.rgb;
  return {p[0], p[1], p[2]};
}

std::string light(const std::string& colour) {
  return "LightSource \"distant\" \"point from\" [0 0 -1] \"point to\" [0 0 0] " + colour + "\n";
}

void expect_near(const RGB& a, const RGB& b) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], 1e-6f) << c;
}

constexpr float kWall = 0.5f / 3.14159265f;

TEST(Gamut, NegativeComponentsAreKeptUntilThePictureIsMade) {
  expect_near(wall_under(light("\"rgb L\" [-1 2 1]")), RGB(0, 2, 1) * kWall);
  expect_near(wall_under(light("\"rgb L\" [-1 2 1]") + light("\"rgb L\" [3 0 0]")), RGB(2, 2, 1) * kWall);
}

TEST(Gamut, ASpectralGreenIsGreen) {
  const RGB green = wall_under(light("\"spectrum L\" [499 0 500 1 520 1 521 0]"));
  EXPECT_EQ(green.x, 0);
  EXPECT_GT(green.y, 0);
  EXPECT_LT(green.z, green.y);
}

TEST(Gamut, NegativeLuminanceIsInvalid) {
  // 0.2127 * -9 + 0.7152 + 0.0722 is below 0: no light looks like that. pbrt-v3 logs an error.
  const test::BuiltScene built(
      "Film \"image\" \"integer xresolution\" 1 \"integer yresolution\" 1\n"
      "Sampler \"random\" \"integer pixelsamples\" 2\nWorldBegin\n"
      "LightSource \"infinite\" \"rgb L\" [-9 1 1]\nWorldEnd\n");
  EXPECT_EQ(render(*built.scene, {}).statistics.invalid_samples, 2);
}

/// The one pixel that sees nothing but a sky of that radiance, the mean of two samples.
RGB seen(const std::string& radiance) {
  const test::BuiltScene built(
      "Film \"image\" \"integer xresolution\" 1 \"integer yresolution\" 1\n"
      "Sampler \"random\" \"integer pixelsamples\" 2\nWorldBegin\nLightSource \"infinite\" " +
      radiance + "\nWorldEnd\n");
  const RenderResult result = render(*built.scene, {});
  EXPECT_EQ(result.statistics.invalid_samples, 0) << radiance;
  const std::vector<float>& rgb = result.picture.rgb;
  return {rgb[0], rgb[1], rgb[2]};
}

TEST(Gamut, ChannelsBelowZeroAreClampedInThePicture) {
  // pbrt's XYZ to RGB: r = 3.240479 * 0.2 - 1.537150 * 0.8 - 0.498535 * 0.1 = -0.631,
  // g = -0.969256 * 0.2 + 1.875991 * 0.8 + 0.041556 * 0.1 = 1.311097, b = 0.055648 * 0.2 - ... = -0.046.
  const RGB xyz = seen("\"xyz L\" [0.2 0.8 0.1]");
  EXPECT_EQ(xyz.x, 0);
  EXPECT_FLOAT_EQ(xyz.y, 1.311097f);
  EXPECT_EQ(xyz.z, 0);
  EXPECT_EQ(seen("\"rgb L\" [-1 2 3]"), RGB(0, 2, 3));
  // A candle: no blue in Rec.709.
  const RGB candle = seen("\"blackbody L\" [1800 1]");
  EXPECT_GT(candle.x, candle.y);
  EXPECT_GT(candle.y, 0);
  EXPECT_EQ(candle.z, 0);
}

}  // namespace
}  // namespace whit
