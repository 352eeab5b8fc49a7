// What is claimed of a picture's error, and which pixels are doubted.

#include "core/accuracy/film_error.h"

#include <gtest/gtest.h>

#include <random>

#include "core/compare/quantiles.h"

namespace whit {
namespace {

Picture grey(int width, int height, float value) {
  Picture p;
  p.resolution = {width, height};
  p.window = {{0, 0}, {width, height}};
  p.rgb.assign(3 * static_cast<size_t>(width * height), value);
  return p;
}

Doubts none(const Picture& p) {
  return {std::vector<uint8_t>(static_cast<size_t>(p.width() * p.window.max.y)), 0, {}, {}};
}

Doubts doubts_of(const Picture& p, const std::vector<float>& variance, int reach, uint32_t samples = 16) {
  return find_doubts(p, variance, std::vector<uint32_t>(variance.size() / 3, samples), reach);
}

TEST(ClaimError, IsTheRootOfTheMeanVarianceOverTheMeanRadiance) {
  // 64 x 32 pixels are 32 tiles of 8 x 8, each with three degrees of freedom: all alike they have 96 together.
  const Picture p = grey(64, 32, 2);
  const std::vector<float> variance(p.rgb.size(), 0.01f);
  const ErrorClaim c = claim_error(p, variance, none(p), 0.95);
  EXPECT_NEAR(c.value, 0.1 / 2, 1e-6);
  EXPECT_NEAR(c.freedom, 96, 1e-3);
  EXPECT_NEAR(c.high, 0.05 * std::sqrt(96 / chi_square_quantile(96, 0.05)), 1e-6);
  EXPECT_NEAR(c.low, 0.05 * std::sqrt(96 / chi_square_quantile(96, 0.95)), 1e-6);
}

TEST(ClaimError, OfOneNoisyTileHasItsFewDegreesOfFreedom) {
  const Picture p = grey(64, 32, 1);
  std::vector<float> variance(p.rgb.size(), 0.0f);
  for (int y = 8; y < 16; ++y) {
    for (int x = 16; x < 24; ++x) variance[static_cast<size_t>(3 * (y * 64 + x))] = 1;
  }
  EXPECT_NEAR(claim_error(p, variance, none(p), 0.95).freedom, 3, 1e-6);
}

TEST(ClaimError, LeavesOutWhatIsDoubted) {
  const Picture p = grey(16, 16, 1);
  std::vector<float> variance(p.rgb.size(), 0.04f);
  Doubts doubts = none(p);
  variance[0] = 1e6f, doubts.pixels[0] = 1, doubts.count = 1;
  const ErrorClaim c = claim_error(p, variance, doubts, 0.95);
  EXPECT_NEAR(c.value, 0.2, 1e-6);
  EXPECT_NEAR(c.freedom, 3, 1e-6);  // a tile of 16 x 16 with a doubt in it is one number
}

TEST(ClaimError, IsInfiniteWhereNothingIsKnown) {
  const Picture black = grey(8, 8, 0), p = grey(8, 8, 1);
  EXPECT_TRUE(std::isinf(claim_error(black, std::vector<float>(black.rgb.size(), 1), none(black), 0.95).high));
  const std::vector<float> unknown(p.rgb.size(), std::numeric_limits<float>::infinity());
  EXPECT_TRUE(std::isinf(claim_error(p, unknown, none(p), 0.95).high));
  EXPECT_EQ(claim_error(p, std::vector<float>(p.rgb.size(), 0), none(p), 0.95).high, 0);
}

TEST(ClaimError, HoldsAsOftenAsItSays) {
  // Pixels with normal errors whose size differs from tile to tile, known by four blocks: the error of the mean must be
  // below the bound in 95 of 100 pictures. Of 1000 trials, 0.95 +- 0.02 is three standard deviations.
  std::mt19937 random(1);
  std::normal_distribution<float> normal;
  int held = 0;
  constexpr int kTrials = 1000, kSize = 48;
  for (int trial = 0; trial < kTrials; ++trial) {
    Picture p = grey(kSize, kSize, 1);
    std::vector<float> variance(p.rgb.size());
    double squares = 0;
    for (size_t k = 0; k < p.rgb.size(); k += 3) {
      const size_t x = k / 3 % kSize, y = k / 3 / kSize;
      const float sigma = 0.01f * static_cast<float>(1 + (x / 8 * 7 + y / 8 * 3) % 5);
      float block[4], mean = 0;
      for (float& b : block) b = 2 * sigma * normal(random), mean += b / 4;
      float v = 0;
      for (const float b : block) v += (b - mean) * (b - mean) / 12;
      for (size_t c = 0; c < 3; ++c)
        p.rgb[k + c] = 1 + mean, variance[k + c] = v, squares += double{mean} * double{mean};
    }
    const double truth = std::sqrt(squares / static_cast<double>(p.rgb.size()));
    held += truth <= claim_error(p, variance, none(p), 0.95).high;
  }
  EXPECT_GT(held, 930);
}

TEST(FindDoubts, DoubtsTheNeighboursOfLamps) {
  Picture p = grey(48, 48, 1);
  const std::vector<float> variance(p.rgb.size(), 1);
  EXPECT_EQ(doubts_of(p, variance, 0).count, 0);
  for (size_t c = 0; c < 3; ++c) p.rgb[3 * (20 * 48 + 20) + c] = 100;
  const Doubts own = doubts_of(p, variance, 0);
  EXPECT_EQ(own.count, 8);
  EXPECT_EQ(own.where, Box2i({19, 19}, {21, 21}));
  EXPECT_FALSE(own.pixels[20 * 48 + 20]);
  ASSERT_EQ(own.densest.size(), 1u);
  EXPECT_EQ(own.densest[0], Vec2i(19, 19));
  EXPECT_EQ(doubts_of(p, variance, 1).count, 24);  // a filter that reaches a pixel further doubts another ring
}

TEST(FindDoubts, DoubtsQuietPixelsInNoise) {
  const Picture p = grey(32, 32, 1);
  std::vector<float> variance(p.rgb.size(), 1);
  for (size_t c = 0; c < 3; ++c) variance[3 * (10 * 32 + 10) + c] = 0.001f;
  EXPECT_EQ(doubts_of(p, variance, 0).count, 1);
  EXPECT_EQ(doubts_of(p, variance, 0, 8).count, 0);  // Eight samples may be alike by chance.
  // A quiet half is no pixel that has missed something.
  for (int y = 0; y < 32; ++y) std::fill_n(&variance[static_cast<size_t>(3 * 32 * y)], 48, 0.0f);
  EXPECT_EQ(doubts_of(p, variance, 0).count, 0);
}

TEST(FindDoubts, TakesWholeTilesWhereAFourthIsDoubted) {
  Picture p = grey(32, 32, 1);
  // Lamps on every third pixel of one tile: all others of it are beside one.
  for (int y = 1; y < 16; y += 3) {
    for (int x = 1; x < 16; x += 3) p.rgb[static_cast<size_t>(3 * (y * 32 + x))] = 1e6f;
  }
  const Doubts d = doubts_of(p, std::vector<float>(p.rgb.size(), 1), 0);
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 16; ++x) EXPECT_TRUE(d.pixels[static_cast<size_t>(y * 32 + x)]);
  }
  EXPECT_FALSE(d.pixels[20 * 32 + 20]);
}

}  // namespace
}  // namespace whit
