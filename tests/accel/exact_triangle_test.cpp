// Triangles in double precision: a square of 2e9 units whose diagonal and corner are looked at closely.
#include "core/accel/exact_triangle.h"

#include <gtest/gtest.h>

#include <random>

#include "core/accel/accel.h"

namespace whit {
namespace {

constexpr double kHalf = 1e9;

/// The square |x|, |y| <= kHalf in z = 0, turned about an axis, as two triangles with the diagonal x = y between them.
std::vector<ExactTriangle> square(const Mat4d& m) {
  const auto at = [&](double x, double y) { return transform_point(m, Vec3d(x, y, 0)); };
  const Vec3d a = at(-kHalf, -kHalf), b = at(kHalf, -kHalf), c = at(kHalf, kHalf), d = at(-kHalf, kHalf);
  return {exact_triangle(a, b, c), exact_triangle(a, c, d)};
}

TEST(ExactTriangle, HitsAreAsExactAsTheRay) {
  // From 5 above the point (x, y) straight down: t is 5, the weights of b and c are (x - y) / 2e9 and (y + 1e9) / 2e9.
  const std::vector<ExactTriangle> both = square(Mat4d());
  const Vec3d o(3.25, -1.5, 5), d(0, 0, -1);
  EXPECT_EQ(plane_distance(both[0], o, d), 5);
  EXPECT_TRUE(is_inside(both[0], o, d, 5));
  EXPECT_FALSE(is_inside(both[1], o, d, 5));
  const Vec2d weights = weights_at(both[0], {3.25, -1.5, 0});
  EXPECT_NEAR(weights.x, 4.75 / 2e9, 1e-16);
  EXPECT_NEAR(weights.y, (1e9 - 1.5) / 2e9, 1e-16);
}

TEST(ExactTriangle, NoRayPassesBetweenNeighbours) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int turn = 0; turn < 20; ++turn) {
    const Mat4d m =
        Mat4d().setAxisAngle(Vec3d(unit(random), unit(random), unit(random)).normalized(), 3 * unit(random));
    const std::vector<ExactTriangle> both = square(m);
    for (int i = 0; i < 5000; ++i) {
      // Onto the diagonal near the origin, to within the rounding of floats.
      const double s = 4 * unit(random);
      const Vec3d at = transform_point(m, {s, s, 0}), o(Vec3f(transform_point(m, {unit(random), unit(random), 3})));
      const Vec3d d(Vec3f((at - o).normalized()));
      int met = 0;
      for (const ExactTriangle& t : both) met += is_inside(t, o, d, plane_distance(t, o, d));
      EXPECT_GE(met, 1) << turn << ' ' << i;
    }
  }
}

TEST(ExactTriangle, ReachesOverAnEdgeOnlyWhereToldTo) {
  ExactTriangle t = square(Mat4d())[0];
  const Vec3d o(2, 2.001, 5), d(0, 0, -1);  // 0.001 / sqrt 2 beyond the diagonal ca
  EXPECT_FALSE(is_inside(t, o, d, 5));
  t.reach[2] = 7.2e-4;
  EXPECT_TRUE(is_inside(t, o, d, 5));
  t.reach[2] = 7e-4;
  EXPECT_FALSE(is_inside(t, o, d, 5));
}

TEST(ExactTriangle, TracedByTheRayTracer) {
  const std::vector<ExactTriangle> both = square(Mat4d());
  Accel accel({.robust = true, .small_scene = 0});
  accel.add_exact(Accel::kWorld, both, 4, nullptr);
  ASSERT_EQ(accel.build(), "");
  // Down onto either, up from above, and one that ends before.
  float ox[] = {3, -3, 3, 3}, oy[] = {1, 1, 1, 1}, oz[] = {5, 5, 5, 5}, dx[] = {0, 0, 0, 0}, dy[] = {0, 0, 0, 0};
  float dz[] = {-1, -1, 1, -1}, t_max[] = {INFINITY, INFINITY, INFINITY, 4.99f}, t[4], u[4], v[4];
  int32_t shape[4], instance[4];
  uint32_t prim[4];
  uint8_t blocked[4];
  const RayLanes rays{4, {ox, oy, oz}, {dx, dy, dz}, t_max};
  accel.intersect(rays, {t, shape, prim, instance, u, v}, false);
  accel.occluded(rays, blocked);
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(shape[i], i < 2 ? 4 : -1);
    EXPECT_EQ(blocked[i], i < 2 ? 1 : 0);
  }
  EXPECT_EQ(t[0], 5);
  EXPECT_EQ(prim[0], 0u);
  EXPECT_EQ(prim[1], 1u);
}

}  // namespace
}  // namespace whit
