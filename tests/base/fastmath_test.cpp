#include "core/base/fastmath.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "core/batch/lanes.h"

namespace whit {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();

/// The distance of `got` from the exact value, in units of the last place of a float at that value.
double ulps(float got, long double exact) {
  const float rounded = static_cast<float>(exact);
  const float magnitude = std::max(std::abs(rounded), std::numeric_limits<float>::min());
  const long double ulp = static_cast<long double>(std::nextafter(magnitude, kInf)) - magnitude;
  return static_cast<double>(std::abs(got - exact) / ulp);
}

/// The worst error of f against `exact` over many points of [lo, hi].
double worst(float lo, float hi, const std::function<float(float)>& f,
             const std::function<long double(long double)>& exact) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> x(lo, hi);
  double most = 0;
  for (int i = 0; i < 400000; ++i) {
    const float v = i == 0 ? lo : (i == 1 ? hi : x(random));
    most = std::max(most, ulps(f(v), exact(v)));
  }
  return most;
}

// 0.5 ulp is correct rounding; the polynomials add below 0.01.
constexpr double kLimit = 0.51;

TEST(FastMath, SineAndCosine) {
  for (const float range : {1.0f, 10.0f, 1e4f, 1e6f}) {
    EXPECT_LT(worst(-range, range, sin_of, sinl), kLimit) << range;
    EXPECT_LT(worst(-range, range, cos_of, cosl), kLimit) << range;
  }
  EXPECT_LT(worst(-10, 10, tan_of, tanl), 2.0);
}

TEST(FastMath, SineNearMultiplesOfPiKeepsItsDigits) {
  // The float next to k pi has a sine of up to half its ulp: what remains after the reduction is all there is.
  for (int k = 1; k < 3000; ++k) {
    const float x = static_cast<float>(k * 3.14159265358979323846);
    EXPECT_LT(ulps(sin_of(x), sinl(x)), kLimit) << k;
  }
}

TEST(FastMath, SinCosOfTurns) {
  const long double two_pi = 6.283185307179586476925286766559L;
  EXPECT_LT(worst(
                0, 0.999f, [](float u) { return sin_cos_2pi(u).sin; }, [=](long double u) { return sinl(two_pi * u); }),
            kLimit);
  EXPECT_LT(worst(
                0, 0.999f, [](float u) { return sin_cos_2pi(u).cos; }, [=](long double u) { return cosl(two_pi * u); }),
            kLimit);
  EXPECT_EQ(sin_cos_2pi(0.25f).sin, 1);
  EXPECT_EQ(sin_cos_2pi(0.25f).cos, 0);
  EXPECT_EQ(sin_cos_2pi(0.5f).cos, -1);
}

TEST(FastMath, ExponentialAndLogarithm) {
  EXPECT_LT(worst(-87, 88, exp_of, expl), kLimit);
  EXPECT_LT(worst(1e-6f, 2, log_of, logl), kLimit);
  EXPECT_LT(worst(1, 1e38f, log_of, logl), kLimit);
  EXPECT_LT(worst(0.999f, 1.001f, log_of, logl), kLimit);
  EXPECT_EQ(exp_of(0), 1);
  EXPECT_EQ(log_of(1), 0);
  EXPECT_EQ(log_of(0), -kInf);
  EXPECT_EQ(log_of(kInf), kInf);
  EXPECT_TRUE(std::isnan(log_of(-1)));
  EXPECT_TRUE(std::isnan(log_of(NAN)));
  EXPECT_EQ(exp_of(-1000), 0);
  EXPECT_EQ(exp_of(1000), kInf);
  EXPECT_EQ(exp_of(-kInf), 0);
}

