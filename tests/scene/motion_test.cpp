// Animated transforms: what is taken apart goes together again, and the way between two transforms is the known one.
#include "core/scene/motion.h"

#include <gtest/gtest.h>

#include <cmath>

namespace whit {
namespace {

constexpr double kDegree = M_PI / 180;

Mat4d translation(double x, double y, double z) { return Mat4d().setTranslation(Vec3d(x, y, z)); }
Mat4d scaling(double x, double y, double z) { return Mat4d().setScale(Vec3d(x, y, z)); }
/// About z, counter-clockwise: x goes to (cos, sin).
Mat4d rotation_z(double degrees) {
  const double c = std::cos(degrees * kDegree), s = std::sin(degrees * kDegree);
  return {c, s, 0, 0, -s, c, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
}

void expect_near(const Mat4d& a, const Mat4d& b, double tolerance) {
  for (int r = 0; r < 4; ++r) {
    for (int c = 0; c < 4; ++c) EXPECT_NEAR(a[r][c], b[r][c], tolerance) << "row " << r << ", column " << c;
  }
}

Mat4d composed(const DecomposedTransform& d) {
  return d.stretch * d.rotation.toMatrix44() * translation(d.translation.x, d.translation.y, d.translation.z);
}

TEST(Decompose, GivesThePartsItWasMadeOf) {
  const DecomposedTransform d = decompose(scaling(2, 3, 5) * rotation_z(40) * translation(7, -8, 9));
  expect_near(d.stretch, scaling(2, 3, 5), 1e-13);
  expect_near(d.rotation.toMatrix44(), rotation_z(40), 1e-13);
  EXPECT_EQ(d.translation, Vec3d(7, -8, 9));
}

TEST(Decompose, ComposesAgainWhateverTheSizeAndHandedness) {
  // A shear, a mirroring, and sizes that a polar iteration with an absolute tolerance would not survive.
  Mat4d shear;
  shear[1][0] = 0.8;
  for (const double size : {1e-12, 1.0, 1e9}) {
    for (const Mat4d& odd : {Mat4d(), shear, scaling(-1, 1, 1), scaling(1, 1, -3) * shear}) {
      const Mat4d m = odd * scaling(size, size, size) * rotation_z(77) * translation(1, 2, 3);
      expect_near(composed(decompose(m)), m, 1e-13 * std::max(size * 4, 4.0));
      const Mat4d r = decompose(m).rotation.toMatrix44();
      expect_near(r * r.transposed(), Mat4d(), 1e-12);
      EXPECT_FALSE(swaps_handedness(r));
    }
  }
}

TEST(Interpolate, HalfWayOfARotationIsHalfTheAngle) {
  const TransformPair pair{rotation_z(10), rotation_z(90)};
  expect_near(interpolate(pair, 0.5), rotation_z(50), 1e-13);
  expect_near(interpolate(pair, 0.25), rotation_z(30), 1e-13);
}

TEST(Interpolate, TakesTheShorterArc) {
  // From -100 to 100 degrees the shorter way, 160 degrees, leads over 180.
  expect_near(interpolate({rotation_z(-100), rotation_z(100)}, 0.5), rotation_z(180), 1e-12);
}

TEST(Interpolate, TranslationsAndScalesAreLinear) {
  const TransformPair pair{scaling(1, 1, 1) * translation(0, 0, 0), scaling(3, 1, 1) * translation(8, -4, 2)};
  expect_near(interpolate(pair, 0.25), scaling(1.5, 1, 1) * translation(2, -1, 0.5), 1e-14);
}

TEST(Interpolate, TheEndsAreTheMatricesThemselves) {
  const TransformPair pair{rotation_z(12.3) * translation(0.1, 0.2, 0.3), scaling(0.7, 1, 2) * rotation_z(-33)};
  EXPECT_EQ(interpolate(pair, 0), pair.start);
  EXPECT_EQ(interpolate(pair, -1), pair.start);
  EXPECT_EQ(interpolate(pair, 1), pair.end);
  EXPECT_EQ(interpolate(pair, 2), pair.end);
  EXPECT_EQ(interpolate({pair.start, pair.start}, 0.7), pair.start);
}

TEST(Keyframes, AsManyAsTheMotionNeeds) {
  EXPECT_EQ(keyframes({rotation_z(20), rotation_z(20)}).size(), 1u);
  EXPECT_EQ(keyframes({translation(0, 0, 0), translation(1, 2, 3)}).size(), 2u);
  EXPECT_EQ(keyframes({Mat4d(), scaling(1, 2, 3)}).size(), 2u);
  // ceil(80 / 1.5) = 54 steps; 180 / 1.5 = 120 steps, as many as there can be.
  EXPECT_EQ(keyframes({rotation_z(10), rotation_z(90)}).size(), 55u);
  EXPECT_LE(keyframes({rotation_z(0), rotation_z(179.9)}).size(), 129u);
}

TEST(Keyframes, TranslationIsExactEverywhere) {
  // All numbers are small multiples of powers of two: every step is exact.
  const auto keys = keyframes({translation(-1, 0, 4), translation(3, 1, 0)});
  EXPECT_EQ(interpolate_keys(keys, 0.25), translation(0, 0.25, 3));
  EXPECT_EQ(interpolate_keys(keys, 0), translation(-1, 0, 4));
  EXPECT_EQ(interpolate_keys(keys, 1), translation(3, 1, 0));
  EXPECT_EQ(interpolate_keys(keys, 1.5), translation(3, 1, 0));  // beyond the ends nothing moves
}

TEST(Keyframes, LinearBetweenThemStaysCloseToTheArc) {
  // The chord of 1.5 degrees leaves the arc by 1 - cos(0.75 degrees) = 8.6e-5 at most.
  const TransformPair pair{rotation_z(0), rotation_z(120)};
  const auto keys = keyframes(pair);
  double worst = 0;
  for (double s = 0; s <= 1; s += 1 / 997.0) {
    const Vec3d a = transform_point(interpolate_keys(keys, s), {1, 0, 0});
    worst = std::max(worst, (a - Vec3d(std::cos(120 * s * kDegree), std::sin(120 * s * kDegree), 0)).length());
  }
  EXPECT_LE(worst, 8.6e-5);
  EXPECT_GT(worst, 4e-5);  // and it is made of chords
}

}  // namespace
}  // namespace whit
