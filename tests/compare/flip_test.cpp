#include "core/compare/flip.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <limits>

#include "tests/compare/formula_pictures.h"

namespace whit {
namespace {

constexpr int kWidth = 24, kHeight = 16;

// Expected values are those of the authors' program (flip-evaluator 1.6 for Python), for the same pictures made there.
struct Expected {
  double mean, centre, corner;
};

void expect_flip(const std::vector<float>& test, double ppd, const Expected& expected) {
  const Flip f = flip(picture(kWidth, kHeight, waves), test, kWidth, kHeight, ppd);
  EXPECT_NEAR(f.mean, expected.mean, 2e-4);
  EXPECT_NEAR(f.map[kHeight / 2 * kWidth + kWidth / 3], expected.centre, 1e-3);
  EXPECT_NEAR(f.map[0], expected.corner, 1e-3);
}

TEST(Flip, SeesNoise) {
  const auto noisy = picture(kWidth, kHeight, [](int x, int y, int c) {
    return waves(x, y, c) + 0.2 * std::sin(12.9898 * x + 78.233 * y + 37.719 * c);
  });
  expect_flip(noisy, 67, {0.156965, 0.128954, 0.190505});
  expect_flip(noisy, 20, {0.463988, 0.547275, 0.104303});
}

TEST(Flip, SeesDisplacement) {
  const auto shifted = picture(kWidth, kHeight, [](int x, int y, int c) { return waves(x + 1, y, c); });
  expect_flip(shifted, 67, {0.517970, 0.744428, 0.580282});
  expect_flip(shifted, 20, {0.661570, 0.958304, 0.649179});
}

TEST(Flip, SeesSinglePixels) {
  auto lamp = picture(kWidth, kHeight, waves);
  for (size_t c = 0; c < 3; ++c) {
    lamp[3 * (kHeight / 2 * kWidth + kWidth / 3) + c] = 1;
    lamp[c] = 0;
  }
  expect_flip(lamp, 67, {0.020694, 0.355679, 0.437818});
  expect_flip(lamp, 20, {0.010546, 0.977600, 0.921186});
}

TEST(Flip, SeesBrightness) {
  const auto dark = picture(kWidth, kHeight, [](int x, int y, int c) { return 0.5 * waves(x, y, c); });
  expect_flip(dark, 67, {0.852376, 0.797230, 0.789429});
}

TEST(Flip, IsZeroOfEqualsAndNotANumberOfNan) {
  auto p = picture(kWidth, kHeight, waves);
  EXPECT_EQ(flip(p, p, kWidth, kHeight).mean, 0);
  const auto ref = p;
  p[100] = NAN;
  EXPECT_TRUE(std::isnan(flip(ref, p, kWidth, kHeight).mean));
  EXPECT_EQ(flip(std::vector<float>{0, 0, 0}, std::vector<float>{0, 0, 0}, 1, 1).mean, 0);
}

double lamps(int x, int y, int c) {
  return waves(x, y, c) + ((x - 30) * (x - 30) + (y - 20) * (y - 20) < 20 ? 300 : 0);
}
double night(int x, int y, int c) { return x >= 50 ? 0.5 * waves(x, y, c) : 0; }
double noisy_light(int x, int y, int c) { return waves(x, y, c) * (1 + 2 * noise(x, y, c)); }
double too_wide(int x, int y, int c) { return 3 * waves(x, y, c) - 1; }
double too_wide_and_darker(int x, int y, int c) { return 3 * waves(x, y, c) - 1.1; }
double two_levels(int x, int, int) { return x >= 40 ? 8 : 1; }
double lower_levels(int x, int, int) { return x >= 40 ? 7 : 1; }

struct AuthorsRow {
  const char* name;
  int width, height;
  Formula ref, test;
  // What flip_evaluator.evaluate(ref, test, "LDR" or "HDR", applyMagma=False) of PyPI's flip-evaluator 1.7 says, without
  // further parameters, for arrays of float32 that NumPy made by the same formulas in doubles (of display pictures
  // clamped to [0, 1]): the mean, and the map at (0, 0), (width / 3, height / 2) and (width / 2, height - 1).
  double mean, corner, middle, bottom;
};

void expect_like_authors(const std::vector<AuthorsRow>& rows, bool light) {
  for (const AuthorsRow& row : rows) {
    SCOPED_TRACE(row.name);
    const auto ref = picture(row.width, row.height, row.ref), test = picture(row.width, row.height, row.test);
    const Flip f = light ? hdr_flip(ref, test, row.width, row.height) : flip(ref, test, row.width, row.height);
    const auto at = [&](int x, int y) { return f.map[static_cast<size_t>(y * row.width + x)]; };
    EXPECT_NEAR(f.mean, row.mean, 1e-4);
    EXPECT_NEAR(at(0, 0), row.corner, 1e-4);
    EXPECT_NEAR(at(row.width / 3, row.height / 2), row.middle, 1e-4);
    EXPECT_NEAR(at(row.width / 2, row.height - 1), row.bottom, 1e-4);
  }
}

TEST(Flip, AgreesWithTheAuthorsProgram) {
  expect_like_authors(
      {
          {"noise", 64, 48, waves, noisy, 0.126349, 0.19048, 0.26202, 0.40042},
          {"shift", 64, 48, edges, moved(1, 0, edges), 0.346971, 0.05496, 0.40236, 0.34789},
          {"blur", 64, 48, inner_edges, blurred_edges, 0.393205, 0.79330, 0.40653, 0.24840},
          {"brightness", 64, 48, waves, times(0.9, waves), 0.334738, 0.29442, 0.23927, 0.27322},
          {"hue", 64, 48, waves, swapped, 0.496541, 0.25922, 0.53646, 0.30062},
          {"dark", 64, 48, times(0.02, edges), times(0.03, edges), 0.028698, 0.02189, 0.02914, 0.03636},
          {"thin lines", 64, 48, lines, grey, 0.078023, 0.00000, 0.57521, 0.00000},
          {"one pixel", 64, 48, waves, with_pixel(1, waves), 0.002315, 0.00000, 0.65063, 0.00000},
          {"tiny", 5, 3, waves, moved(2, 1, waves), 0.780321, 0.75653, 0.52542, 0.82507},
          {"a single pixel", 1, 1, waves, moved(5, 5, waves), 0.723518, 0.72352, 0.72352, 0.72352},
          {"out of range", 64, 48, too_wide, too_wide_and_darker, 0.161048, 0.29183, 0.13684, 0.23544},
      },
      false);
}

TEST(HdrFlip, AgreesWithTheAuthorsProgram) {
  expect_like_authors(
      {
          {"noise", 64, 48, waves, noisy_light, 0.070068, 0.05268, 0.08496, 0.13975},
          {"shift", 64, 48, times(5, edges), times(5, moved(1, 0, edges)), 0.281341, 0.05041, 0.31482, 0.30634},
          {"blur", 64, 48, times(5, inner_edges), times(5, blurred_edges), 0.379127, 0.67346, 0.39610, 0.26925},
          {"brightness", 64, 48, waves, times(1.1, waves), 0.099570, 0.07163, 0.12951, 0.09011},
          {"hue", 64, 48, waves, swapped, 0.360667, 0.16555, 0.49738, 0.06511},
          {"highlights", 64, 48, lamps, moved(0, 1, lamps), 0.223814, 0.18577, 0.16049, 0.31647},
          {"dark", 64, 48, times(1e-4, edges), times(1.3e-4, edges), 0.219211, 0.29430, 0.15345, 0.26691},
          {"mostly black", 64, 48, night, moved(1, 0, night), 0.131911, 0.00000, 0.00000, 0.00000},
          {"one pixel", 64, 48, waves, with_pixel(1000, waves), 0.001112, 0.00000, 0.33062, 0.00000},
          {"huge", 64, 48, times(1e6, waves), times(1.1e6, waves), 0.099570, 0.07163, 0.12951, 0.09011},
          {"a power of two", 64, 48, two_levels, lower_levels, 0.025884, 0.00000, 0.00000, 0.00000},
          {"tiny", 5, 3, lamps, moved(30, 20, lamps), 0.464746, 0.38759, 0.39056, 0.47914},
          {"a single pixel", 1, 1, waves, moved(5, 5, waves), 0.472175, 0.47217, 0.47217, 0.47217},
      },
      true);
}

// The same program's parameters "startExposure", "stopExposure" and "numExposures".
TEST(HdrFlip, TakesTheAuthorsExposures) {
  const auto expect = [](const Formula& of, double start, double stop, int count) {
    const FlipExposures e = flip_exposures(picture(64, 48, of));
    EXPECT_NEAR(e.start, start, 1e-4);
    EXPECT_NEAR(e.stop, stop, 1e-4);
    EXPECT_EQ(e.count, count);
  };
  expect(lamps, -7.1492, 2.0556, 10);
  expect(night, 2.2360, 24.0833, 22);
  expect(times(1e-4, edges), 14.9441, 15.9799, 2);
  expect(two_levels, -1.9167, 1.0833, 3);
}

// A black reference has no exposures of its own, for which the authors' program gives up.
TEST(HdrFlip, LooksAtABlackReferenceWithTheExposuresOfTheOther) {
  const std::vector<float> black(3 * kWidth * kHeight, 0.0f), dim = picture(kWidth, kHeight, times(1e-3, waves));
  EXPECT_EQ(hdr_flip(black, black, kWidth, kHeight).mean, 0);
  const double mean = hdr_flip(black, dim, kWidth, kHeight).mean;
  EXPECT_GT(mean, 0.5);
  EXPECT_NEAR(mean, hdr_flip(black, picture(kWidth, kHeight, waves), kWidth, kHeight).mean, 1e-4);
}

TEST(HdrFlip, TakesNegativeForBlackAndInfinityForWhite) {
  const auto ref = picture(kWidth, kHeight, waves);
  auto negative = ref, black = ref, infinite = ref, white = ref;
  negative[300] = -5, black[300] = 0;
  infinite[300] = std::numeric_limits<float>::infinity(), white[300] = 1e9f;
  EXPECT_EQ(hdr_flip(ref, negative, kWidth, kHeight).map, hdr_flip(ref, black, kWidth, kHeight).map);
  EXPECT_EQ(hdr_flip(ref, infinite, kWidth, kHeight).map, hdr_flip(ref, white, kWidth, kHeight).map);
  EXPECT_EQ(flip_exposures(infinite).count, flip_exposures(ref).count);
  EXPECT_GT(hdr_flip(infinite, ref, kWidth, kHeight).mean, 0);
  EXPECT_EQ(hdr_flip(infinite, infinite, kWidth, kHeight).mean, 0);
}

TEST(HdrFlip, IsNotANumberOfNan) {
  const auto ref = picture(kWidth, kHeight, lamps);
  auto p = ref;
  p[100] = NAN;
  for (const Flip& f :
       {hdr_flip(ref, p, kWidth, kHeight), hdr_flip(p, ref, kWidth, kHeight), hdr_flip(p, p, kWidth, kHeight)}) {
    EXPECT_TRUE(std::isnan(f.mean));
    EXPECT_TRUE(std::isnan(f.map[33]));
    EXPECT_FALSE(std::isnan(f.map.back()));
  }
}

// Pictures are looked at in tiles, which must not be seen: 900 x 500 has several each way, and a part of it that begins
// elsewhere has others. The filters reach 10 pixels.
TEST(Flip, DoesNotDependOnTilesOrThreads) {
  constexpr int kBigWidth = 900, kBigHeight = 500, kX = 101, kY = 57, kPartWidth = 700, kPartHeight = 400;
  const auto ref = picture(kBigWidth, kBigHeight, waves), test = picture(kBigWidth, kBigHeight, noisy);
  const Flip whole = flip(ref, test, kBigWidth, kBigHeight);
  const Flip part = flip(picture(kPartWidth, kPartHeight, moved(kX, kY, waves)),
                         picture(kPartWidth, kPartHeight, moved(kX, kY, noisy)), kPartWidth, kPartHeight);
  size_t differing = 0;
  for (int y = 10; y < kPartHeight - 10; ++y)
    for (int x = 10; x < kPartWidth - 10; ++x)
      differing += part.map[static_cast<size_t>(y * kPartWidth + x)] !=
                   whole.map[static_cast<size_t>((y + kY) * kBigWidth + x + kX)];
  EXPECT_EQ(differing, 0u);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const Flip alone = flip(ref, test, kBigWidth, kBigHeight);
  EXPECT_EQ(alone.map, whole.map);
  EXPECT_EQ(alone.mean, whole.mean);
}

}  // namespace
}  // namespace whit