TEST(FastMath, Power) {
  for (const float y : {0.4545f, 2.4f, -1.5f, 5.0f, 0.01f}) {
    EXPECT_LT(worst(
                  1e-4f, 10, [=](float x) { return pow_of(x, y); }, [=](long double x) { return powl(x, y); }),
              kLimit)
        << y;
  }
  EXPECT_EQ(pow_of(0, 2), 0);
  EXPECT_EQ(pow_of(0, 0), 1);
  EXPECT_EQ(pow_of(0, -1), kInf);
  EXPECT_EQ(pow_of(kInf, 0.5f), kInf);
  EXPECT_EQ(pow_of(kInf, -1), 0);
  EXPECT_EQ(pow_of(1, 1e30f), 1);
  EXPECT_EQ(pow_of(-2, 2), 0) << "negative bases count as 0";
}

TEST(FastMath, InverseTrigonometry) {
  EXPECT_LT(worst(-1, 1, asin_of, asinl), kLimit);
  EXPECT_LT(worst(-1, 1, acos_of, acosl), kLimit);
  EXPECT_LT(worst(0.9999f, 1, acos_of, acosl), kLimit);
  EXPECT_EQ(acos_of(1.0000002f), 0);
  EXPECT_EQ(asin_of(-1.5f), -kPiOver2);
  std::mt19937 random(2);
  std::uniform_real_distribution<float> x(-1, 1);
  double most = 0;
  for (int i = 0; i < 400000; ++i) {
    const float a = x(random), b = x(random);
    most = std::max(most, ulps(atan2_of(a, b), atan2l(a, b)));
  }
  EXPECT_LT(most, kLimit);
  EXPECT_EQ(atan2_of(0, 0), 0);
  EXPECT_EQ(atan2_of(0, -1), kPi);
  EXPECT_EQ(atan2_of(1e-38f, 1e38f), 0);
}

TEST(FastMath, NormalizesTinyAndHugeVectors) {
  for (const float scale : {1e-37f, 1e-20f, 1.0f, 1e20f, 3e37f}) {
    const Vec3f n = normalize_any(Vec3f(1, 2, -2) * scale);
    EXPECT_NEAR(n.x, 1.0 / 3, 1e-6) << scale;
    EXPECT_NEAR(n.z, -2.0 / 3, 1e-6) << scale;
  }
  EXPECT_EQ(normalize_any(Vec3f(0, 0, 0)), Vec3f(0, 0, 0));
  EXPECT_EQ(normalize(Vec3f(0, 0, 0)), Vec3f(0, 0, 0));
}

TEST(FastMath, CoordinateSystemIsOrthonormalAndRightHanded) {
  std::mt19937 random(3);
  std::normal_distribution<float> x;
  for (int i = 0; i < 1000; ++i) {
    Vec3f n = normalize(Vec3f(x(random), x(random), x(random)));
    if (i < 2) n = Vec3f(0, 0, i == 0 ? 1.0f : -1.0f);
    const Frame f = coordinate_system(n);
    EXPECT_NEAR(length(f.s), 1, 1e-6);
    EXPECT_NEAR(dot(f.s, n), 0, 1e-6);
    EXPECT_NEAR(length(cross(f.s, f.t) - n), 0, 2e-6);
  }
}

TEST(FastMath, LanesDoNotDependOnTheBatch) {
  std::vector<float> x(67), together(67), alone(67);
  for (size_t i = 0; i < x.size(); ++i) x[i] = static_cast<float>(i) * 1.37f - 40;
  const auto kernel = [](int n, const float* in, float* out) {
    for_lanes(n, [&](int i) {
      const SinCos sc = sin_cos(in[i]);
      out[i] = pow_of(std::abs(in[i]), 0.3f) + exp_of(sc.sin) * log_of(2 + sc.cos) + atan2_of(sc.sin, in[i]);
    });
  };
  kernel(static_cast<int>(x.size()), x.data(), together.data());
  for (size_t i = 0; i < x.size(); ++i) kernel(1, &x[i], &alone[i]);
  EXPECT_EQ(together, alone);
}

}  // namespace
}  // namespace whit
