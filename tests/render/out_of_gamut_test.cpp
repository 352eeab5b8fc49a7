// Colours outside of Rec.709, with a channel below zero: candle light, monochromatic light, xyz of any kind.
#include <gtest/gtest.h>

#include "core/render/render.h"
#include "tests/scene/scene_text.h"

namespace whit {
namespace {

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

TEST(OutOfGamut, ChannelsBelowZeroAreClampedInThePicture) {
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
