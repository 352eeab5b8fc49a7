// Noise and sums of its octaves: values, limits to the footprint, and the same bits in every batch.
#include "core/base/noise.h"

#include <gtest/gtest.h>

#include <random>
#include <set>
#include <vector>

namespace whit {
namespace {

TEST(Noise, TableIsAPermutationTwice) {
  const int32_t* p = detail::kNoisePermutation;
  EXPECT_EQ(std::set<int32_t>(p, p + 256).size(), 256u);
  EXPECT_TRUE(std::equal(p, p + 256, p + 256));
}

TEST(Noise, IsZeroOnTheLatticeAndRepeats) {
  for (int i = -300; i < 300; i += 7) {
    const auto x = static_cast<float>(i);
    EXPECT_EQ(perlin_noise(x, -x, 3 * x), 0);
    EXPECT_EQ(perlin_noise(x + 0.25f, 0.5f, 0.75f), perlin_noise(x + 256.25f, 256.5f, -255.25f));
  }
}

TEST(Noise, HasTheGradientOfTheLatticePoint) {
  // Next to the origin, whose hash is that of entry p[p[p[0]]] = p[p[151]] = p[17] = 36, 36 & 15 = 4: x + z.
  ASSERT_EQ(detail::kNoisePermutation[detail::kNoisePermutation[detail::kNoisePermutation[0]]] & 15, 4);
  constexpr float e = 1e-3f;
  EXPECT_NEAR(perlin_noise(e, 0, 0), e, 1e-6);
  EXPECT_NEAR(perlin_noise(0, e, 0), 0, 1e-6);
  EXPECT_NEAR(perlin_noise(0, 0, e), e, 1e-6);
}

TEST(Noise, IsBoundedContinuousAndWithoutMean) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> u(-200, 200);
  double sum = 0;
  for (int i = 0; i < 20000; ++i) {
    const float x = u(random), y = u(random), z = u(random), n = perlin_noise(x, y, z);
    ASSERT_LE(std::abs(n), 1.1f);
    ASSERT_NEAR(perlin_noise(x + 1e-3f, y, z), n, 5e-3);
    sum += static_cast<double>(n);
  }
  EXPECT_NEAR(sum / 20000, 0, 0.01);
}

TEST(Noise, AnyNumberIsAllowed) {
  for (const float x : {1e10f, -1e30f, 3e38f}) EXPECT_TRUE(std::isfinite(perlin_noise(x, -x, 0.5f)));
  EXPECT_TRUE(std::isfinite(perlin_noise(std::numeric_limits<float>::infinity(), std::nanf(""), 0)));
}

struct Points {
  explicit Points(int n, float width2) : x(n), y(n), z(n), w(n, width2), out(n) {
    std::mt19937 random(3);
    std::normal_distribution<float> g(0, 4);
    for (int i = 0; i < n; ++i) x[i] = g(random), y[i] = g(random), z[i] = g(random);
  }
  NoisePoints points(int first, int n) const {
    return {n, x.data() + first, y.data() + first, z.data() + first, w.data() + first};
  }
  std::vector<float> x, y, z, w, out;
};

TEST(Octaves, WithoutAWidthAllAreAdded) {
  Points p(50, 0);
  fbm(p.points(0, 50), 1, 3, 0.5f, p.out.data());
  for (int i = 0; i < 50; ++i) {
    const auto octave = [&](float l) { return perlin_noise(l * p.x[i], l * p.y[i], l * p.z[i]); };
    const float fine = 1.99f * 1.99f;
    EXPECT_NEAR(p.out[i], octave(1) + 0.5f * octave(1.99f) + 0.25f * octave(fine), 1e-6);
  }
  turbulence(p.points(0, 50), 1, 2, 0.5f, p.out.data());
  for (int i = 0; i < 50; ++i) {
    const auto octave = [&](float l) { return std::abs(perlin_noise(l * p.x[i], l * p.y[i], l * p.z[i])); };
    // The octave after the last counts with its mean, as in pbrt-v3.
    EXPECT_NEAR(p.out[i], octave(1) + 0.5f * octave(1.99f) + 0.25f * 0.2f, 1e-6);
  }
}

TEST(Octaves, WiderThanAllOfThemTheMeanRemains) {
  Points p(20, 100);
  fbm(p.points(0, 20), 1, 8, 0.5f, p.out.data());
  EXPECT_EQ(p.out, std::vector<float>(20, 0.0f));
  turbulence(p.points(0, 20), 1, 3, 0.5f, p.out.data());
  for (const float v : p.out) EXPECT_NEAR(v, 0.2 * (1 + 1 + 0.5 + 0.25), 1e-6);
}

TEST(Octaves, BatchOfNEqualsNBatchesOfOne) {
  Points p(300, 0);
  for (int i = 0; i < 300; ++i) p.w[i] = std::pow(0.25f, static_cast<float>(i % 13));
  for (const auto sum : {fbm, turbulence}) {
    sum(p.points(0, 300), 0.7f, 6, 0.6f, p.out.data());
    for (int i = 0; i < 300; ++i) {
      float alone = 0;
      sum(p.points(i, 1), 0.7f, 6, 0.6f, &alone);
      EXPECT_EQ(alone, p.out[i]);
    }
  }
}

}  // namespace
}  // namespace whit
