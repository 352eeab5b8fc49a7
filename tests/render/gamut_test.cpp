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

TEST(Gamut, NegativeLuminanceIsBlack) {
  // As in pbrt-v3: 0.2127 * -9 + 0.7152 + 0.0722 is below 0, and such a sample counts as black.
  expect_near(wall_under(light("\"rgb L\" [-9 1 1]")), RGB(0, 0, 0));
}

}  // namespace
}  // namespace whit
