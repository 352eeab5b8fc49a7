#include "core/base/quadratic.h"

#include <gtest/gtest.h>

#include <cmath>

namespace whit {
namespace {

bool solve(double a, double half_b, double c, double& t0, double& t1) {
  return solve_quadratic({a, 0}, {half_b, 0}, {c, 0}, t0, t1);
}

TEST(DoubleDouble, SumsAndProductsAreExact) {
  const DoubleDouble s = exact_sum(1e16, 1.25);
  EXPECT_EQ(s.hi, 1e16 + 1.25);
  EXPECT_EQ((s.hi - 1e16) + s.lo, 1.25);
  // (1 + 2^-30)^2 = 1 + 2^-29 + 2^-60: the last term does not fit a double.
  const DoubleDouble p = exact_product(1 + 0x1p-30, 1 + 0x1p-30);
  EXPECT_EQ(p.hi, 1 + 0x1p-29);
  EXPECT_EQ(p.lo, 0x1p-60);
}

TEST(DoubleDouble, DifferencesKeepTheirDigits) {
  const DoubleDouble third{1.0 / 3, 0x1.5555555555555p-56};  // 1/3 to 106 bits
  const DoubleDouble rest = DoubleDouble{1, 0} - third * DoubleDouble{3, 0};
  EXPECT_LT(std::abs(rest.hi), 1e-31);
  EXPECT_EQ(quotient({1, 0}, {3, 0}), 1.0 / 3);
}

TEST(SolveQuadratic, SimpleRoots) {
  double t0, t1;
  ASSERT_TRUE(solve(1, -1.5, 2, t0, t1));  // t^2 - 3 t + 2
  EXPECT_EQ(t0, 1);
  EXPECT_EQ(t1, 2);
  ASSERT_TRUE(solve(-1, 1.5, -2, t0, t1));
  EXPECT_EQ(t0, 1);
  EXPECT_EQ(t1, 2);
  EXPECT_FALSE(solve(1, 0, 1, t0, t1));
}

TEST(SolveQuadratic, NoDigitIsLostBetweenSmallAndLargeRoots) {
  // (t - 1e-10)(t - 1e10): the textbook formula returns 0 for the small root.
  double t0, t1;
  ASSERT_TRUE(solve_quadratic({1, 0}, exact_product(-0.5, 1e10) + exact_product(-0.5, 1e-10),
                              exact_product(1e10, 1e-10), t0, t1));
  EXPECT_DOUBLE_EQ(t0, 1e-10);
  EXPECT_DOUBLE_EQ(t1, 1e10);
}

TEST(SolveQuadratic, CloseRootsAreTold) {
  // Roots 1 and 1 + 2^-40: b^2 - ac is 2^-82, which doubles cannot see beside 1.
  const double r = 1 + 0x1p-40;
  double t0, t1;
  ASSERT_TRUE(solve(1, -(1 + r) / 2, r, t0, t1));
  EXPECT_EQ(t0, 1);
  EXPECT_EQ(t1, r);
  ASSERT_TRUE(solve(1, -1, 1, t0, t1));  // double root
  EXPECT_EQ(t0, 1);
  EXPECT_EQ(t1, 1);
}

TEST(SolveQuadratic, LinearAndEmptyEquations) {
  double t0, t1;
  ASSERT_TRUE(solve(0, 1, -4, t0, t1));  // 2 t - 4
  EXPECT_TRUE(t0 == 2 || t1 == 2);
  EXPECT_TRUE(std::isinf(t0) || std::isinf(t1));
  solve(0, 0, 1, t0, t1);
  EXPECT_FALSE(std::isfinite(t0));
  EXPECT_FALSE(std::isfinite(t1));
}

TEST(AxialQuadric, ProjectsOntoItself) {
  const AxialQuadric cone{1, -0.25, 0, 0};
  const Vec3d p = cone.project({1 + 1e-6, 0, 2});
  EXPECT_NEAR(p.x * p.x + p.y * p.y - 0.25 * p.z * p.z, 0, 1e-15);
  EXPECT_EQ(cone.project({0, 0, 0}), Vec3d(0, 0, 0));
}

TEST(Weingarten, AgreesWithTheClosedFormOfRevolution) {
  // A cone: r = 2 - v, z = 3 v; for phi = 1.3 u at azimuth 0.
  const double phi_max = 1.3, v = 0.4;
  SurfaceDerivatives s = revolve({2 - v, -1, 3, 0}, {1, 0}, phi_max);
  SurfaceDerivatives w = s;
  weingarten(Vec3d(-(2 - v), 0, 0) * (phi_max * phi_max), Vec3d(0, -1, 0) * phi_max, Vec3d(0), w);
  EXPECT_LT((s.dndu - w.dndu).length(), 1e-14);
  EXPECT_LT((s.dndv - w.dndv).length(), 1e-14);
}

TEST(Azimuth, RunsFromZeroToAFullTurn) {
  EXPECT_EQ(azimuth(1, 0), 0);
  EXPECT_EQ(azimuth(0, 0), 0);
  EXPECT_DOUBLE_EQ(azimuth(0, -1), 1.5 * kPiD);
  EXPECT_LE(azimuth(1, -1e-300), 2 * kPiD);
  EXPECT_TRUE(Sweep(360).covers(1, -1e-300));
  EXPECT_FALSE(Sweep(180).covers(0, -1));
}

}  // namespace
}  // namespace whit
