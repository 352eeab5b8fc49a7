// Maps from the square: ranges, the values at known points, and uniformity.
#include "core/base/sampling.h"

#include <gtest/gtest.h>

#include <random>

namespace whit {
namespace {

TEST(ConcentricDisk, KnownPoints) {
  // The middles of the sides go to the ends of the axes, the corner to the diagonal, the centre to the centre.
  const Vec2f right = concentric_disk(1, 0.5f), top = concentric_disk(0.5f, 1), corner = concentric_disk(1, 1);
  EXPECT_NEAR((right - Vec2f(1, 0)).length(), 0, 1e-7);
  EXPECT_NEAR((top - Vec2f(0, 1)).length(), 0, 1e-7);
  EXPECT_NEAR((corner - Vec2f(std::sqrt(0.5f))).length(), 0, 1e-6);
  EXPECT_EQ(concentric_disk(0.5f, 0.5f), Vec2f(0, 0));
  EXPECT_NEAR((concentric_disk(0.25f, 0.5f) - Vec2f(-0.5f, 0)).length(), 0, 1e-7);
}

TEST(ConcentricDisk, IsUniform) {
  // Equal areas: the squared radius and the angle are uniform. 10 x 10 boxes, chi squared (99) below 160.
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform(0, 1);
  std::vector<double> box(100);
  for (int i = 0; i < 100000; ++i) {
    const Vec2f p = concentric_disk(uniform(random), uniform(random));
    ASSERT_LE(p.length(), 1 + 1e-6f);
    const double angle = std::atan2(p.y, p.x) / 6.2831853072 + 0.5;
    ++box[static_cast<size_t>(std::min(9.0, 10.0 * p.length2())) * 10 + static_cast<size_t>(std::min(9.0, 10 * angle))];
  }
  double chi2 = 0;
  for (const double b : box) chi2 += (b - 1000) * (b - 1000) / 1000;
  EXPECT_LT(chi2, 160);
}

TEST(UniformSphere, PolesAndUnitLength) {
  EXPECT_EQ(uniform_sphere(0.3f, 0).z, 1);
  EXPECT_EQ(uniform_sphere(0.3f, 0.5f).z, 0);
  // Next to the pole sin(theta) = 2 sqrt(v (1 - v)) keeps its digits where sqrt(1 - z^2) is 0.
  const Vec3f near_pole = uniform_sphere(0, 1e-10f);
  EXPECT_NEAR(near_pole.x, 2e-5, 1e-10);
  for (int i = 0; i <= 100; ++i) EXPECT_NEAR(uniform_sphere(0.01f * i, 0.01f * i).length(), 1, 3e-7);
}

}  // namespace
}  // namespace whit
