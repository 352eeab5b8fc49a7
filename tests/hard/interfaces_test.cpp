// Rays through many interfaces, and those that do not get ahead.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/scene/scene_text.h"

namespace whit {
namespace {

/// A lamp behind `n` sheets of the material "none" at z = first + i step, seen along z from the origin.
RenderResult through_sheets(int n, double first, double step) {
  std::string points, indices;
  for (int i = 0; i < n; ++i) {
    const double z = first + i * step;
    points += fmt::format("-9 -9 {0:.17g} 9 -9 {0:.17g} 0 9 {0:.17g} ", z);
    indices += fmt::format("{} {} {} ", 3 * i, 3 * i + 1, 3 * i + 2);
  }
  const std::string sheets = n > 0 ? "Material \"none\" Shape \"trianglemesh\" \"integer indices\" [" + indices +
                                         "] \"point P\" [" + points + "]\n"
                                   : "";
  test::Planned planned(
      "LookAt 0 0 0  0 0 1  0 1 0\nCamera \"perspective\" \"float fov\" 20\nFilm \"image\" \"integer xresolution\" 4\n"
      "\"integer yresolution\" 4\nSampler \"halton\" \"integer pixelsamples\" 1\nWorldBegin\nAttributeBegin "
      "AreaLightSource \"diffuse\" "
      "\"rgb L\" [1 2 3] \"bool twosided\" \"true\"\nShape \"trianglemesh\" \"integer indices\" [0 1 2]\n"
      "\"point P\" [-90 -90 20 90 -90 20 0 90 20] AttributeEnd\n" +
      sheets + "WorldEnd\n");
  return render_world(build_world(std::move(planned.world))).result;
}

void expect_seen(const RenderResult& result) {
  EXPECT_EQ(result.statistics.stopped_rays, 0);
  for (size_t i = 0; i < result.picture.rgb.size(); ++i) {
    EXPECT_EQ(result.picture.rgb[i], static_cast<float>(1 + i % 3)) << "channel " << i;
  }
}

TEST(Interfaces, AHonestRowIsPassed) {
  for (const int n : {0, 1, 63, 64, 65, 300, 3000}) expect_seen(through_sheets(n, 1, 5e-3));
}

TEST(Interfaces, SheetsInOneAnotherArePassed) {
  // At one place, a ray goes on behind them all. 30 that are a unit of the last place apart take as many short steps at
  // most.
  expect_seen(through_sheets(300, 1, 0));
  expect_seen(through_sheets(30, 1, 0x1p-23));
}

/// Every pixel has one sample, which sees the lamp or is lost.
void expect_stopped(const RenderResult& result, int64_t at_least) {
  EXPECT_GE(result.statistics.stopped_rays, at_least);
  int64_t dark = 0;
  for (size_t i = 0; i < result.picture.rgb.size(); i += 3) dark += result.picture.rgb[i] == 0;
  EXPECT_EQ(dark, result.statistics.stopped_rays);
}

TEST(Interfaces, RaysThatDoNotGetAheadStopAndAreCounted) {
  // Sheets as near to each other as floats can be: some rays are moved by no more than the error of where they are, and
  // there are more than 64 such steps.
  expect_stopped(through_sheets(4000, 1, 0x1p-23), 1);
  // A row of more than ten thousand stops all.
  expect_stopped(through_sheets(10100, 1, 1e-3), 16);
}

}  // namespace
}  // namespace whit
