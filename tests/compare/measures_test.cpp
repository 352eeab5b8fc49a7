// The measures on pictures small enough to work out by hand.
#include "core/compare/measures.h"

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <cmath>
#include <limits>

#include "tests/compare/pictures.h"

namespace whit {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

TEST(Measures, EqualPictures) {
  const Comparison c = compared(grey(16, 16, 0.5f), grey(16, 16, 0.5f));
  for (const char* zero : {"relmse_robust", "relmse", "mse", "rmse", "mae", "max", "block", "shift", "pixels"})
    EXPECT_EQ(value_of(c, zero), 0) << zero;
  EXPECT_EQ(value_of(c, "ratio"), 1);
  EXPECT_EQ(value_of(c, "psnr"), kInfinite);
  EXPECT_TRUE(c.same());
}

TEST(Measures, OnePixel) {
  // The reference is 1 everywhere. One number of 3 x 256 is off by 0.5: relMSE 0.25 / (1 + 0.01) / 768; red's mean 0.5 / 256;
  // the mean of a channel's 64 numbers of a block by 0.5 / 64, over 1.1; PSNR by a mean square of 0.25 / 768 and a peak of 1.
  const PicturePlanes ref = grey(16, 16, 1);
  PicturePlanes out = ref;
  at(out, 0, 3, 12) = 1.5f;
  const Comparison c = compared(out, ref);
  EXPECT_NEAR(value_of(c, "relmse"), 0.25 / 1.01 / 768, 1e-9);
  EXPECT_NEAR(value_of(c, "ratio"), 1 + 0.5 / 256, 1e-12);
  EXPECT_EQ(c.find("ratio")->channel, "R");
  EXPECT_NEAR(value_of(c, "block"), 0.5 / 192 / 1.1, 1e-12);
  EXPECT_NEAR(value_of(c, "channel_block"), 0.5 / 64 / 1.1, 1e-12);
  EXPECT_EQ(c.find("channel_block")->channel, "R");
  EXPECT_EQ(*c.find("block")->at, Vec2i(0, 8));
  EXPECT_NEAR(value_of(c, "psnr"), 10 * std::log10(768 / 0.25), 1e-9);
  EXPECT_EQ(value_of(c, "max"), 0.5);
  EXPECT_EQ(*c.find("max")->at, Vec2i(3, 12));
  EXPECT_EQ(c.find("max")->channel, "R");
  EXPECT_NEAR(value_of(c, "mae"), 0.5 / 768, 1e-12);
  EXPECT_EQ(c.differing_pixels, 1);
}

TEST(Measures, RobustIsWithoutTheWorstThousandth) {
  // 2000 pixels: two are left out. All are off by 0.1 of 1, so 0.01 / 1.01 each; two by 10 more: 10.1^2 / 1.01 = 101.
  const PicturePlanes ref = grey(50, 40, 1);
  PicturePlanes out = grey(50, 40, 1.1f);
  for (size_t c = 0; c < 3; ++c) at(out, c, 7, 7) = at(out, c, 30, 20) = 11.1f;
  const Comparison c = compared(out, ref);
  EXPECT_NEAR(value_of(c, "relmse_robust"), 0.01 / 1.01, 1e-6);
  const double held = 2 * 10.1 * 10.1, all = held + 1998 * 0.01;
  EXPECT_NEAR(value_of(c, "relmse"), all / 1.01 / 2000, 1e-5);
  EXPECT_EQ(c.find("relmse_robust")->words, fmt::format("the worst 2 pixels hold {:.3g} % of it", 100 * held / all));
}

TEST(Measures, BlocksReachEveryPixel) {
  // A wrong pixel in the last column and row of a size that is no multiple of 8, or smaller than a block: it is one of the
  // pixels of a whole block that ends there.
  for (const int size : {1, 5, 8, 9, 20}) {
    const PicturePlanes ref = grey(size, size, 1);
    PicturePlanes out = ref;
    for (size_t c = 0; c < 3; ++c) at(out, c, size - 1, size - 1) = 2;
    const int side = std::min(size, 8);
    const Comparison c = compared(out, ref);
    EXPECT_NEAR(value_of(c, "block"), 1.0 / (side * side) / 1.1, 1e-6) << size;
    EXPECT_EQ(*c.find("block")->at, Vec2i(size - side, size - side)) << size;
  }
}

TEST(Measures, BlocksOfNegativeNumbers) {
  // |-1.5 - -1| / (|-1| + 0.1 * 1)
  EXPECT_NEAR(value_of(compared(grey(8, 8, -1.5f), grey(8, 8, -1)), "block"), 0.5 / 1.1, 1e-9);
}

TEST(Measures, ColoursDoNotMakeUpForEachOther) {
  // A block whose red and blue are swapped: 0.5 off in each, of a mean of 0.5 and a tenth of it.
  const auto swapped = [](bool swap) {
    return picture(8, 8, {"R", "G", "B"}, [=](size_t c, int, int) {
      return c == 1 ? 0.5f : (c == 0) == swap ? 0.25f : 0.75f;
    });
  };
  const Comparison c = compared(swapped(true), swapped(false));
  EXPECT_EQ(value_of(c, "block"), 0);
  EXPECT_NEAR(value_of(c, "channel_block"), 0.5 / 0.55, 1e-6);
  EXPECT_FALSE(c.same());
}

TEST(Measures, ALampIsNoMeasureForWhatItShinesOn) {
  // One pixel in 400 is 10000, the others 0.3: cut at 3, the mean is 0.307. All but the lamp black is far off.
  const auto room = [](float light) {
    return picture(40, 40, {"R", "G", "B"},
                   [=](size_t, int x, int y) { return x % 20 == 3 && y % 20 == 3 ? 10000.0f : light; });
  };
  const Comparison c = compared(room(0), room(0.3f));
  EXPECT_NEAR(value_of(c, "relmse_robust"), 0.09 / (0.09 + 0.0307 * 0.0307), 0.01);
  EXPECT_GT(value_of(c, "block"), 0.8);
  EXPECT_LT(value_of(c, "relmse"), 0.02);  // By the mean, 25, it is nothing.
}

TEST(Measures, DarkPicturesAreMeasuredLikeBrightOnes) {
  const auto pattern = [](float scale, bool off) {
    return picture(16, 16, {"R", "G", "B"}, [=](size_t, int x, int y) {
      return scale * (1 + static_cast<float>((x + y) % 3) + (off ? 0.2f : 0.0f));
    });
  };
  const Comparison bright = compared(pattern(1, true), pattern(1, false)),
                   dark = compared(pattern(0x1p-24f, true), pattern(0x1p-24f, false));
  for (const char* measure : {"relmse", "relmse_robust", "block", "ratio"})
    EXPECT_NEAR(value_of(dark, measure), value_of(bright, measure), 1e-5) << measure;
}

TEST(Measures, NoNumbersAreNoPixels) {
  // Half of the pixels are infinitely far in both: means are of the others, 2 against 3.
  const float inf = std::numeric_limits<float>::infinity();
  const auto depths = [=](float z) {
    return picture(10, 10, {"Z"}, [=](size_t, int x, int) { return x < 5 ? z : inf; });
  };
  const Comparison c = compared(depths(2), depths(3));
  EXPECT_EQ(value_of(c, "mse", "Z"), 1);
  EXPECT_NEAR(value_of(c, "relmse", "Z"), 1 / (9 + 0.09), 1e-6);
  EXPECT_NEAR(value_of(c, "block", "Z"), 1 / 3.3, 1e-6);
  const PicturePlanes near = depths(2);
  PicturePlanes far = near;
  at(far, 0, 2, 7) = inf;
  const Comparison gone = compared(near, far);
  EXPECT_EQ(value_of(gone, "max", "Z"), inf);
  EXPECT_EQ(*gone.find("max", "Z")->at, Vec2i(2, 7));
}

TEST(Measures, RatioLeavesBlackChannelsOut) {
  // Means of the reference 1, 1, 0.01: 5 % of the mean of all is 0.0335, so blue has no say. Green is furthest: 0.8.
  const PicturePlanes ref = picture(8, 8, {"R", "G", "B"}, [](size_t c, int, int) { return c == 2 ? 0.01f : 1.0f; });
  const PicturePlanes out = picture(8, 8, {"R", "G", "B"}, [](size_t c, int, int) {
    return c == 0 ? 1.1f : c == 1 ? 0.8f : 0.03f;
  });
  const Comparison c = compared(out, ref);
  EXPECT_NEAR(value_of(c, "ratio"), 0.8, 1e-6);
  EXPECT_EQ(c.find("ratio")->channel, "G");
}

TEST(Measures, RatioOfBlackPictures) {
  EXPECT_EQ(value_of(compared(grey(8, 8, 0), grey(8, 8, 0)), "ratio"), 1);
  const Comparison c = compared(grey(8, 8, 1), grey(8, 8, 0));
  EXPECT_EQ(value_of(c, "ratio"), kInfinite);
  EXPECT_FALSE(c.same());
  EXPECT_TRUE(compared(grey(8, 8, 1e-9f), grey(8, 8, 0)).same());  // No display shows it.
  // A layer whose mean is 0 has no ratio.
  const auto around_zero = [](float off) {
    return picture(8, 8, {"d.R", "d.G", "d.B"}, [=](size_t, int x, int) { return (x % 2 ? 1.0f : -1.0f) + off; });
  };
  const Comparison signs = compared(around_zero(1e-6f), around_zero(0));
  EXPECT_EQ(signs.find("ratio", "d"), nullptr);
  EXPECT_TRUE(signs.same());
}

TEST(Measures, EveryLayer) {
  const auto make = [](float normal) {
    return picture(8, 8, {"R", "G", "B", "N.X"}, [=](size_t c, int, int) { return c == 3 ? normal : 1.0f; });
  };
  const Comparison c = compared(make(-0.5f), make(0.5f));
  EXPECT_EQ(value_of(c, "mse"), 0);
  EXPECT_EQ(value_of(c, "mse", "N"), 1);
  EXPECT_EQ(c.failed.front().layer, "N");
  EXPECT_EQ(c.differing_pixels, 64);
}

TEST(Measures, IdsMayBeTheirNeighboursAtEdges) {
  // Things 1 and 2, whose edge is at another column in the other picture: chance. A pixel of 3 that the other has nowhere
  // near is none.
  const auto ids = [](int edge, bool third) {
    return picture(10, 10, {"shape.id"}, [=](size_t, int x, int y) {
      return third && x == 8 && y == 5 ? 3.0f : x < edge ? 1.0f : 2.0f;
    });
  };
  EXPECT_EQ(value_of(compared(ids(4, false), ids(5, false)), "mismatch", "shape"), 0);
  EXPECT_GT(value_of(compared(ids(4, false), ids(5, false)), "pixels", "shape"), 0);
  const Comparison c = compared(ids(4, false), ids(4, true));
  EXPECT_EQ(value_of(c, "mismatch", "shape"), 0.01);
  EXPECT_EQ(*c.find("mismatch", "shape")->at, Vec2i(8, 5));
}

TEST(Measures, InfiniteDepthsAreNothingThere) {
  const float inf = std::numeric_limits<float>::infinity();
  const auto depths = [=](int edge, float z) {
    return picture(10, 10, {"Z"}, [=](size_t, int x, int) { return x < edge ? z : inf; });
  };
  const Comparison same = compared(depths(5, 2), depths(5, 2));
  EXPECT_TRUE(same.same());
  EXPECT_EQ(same.nonfinite_count, 0);
  EXPECT_NEAR(value_of(compared(depths(5, 2), depths(8, 2)), "mismatch", "Z"), 0.3, 1e-9);
}

TEST(Measures, ThreadsMakeNoDifference) {
  // With one thread, too.
  // More than one chunk of 65536 numbers, whose sums are added in one order.
  const auto noise = [](uint32_t seed) {
    return picture(700, 300, {"R", "G", "B"}, [=](size_t c, int x, int y) {
      const uint32_t h = (static_cast<uint32_t>(c * 210000 + static_cast<size_t>(y * 700 + x)) ^ seed) * 2654435761u;
      return static_cast<float>(h >> 8) * 0x1p-24f;
    });
  };
  const PicturePlanes a = noise(1), b = noise(77);
  const Comparison first = compared(a, b);
  for (const size_t threads : {1, 2, 5}) {
    const tbb::global_control most(tbb::global_control::max_allowed_parallelism, threads);
    const Comparison again = compared(a, b);
    for (size_t m = 0; m < first.measured.size(); ++m)
      EXPECT_EQ(again.measured[m].value, first.measured[m].value) << first.measured[m].measure;
  }
}

}  // namespace
}  // namespace whit
