#include "core/accuracy/measures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace whit {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

TEST(Measures, OfTwoPixels) {
  const std::vector<float> ref{1, 2, 3, 0, 0, 0}, x{1, 2, 4, 0, 0, 2};
  EXPECT_DOUBLE_EQ(mean_radiance(ref), 1);
  EXPECT_DOUBLE_EQ(mean_square_error(x, ref), 5.0 / 6);
  // Epsilon is 0.01: 1 / 9.01 and 4 / 0.01.
  EXPECT_NEAR(relative_mse(x, ref), (1 / 9.01 + 400) / 6, 1e-12);
  // 95 % of six are all six.
  EXPECT_DOUBLE_EQ(error_quantile95(x, ref), 2);
  EXPECT_EQ(relative_mse(ref, ref), 0);
}

TEST(Measures, QuantileLeavesAFewOut) {
  // Of 60 numbers with errors 1/64 to 60/64, 57 are not above 57/64.
  std::vector<float> ref(60, 1), x(60);
  for (size_t i = 0; i < 60; ++i) x[(7 * i) % 60] = 1 + static_cast<float>(i + 1) / 64;
  EXPECT_DOUBLE_EQ(error_quantile95(x, ref), 57.0 / 64);
}

TEST(Measures, ShareOfDisplayPixels) {
  const std::vector<float> ref{0, 0, 0, 0, 0, 0, 0.5f, 0.5f, 0.5f, 1, 1, 1};
  std::vector<float> x = ref;
  x[1] = 2.0f / 255;  // Just not more.
  x[4] = 2.1f / 255;
  x[9] = x[10] = 0.5f;
  EXPECT_DOUBLE_EQ(share_over_2_255(x, ref), 0.5);
  x[0] = NAN;
  EXPECT_DOUBLE_EQ(share_over_2_255(x, ref), 0.75);
}

TEST(Measures, OfNoNumbersAreNoNumbers) {
  const std::vector<float> ref{1, 2, 3, 4, 5, 6};
  for (float bad : {NAN, kInfinity}) {
    std::vector<float> x = ref;
    x[2] = bad;
    EXPECT_FALSE(std::isfinite(mean_radiance(x)));
    EXPECT_FALSE(std::isfinite(mean_square_error(x, ref)));
    EXPECT_FALSE(std::isfinite(relative_mse(x, ref)));
    EXPECT_FALSE(std::isfinite(error_quantile95(x, ref)));
    EXPECT_TRUE(worst_pixels(x, ref).pixels.empty());
    EXPECT_FALSE(std::isfinite(halves_noise(x, ref, 2).mse));
  }
}

TEST(WorstPixels, CarryHalf) {
  // Squared errors 1, 9, 4, 4, of 18.
  const std::vector<float> ref(12, 0), x{1, 0, 0, 0, 3, 0, 0, 0, 2, 2, 0, 0};
  const WorstPixels worst = worst_pixels(x, ref);
  EXPECT_EQ(worst.pixels, (std::vector<size_t>{1}));
  EXPECT_DOUBLE_EQ(worst.shares[0], 0.5);
  // Equal ones in the order of the picture.
  EXPECT_EQ(worst_pixels(std::vector<double>{1, 2, 2, 2}).pixels, (std::vector<size_t>{1, 2}));
  EXPECT_TRUE(worst_pixels(ref, ref).pixels.empty());
}

// Noise of the given deviation, `alike` neighbours in a row sharing each value.
std::vector<float> noise(int width, int height, double deviation, int alike, uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(1, deviation);
  std::vector<float> rgb;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c)
        rgb.push_back(x % alike == 0 ? static_cast<float>(normal(random)) : rgb[rgb.size() - 3]);
  return rgb;
}

TEST(HalvesNoise, IsHalfOfEachsAndKnowsHowWell) {
  // Halves of variance 0.04 have a mean of variance 0.02. Blocks of 48 independent squares each make up 256 blocks; the
  // mean square of a block is above its variance (2 / 48 of its squared mean) by that square: 512 / (1 + 2 / 48).
  const ReferenceNoise n = halves_noise(noise(64, 64, 0.2, 1, 1), noise(64, 64, 0.2, 1, 2), 64);
  EXPECT_NEAR(n.mse, 0.02, 0.02 * 4 * std::sqrt(2.0 / (64 * 64 * 3)));
  EXPECT_NEAR(n.freedom, 512 / (1 + 2.0 / 48), 10);
  // Neighbours that are alike leave less: each block has 12 independent numbers.
  EXPECT_NEAR(halves_noise(noise(64, 64, 0.2, 4, 1), noise(64, 64, 0.2, 4, 2), 64).freedom, 512 / (1 + 2.0 / 12), 20);
  // One pixel with all of the noise is one degree of freedom or two.
  std::vector<float> a(3 * 64 * 64, 1), b = a;
  b[300] = 2;
  EXPECT_NEAR(halves_noise(a, b, 64).freedom, 2, 1e-9);
  EXPECT_EQ(halves_noise(a, a, 64).mse, 0);
  // Pictures smaller than a block, and not multiples of it.
  EXPECT_GE(halves_noise(noise(5, 3, 1, 1, 1), noise(5, 3, 1, 1, 2), 5).freedom, 1);
}

TEST(ErrorProducts, AreMeansOfProducts) {
  const std::vector<float> ref{1, 1, 1}, a{2, 1, 1}, b{3, 1, 4}, c{1, 1, 1};
  const std::vector<std::span<const float>> pictures{a, b, c}, refs{ref, ref, ref};
  // Errors (1, 0, 0), (2, 0, 3), (0, 0, 0).
  const std::vector<double> expected{1.0 / 3, 2.0 / 3, 0, 2.0 / 3, 13.0 / 3, 0, 0, 0, 0};
  EXPECT_EQ(error_products(pictures, ref).products, expected);
  EXPECT_EQ(difference_products(pictures, refs).products, expected);
}

}  // namespace
}  // namespace whit
