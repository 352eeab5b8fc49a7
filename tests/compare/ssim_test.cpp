#include "core/compare/ssim.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

#include "tests/compare/formula_pictures.h"

namespace whit {
namespace {

double similarity(int width, int height, const Formula& a, const Formula& b) {
  return structural_similarity(picture(width, height, a), picture(width, height, b), width, height);
}

double bright(int x, int y, int c) { return 0.98 + 0.001 * waves(x, y, c); }
double negative(int x, int y, int c) { return 1 - waves(x, y, c); }

// Expected values are those of scikit-image 0.26, for arrays of float32 that NumPy made by the same formulas in doubles:
// structural_similarity(a.astype(float), b.astype(float), data_range=1, channel_axis=-1, gaussian_weights=True, sigma=1.5,
// use_sample_covariance=False).
TEST(Ssim, AgreesWithScikitImage) {
  constexpr double kWithin = 1e-8;  // A millionth is what is asked for; both count in doubles.
  EXPECT_NEAR(similarity(64, 48, waves, noisy), 0.773388840, kWithin);
  EXPECT_NEAR(similarity(64, 48, edges, moved(1, 0, edges)), 0.672068205, kWithin);
  EXPECT_NEAR(similarity(64, 48, inner_edges, blurred_edges), 0.754739090, kWithin);
  EXPECT_NEAR(similarity(64, 48, waves, times(0.9, waves)), 0.989081291, kWithin);
  EXPECT_NEAR(similarity(64, 48, waves, swapped), 0.338275453, kWithin);
  EXPECT_NEAR(similarity(64, 48, times(0.02, edges), times(0.03, edges)), 0.933197073, kWithin);
  EXPECT_NEAR(similarity(64, 48, lines, grey), 0.688349562, kWithin);
  EXPECT_NEAR(similarity(64, 48, waves, with_pixel(1, waves)), 0.994900078, kWithin);
  EXPECT_NEAR(similarity(64, 48, waves, negative), -0.759755351, kWithin);
  // Small differences of large numbers.
  EXPECT_NEAR(similarity(64, 48, bright, moved(3, 0, bright)), 0.999855013, kWithin);
  // A single pixel that has all of the window inside, a row of them, and more than a tile.
  EXPECT_NEAR(similarity(11, 11, waves, noisy), 0.818758765, kWithin);
  EXPECT_NEAR(similarity(13, 40, waves, noisy), 0.772870471, kWithin);
  EXPECT_NEAR(similarity(900, 500, waves, noisy), 0.773117023, kWithin);
}

// scikit-image gives up on these. Expected values are means of the same formula with averages of SciPy 1.17,
// gaussian_filter(v, (1.5, 1.5, 0), truncate=3.5, mode="reflect"), over all pixels.
TEST(Ssim, MirrorsPicturesSmallerThanTheWindow) {
  EXPECT_NEAR(similarity(10, 40, waves, noisy), 0.732922555, 1e-8);
  EXPECT_NEAR(similarity(5, 3, waves, moved(2, 1, waves)), -0.085337449, 1e-8);
  EXPECT_NEAR(similarity(1, 1, waves, moved(2, 1, waves)), 0.874819382, 1e-8);
}

TEST(Ssim, IsOneOfEqualsAndNotANumberOfNan) {
  for (const int size : {1, 4, 11, 50}) EXPECT_EQ(similarity(size, size, noisy, noisy), 1);
  EXPECT_EQ(similarity(20, 20, times(0, waves), times(0, waves)), 1);
  const auto ref = picture(20, 20, waves);
  for (const float bad : {NAN, INFINITY}) {
    auto p = ref;
    p[700] = bad;
    EXPECT_TRUE(std::isnan(structural_similarity(ref, p, 20, 20)));
    EXPECT_TRUE(std::isnan(structural_similarity(p, p, 20, 20)));
  }
}

TEST(Ssim, DoesNotDependOnThreads) {
  const double all = similarity(900, 500, waves, noisy);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(similarity(900, 500, waves, noisy), all);
}

}  // namespace
}  // namespace whit
