// The sphere: the last digits of its roots at any distance, its parameters, and its cone of light.
#include <cmath>

#include "core/base/quadratic.h"
#include "shape_support.h"

namespace whit::shape_test {
namespace {

/// |o + t d|^2 - 1 in 106 bits: the sign says on which side of the root t lies.
double outside(const Vec3d& o, const Vec3d& d, double t) {
  DoubleDouble sum{-1, 0};
  for (int c = 0; c < 3; ++c) {
    const DoubleDouble p = exact_product(t, d[c]) + DoubleDouble{o[c], 0};
    sum = sum + p * p;
  }
  return sum.hi;
}

double ulps_after(double t, int n) {
  for (; n > 0; --n) t = std::nextafter(t, INFINITY);
  for (; n < 0; ++n) t = std::nextafter(t, -INFINITY);
  return t;
}

TEST(Sphere, RootsAreWithinTwoUlpAtAnyDistance) {
  Made made("sphere", {});
  Numbers u;
  int tested = 0;
  for (int i = 0; i < 200000; ++i) {
    const Vec3d o = u.direction() * std::pow(10, u.between(1, 6));
    const Vec3d p = u.direction();  // any point of the sphere, many of them nearly at the rim
    Vec3d d = p - o;
    if (i % 2) d *= u.between(1e-6, 1e6);
    const double t = intersect(made.analytic(), o, d);
    if (t == 1e300) {
      // Only a ray within rounding of the rim may miss.
      ASSERT_LT(std::abs(p.dot(d.normalized())), 1e-4) << i;
      continue;
    }
    // Where the ray grazes so that both roots are a few ulp apart there is no sign to look at.
    if (outside(o, d, ulps_after(t, 1000)) > 0) continue;
    ++tested;
    ASSERT_GE(outside(o, d, ulps_after(t, -2)), 0) << i << " t " << t;
    ASSERT_LE(outside(o, d, ulps_after(t, 2)), 0) << i << " t " << t;
  }
  EXPECT_GT(tested, 190000);
}

TEST(Sphere, TangentAndPassingRays) {
  Made made("sphere", {});
  // x = 1 touches the sphere at y = z = 0, from a million radii away.
  EXPECT_EQ(intersect(made.analytic(), {1, -1e6, 0}, {0, 1, 0}), 1e6);
  EXPECT_EQ(intersect(made.analytic(), {1 + 0x1p-52, -1e6, 0}, {0, 1, 0}), 1e300);
  EXPECT_LT(intersect(made.analytic(), {1 - 0x1p-53, -1e6, 0}, {0, 1, 0}), 1e6);
}

TEST(Sphere, RaysFromInsideAndFromTheSurface) {
  Made made("sphere", {});
  EXPECT_DOUBLE_EQ(intersect(made.analytic(), {0.5, 0, 0}, {2, 0, 0}), 0.25);
  EXPECT_DOUBLE_EQ(intersect(made.analytic(), {1, 0, 0}, {-1, 0, 0}, 1e-12), 2);
  EXPECT_EQ(intersect(made.analytic(), {1, 0, 0}, {1, 0, 0}, 1e-12), 1e300);
}

TEST(Sphere, BatchesGiveTheBitsOfSingleRays) {
  Made made("sphere", {});
  Numbers u(9);
  const int n = 37;
  double o[3][n], d[3][n], t_min[n] = {}, t[n];
  for (int i = 0; i < n; ++i) {
    for (int c = 0; c < 3; ++c) o[c][i] = u.between(-3, 3), d[c][i] = -o[c][i] + u.between(-1, 1);
    t[i] = 1e300;
  }
  made.analytic().intersect({n, o[0], o[1], o[2], d[0], d[1], d[2], t_min, t});
  for (int i = 0; i < n; ++i) {
    EXPECT_EQ(t[i], intersect(made.analytic(), {o[0][i], o[1][i], o[2][i]}, {d[0][i], d[1][i], d[2][i]}));
  }
}

TEST(Sphere, PartsLetRaysThroughToTheFarSide) {
  // Only the half with y >= 0 is there (phi from 0 to 180): a ray from -y passes the near root.
  Made half("sphere", {floats("phimax", {180})});
  EXPECT_DOUBLE_EQ(intersect(half.analytic(), {0, -3, 0.1}, {0, 1, 0}), 3 + std::sqrt(1 - 0.01));
  // Only the bottom, below z = -0.6, given the wrong way round: the ray from above hits it from inside.
  Made bottom("sphere", {floats("zmin", {-0.6}), floats("zmax", {-5})});
  ASSERT_TRUE(bottom.ok()) << bottom.said();
  EXPECT_DOUBLE_EQ(intersect(bottom.analytic(), {0.1, 0, 3}, {0, 0, -1}), 3 + std::sqrt(1 - 0.01));
  EXPECT_EQ(intersect(bottom.analytic(), {0.9, 0, 3}, {0, 0, -1}), 1e300);
}

TEST(Sphere, ParametersRunAsInPbrt) {
  Made made("sphere", {floats("radius", {2})});
  // v is 0 at zmin (theta = 180 degrees) and 1 at zmax.
  EXPECT_NEAR(made.analytic().surface({0, 0, -2}).v, 0, 1e-12);
  EXPECT_NEAR(made.analytic().surface({0, 0, 2}).v, 1, 1e-12);
  EXPECT_NEAR(made.analytic().surface({0, 2, 0}).u, 0.25, 1e-12);
  EXPECT_NEAR(made.analytic().surface({2 * std::sqrt(0.5), -2 * std::sqrt(0.5), 0}).u, 0.875, 1e-12);
  // Quarter sphere: zmin 0, so v = 0 at the equator; phimax 90, so u = phi / 90 degrees.
  Made part("sphere", {floats("zmin", {0}), floats("phimax", {90})});
  const double r = std::sqrt(0.5) * std::sqrt(0.5);
  const SurfacePoint s = part.analytic().surface({r, r, std::sqrt(0.5)});
  EXPECT_NEAR(s.u, 0.5, 1e-12);
  EXPECT_NEAR(s.v, 0.5, 1e-12);
  // dpdu = (-phimax y, phimax x, 0).
  EXPECT_NEAR(s.dpdu.x, -M_PI / 2 * r, 1e-12);
  EXPECT_NEAR(s.dpdu.y, M_PI / 2 * r, 1e-12);
}

TEST(Sphere, PdfKeepsItsDigitsFarAway) {
  Made made("sphere", {});
  for (const double scale : {1.0, 1e-3, 3.0}) {
    made.analytic().place(Mat4d().setScale(scale), false);
    for (const double distance : {1.5, 10.0, 1e3, 1e5, 1e6}) {
      // 1 - cos = s^2 / (1 + sqrt(1 - s^2)) for s = 1 / distance in radii.
      const long double s2 = 1 / (static_cast<long double>(distance) * distance);
      const long double expected = (1 + std::sqrt(1 - s2)) / (2 * 3.14159265358979323846L * s2);
      const ShapeSample s = made.analytic().sample_from({0, 0, distance * scale}, 0.3, 0.7);
      EXPECT_NEAR(s.pdf / static_cast<double>(expected), 1, 1e-12) << distance;
    }
  }
}

TEST(Sphere, ConeSamplesLieOnTheNearSideOfTheSphere) {
  Made made("sphere", {});
  Numbers u(8);
  for (const bool mirrored : {false, true}) {
    made.analytic().place(Mat4d().rotate(Vec3d(1, 2, 3)) * Mat4d().setScale(mirrored ? -2.0 : 2.0) *
                              Mat4d().setTranslation(Vec3d(1, 2, 3)),
                          false);
    for (int i = 0; i < 20000; ++i) {
      const double distance = std::pow(10, u.between(-8, 6));  // from the surface
      const Vec3d ref = Vec3d(1, 2, 3) + u.direction() * (2 + distance);
      const ShapeSample s = made.analytic().sample_from(ref, u(), u());
      ASSERT_GT(s.pdf, 0);
      EXPECT_NEAR((s.p - Vec3d(1, 2, 3)).length(), 2, 1e-13);
      const Vec3d outward = (s.p - Vec3d(1, 2, 3)) / 2;
      EXPECT_NEAR(outward.dot(s.n), mirrored ? -1 : 1, 1e-12);
      EXPECT_GT(outward.dot(ref - s.p), -1e-9 * distance);  // faces the reference point
    }
  }
}

TEST(Sphere, MeanOfInversePdfIsTheSolidAngle) {
  Made made("sphere", {});
  made.analytic().place(Mat4d(), false);
  // Outside every sample has the pdf of the cone; from inside samples of all directions see 4 pi.
  Numbers u(10);
  double sum = 0;
  const int n = 400000;
  for (int i = 0; i < n; ++i) sum += 1 / made.analytic().sample_from({0.3, 0.2, -0.4}, u(), u()).pdf;
  EXPECT_NEAR(sum / n, 4 * M_PI, 0.03);
  const double outside_pdf = made.analytic().sample_from({0, 0, 2}, 0.5, 0.5).pdf;
  EXPECT_NEAR(1 / outside_pdf, 2 * M_PI * (1 - std::sqrt(0.75)), 1e-12);
}

TEST(Sphere, AMatrixOfSixDigitsIsStillSampledByItsCone) {
  // A rotation by 45 degrees as an exporter writes it is no exact similarity.
  Mat4d m;
  m[0][0] = m[0][1] = m[1][1] = 0.707107, m[1][0] = -0.707106;
  Made made("sphere", {});
  made.analytic().place(m, false);
  Numbers u(11);
  int useless = 0;
  const Vec3d ref{3, 1, 2};
  const Vec3d o = transform_point(made.analytic().scene_to_object(), ref);
  for (int i = 0; i < 20000; ++i) {
    const ShapeSample s = made.analytic().sample_from(ref, u(), u());
    if (s.pdf == 0) {
      ++useless;
      continue;
    }
    EXPECT_NEAR(1 / s.pdf, 2 * M_PI * (1 - std::sqrt(1 - 1 / 14.0)), 1e-5);
    // The point lies on what rays hit.
    EXPECT_NEAR(intersect(made.analytic(), o, transform_vector(made.analytic().scene_to_object(), s.p - ref)), 1,
                1e-12);
  }
  EXPECT_LT(useless, 20);
}

}  // namespace
}  // namespace whit::shape_test
