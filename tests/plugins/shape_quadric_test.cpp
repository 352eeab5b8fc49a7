// What holds for every shape given by equations: hits lie on it, nothing is missed, the derivatives are those of the
// parameterisation, and samples have the density they claim.
#include <cmath>

#include "shape_support.h"

namespace whit::shape_test {
namespace {

struct Case {
  const char* label;
  const char* shape;
  ParameterList params;
};

std::vector<Case> cases() {
  return {
      {"sphere", "sphere", {floats("radius", {1.5})}},
      {"sphere_part",
       "sphere",
       {floats("radius", {1.5}), floats("zmin", {-0.5}), floats("zmax", {1}), floats("phimax", {200})}},
      {"disk", "disk", {floats("height", {0.5}), floats("radius", {2})}},
      {"disk_part", "disk", {floats("radius", {2}), floats("innerradius", {0.5}), floats("phimax", {250})}},
      {"cylinder", "cylinder", {floats("radius", {0.7}), floats("zmin", {-0.5}), floats("zmax", {1})}},
      {"cylinder_part", "cylinder", {floats("zmin", {2}), floats("zmax", {1}), floats("phimax", {100})}},
      {"cone", "cone", {floats("radius", {0.7}), floats("height", {1.5})}},
      {"cone_part", "cone", {floats("radius", {2}), floats("height", {0.5}), floats("phimax", {190})}},
      {"paraboloid", "paraboloid", {floats("radius", {0.7}), floats("zmax", {1.5})}},
      {"paraboloid_part",
       "paraboloid",
       {floats("radius", {2}), floats("zmin", {0.2}), floats("zmax", {0.5}), floats("phimax", {300})}},
      // The line (1, 0, 0) + v (0, 0.9, 2) is nearest to the axis at z = 0.
      {"hyperboloid", "hyperboloid", {points("p1", {1, 0, 0}), points("p2", {1, 0.9, 2})}},
      {"hyperboloid_part",
       "hyperboloid",
       {points("p1", {0.8, 1.2, 1}), points("p2", {0.8, -0.6, -0.5}), floats("phimax", {250})}},
      // Through the origin: a cone.
      {"hyperboloid_default", "hyperboloid", {}},
  };
}

Vec3d unit_normal(const SurfacePoint& s) { return s.dpdu.cross(s.dpdv).normalized(); }
double distance(const Vec3d& a, const Vec3d& b) { return (a - b).length(); }

class Quadric : public testing::TestWithParam<Case> {
 protected:
  Made made_{GetParam().shape, GetParam().params};
  AnalyticShape& shape_ = made_.analytic();
};

TEST_P(Quadric, IsAccepted) {
  EXPECT_TRUE(made_.ok()) << made_.said();
  EXPECT_TRUE(made_.diagnostics.all().empty()) << made_.said();
}

TEST_P(Quadric, RaysTowardsItHitIt) {
  Numbers u;
  const Box3d box = shape_.object_bounds();
  for (int i = 0; i < 20000; ++i) {
    // Away from the rim, where rounding decides, and from any direction at any distance.
    const Vec3d p = shape_.sample_area(u.between(1e-6, 1 - 1e-6), u.between(1e-6, 1 - 1e-6)).p;
    const Vec3d o = p + u.direction() * std::pow(10, u.between(-1, 5)), d = p - o;
    const double t = intersect(shape_, o, d);
    ASSERT_LE(t, 1 + 1e-9) << i;
    const Vec3d hit = o + t * d;
    const SurfacePoint s = shape_.surface(hit);
    // The hit is computed from a distant origin with a rounding of that distance.
    EXPECT_LT(distance(s.p, hit), 1e-9) << i;
    for (int c = 0; c < 3; ++c) {
      EXPECT_GT(s.p[c], box.min[c] - 1e-9);
      EXPECT_LT(s.p[c], box.max[c] + 1e-9);
      EXPECT_GE(s.p_error[c], 0);
      EXPECT_LT(s.p_error[c], 1e-13);
    }
    EXPECT_TRUE(s.u >= 0 && s.u <= 1 && s.v >= 0 && s.v <= 1);
  }
}

TEST_P(Quadric, BothCrossingsAreFoundInOrder) {
  Numbers u(2);
  for (int i = 0; i < 5000; ++i) {
    const Vec3d p = shape_.sample_area(u.between(0.001, 0.999), u.between(0.001, 0.999)).p;
    const Vec3d q = shape_.sample_area(u.between(0.001, 0.999), u.between(0.001, 0.999)).p;
    if (distance(p, q) < 0.01 || std::string(GetParam().shape) == "disk") continue;
    // From beyond p through p to q: hits at 1 and 2, unless another branch comes between.
    const Vec3d o = p + (p - q), d = q - p;
    const SurfacePoint sp = shape_.surface(p), sq = shape_.surface(q);
    if (std::abs(unit_normal(sp).dot(d)) < 0.001 * d.length() || std::abs(unit_normal(sq).dot(d)) < 0.001 * d.length())
      continue;
    EXPECT_NEAR(intersect(shape_, o, d, 0.9), 1, 1e-9);
    EXPECT_NEAR(intersect(shape_, o, d, 1 + 1e-6), 2, 1e-9);
    EXPECT_EQ(intersect(shape_, o, d, 1 + 1e-6, 1.9), 1.9);
    EXPECT_EQ(intersect(shape_, o, d, 2 + 1e-6), 1e300);
  }
}

TEST_P(Quadric, DerivativesAreThoseOfTheParameters) {
  // surface() puts a point back onto the shape: a step h along dpdu changes u by h and v by h^2 only.
  Numbers u(3);
  const double h = 1e-5;
  for (int i = 0; i < 2000; ++i) {
    const SurfacePoint s = shape_.surface(shape_.sample_area(u.between(0.05, 0.9), u.between(0.05, 0.95)).p);
    if (s.u < 0.01 || s.u > 0.99 || s.v < 0.05 || s.v > 0.95) continue;
    const auto check = [&](const Vec3d& dp, const Vec3d& dn, double du, double dv) {
      const SurfacePoint a = shape_.surface(s.p - dp * h), b = shape_.surface(s.p + dp * h);
      EXPECT_NEAR((b.u - a.u) / (2 * h), du, 1e-5);
      EXPECT_NEAR((b.v - a.v) / (2 * h), dv, 1e-5);
      EXPECT_LT(distance((b.p - a.p) / (2 * h), dp), 1e-5 * (1 + dp.length()));
      EXPECT_LT(distance((unit_normal(b) - unit_normal(a)) / (2 * h), dn), 1e-4 * (1 + dn.length()));
    };
    check(s.dpdu, s.dndu, 1, 0);
    check(s.dpdv, s.dndv, 0, 1);
  }
}

TEST_P(Quadric, AreaSamplesAreOnTheSurfaceWithItsNormal) {
  Numbers u(4);
  for (int i = 0; i < 2000; ++i) {
    const ShapeSample a = shape_.sample_area(u(), u());
    const SurfacePoint s = shape_.surface(a.p);
    EXPECT_LT(distance(s.p, a.p), 1e-12);
    EXPECT_GT(a.n.normalized().dot(unit_normal(s)), 1 - 1e-9);
    EXPECT_GT(a.pdf, 0);
  }
}

TEST_P(Quadric, AreaSamplesAreUniform) {
  // The area 1 / pdf is the integral of |dpdu x dpdv| over (u, v), and v-slices get their share of the samples.
  Numbers u(5);
  const int n = 100000, slices = 8;
  double count[slices] = {}, area[slices] = {};
  for (int i = 0; i < n; ++i) {
    const SurfacePoint s = shape_.surface(shape_.sample_area(u(), u()).p);
    const int k = std::min(static_cast<int>(s.v * slices), slices - 1);
    count[k] += 1;
    // E[1 / (density in (u,v))] over a slice is its part of the unit square: density = pdf |dpdu x dpdv|.
    area[k] += 1 / (shape_.sample_area(0.5, 0.5).pdf * s.dpdu.cross(s.dpdv).length());
  }
  for (int k = 0; k < slices; ++k) {
    if (count[k] < 1000) continue;
    // At a tip the slice has few samples of widely differing weights.
    EXPECT_NEAR(area[k] / n, 1.0 / slices, (count[k] < n / 20.0 ? 0.08 : 0.03) / slices) << k;
  }
}

Mat4d mirrored_shear() {
  Mat4d m;
  m = Mat4d().setScale(Vec3d(1.2, -0.5, 0.8));
  m[2][0] = 0.3;
  return m * Mat4d().rotate(Vec3d(0.4, 0.9, -0.3)) * Mat4d().setTranslation(Vec3d(0.5, -1, 2));
}

/// The solid angle seen from ref, by tracing a grid of directions.
double traced_solid_angle(const AnalyticShape& shape, const Vec3d& ref) {
  const int n = 400;
  const Vec3d o = transform_point(shape.scene_to_object(), ref);
  int hits = 0;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const double z = 1 - 2 * (i + 0.5) / n, r = std::sqrt(1 - z * z), phi = 2 * M_PI * (j + 0.5) / n;
      const Vec3d d = transform_vector(shape.scene_to_object(), {r * std::cos(phi), r * std::sin(phi), z});
      hits += intersect(shape, o, d) < 1e300;
    }
  }
  return 4 * M_PI * hits / (double(n) * n);
}

/// The same by sampling: the mean of 1 / pdf over the samples that are seen.
double sampled_solid_angle(const AnalyticShape& shape, const Vec3d& ref, int n) {
  Numbers u(6);
  const Vec3d o = transform_point(shape.scene_to_object(), ref);
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    const ShapeSample s = shape.sample_from(ref, u(), u());
    if (s.pdf == 0) continue;
    EXPECT_NEAR(s.n.length(), 1, 1e-9);
    const Vec3d d = transform_vector(shape.scene_to_object(), s.p - ref);
    const double t = intersect(shape, o, d);
    if (t > 1 - 1e-6) sum += 1 / s.pdf;
  }
  return sum / n;
}

TEST_P(Quadric, SolidAngleIsRightWhereverItIsPlaced) {
  for (const Mat4d& m : {Mat4d(), mirrored_shear()}) {
    shape_.place(m, false);
    for (const Vec3d& ref : {Vec3d(2.6, 1.7, 1.4), Vec3d(-0.3, -3, 2.5), Vec3d(0.05, 0.03, 0.31)}) {
      const double expected = traced_solid_angle(shape_, ref);
      // Area sampling has a heavy tail near the surface: 4 %.
      EXPECT_NEAR(sampled_solid_angle(shape_, ref, 50000), expected, 0.04 * expected + 0.004);
    }
  }
}

TEST_P(Quadric, NormalsOfSamplesFollowTheFlips) {
  Numbers u(7);
  for (const bool reverse : {false, true}) {
    for (const Mat4d& m : {Mat4d(), mirrored_shear()}) {
      shape_.place(m, reverse);
      EXPECT_EQ(shape_.flips_normals(), reverse != swaps_handedness(m));
      for (int i = 0; i < 200; ++i) {
        const ShapeSample s = shape_.sample_from({5, 4, 3}, u(), u());
        if (s.pdf == 0) continue;
        const SurfacePoint at = shape_.surface(transform_point(shape_.scene_to_object(), s.p));
        Vec3d n;
        shape_.scene_to_object().transposed().multDirMatrix(unit_normal(at) * (shape_.flips_normals() ? -1 : 1), n);
        EXPECT_GT(n.normalized().dot(s.n), 1 - 1e-6);
      }
    }
  }
}

TEST_P(Quadric, PolesTipsAndAxesHaveNormals) {
  for (const double z : {-1.5, -0.5, 0.0, 0.5, 1.0, 1.5}) {
    if (std::string(GetParam().shape) == "sphere" && z == 0) continue;  // the centre is no hit
    const SurfacePoint s = shape_.surface({0, 0, z});
    const Vec3d n = unit_normal(s);
    EXPECT_FALSE(std::isnan(s.u) || std::isnan(s.v));
    if (std::string(GetParam().shape) == "hyperboloid") continue;  // nor is the axis, but at a tip
    EXPECT_NEAR(n.length(), 1, 1e-9) << z;
    EXPECT_FALSE(std::isnan(s.dndu.length()) || std::isnan(s.dndv.length())) << z;
  }
}

TEST_P(Quadric, DegenerateRaysHitNothingAndHarmNothing) {
  EXPECT_EQ(intersect(shape_, {0, 0, 0.1}, {0, 0, 0}), 1e300);
  EXPECT_EQ(intersect(shape_, {NAN, 0, 0}, {1, 0, 0}), 1e300);
  EXPECT_EQ(intersect(shape_, {100, 0, 0.1}, {1, 0, 0}), 1e300);
}

INSTANTIATE_TEST_SUITE_P(Shapes, Quadric, testing::ValuesIn(cases()),
                         [](const auto& test) { return std::string(test.param.label); });

TEST(QuadricParameters, WhatCannotBeIsRefused) {
  const auto refused = [](const char* shape, ParameterList params) { return !Made(shape, std::move(params)).ok(); };
  for (const char* shape : {"sphere", "disk", "cylinder", "cone", "paraboloid"}) {
    EXPECT_TRUE(refused(shape, {floats("radius", {-1})})) << shape;
    EXPECT_TRUE(refused(shape, {floats("radius", {INFINITY})})) << shape;
    EXPECT_TRUE(refused(shape, {floats("radius", {NAN})})) << shape;
    EXPECT_TRUE(refused(shape, {floats("phimax", {0})})) << shape;
  }
  EXPECT_TRUE(refused("disk", {floats("innerradius", {-1})}));
  EXPECT_TRUE(refused("cone", {floats("height", {0})}));
  EXPECT_TRUE(refused("hyperboloid", {points("p1", {1, 0, 1}), points("p2", {2, 0, 1})}));
}

TEST(QuadricParameters, WhatHasNoSurfaceIsLeftOutWithAWarning) {
  const auto left_out = [](const char* shape, ParameterList params) {
    Made made(shape, std::move(params));
    const auto& said = made.diagnostics.all();
    return made.ok() && made.analytic().has_no_surface() && said.size() == 1 && said[0].severity == Severity::Warning;
  };
  for (const char* shape : {"sphere", "disk", "cylinder", "cone", "paraboloid"}) {
    EXPECT_TRUE(left_out(shape, {floats("radius", {0})})) << shape;
  }
  EXPECT_TRUE(left_out("sphere", {floats("zmin", {0.5}), floats("zmax", {0.5})}));
  EXPECT_TRUE(left_out("sphere", {floats("zmin", {2}), floats("zmax", {3})}));
  EXPECT_TRUE(left_out("disk", {floats("innerradius", {1})}));
  EXPECT_TRUE(left_out("cylinder", {floats("zmin", {1})}));
  EXPECT_TRUE(left_out("paraboloid", {floats("zmax", {0})}));
  EXPECT_TRUE(left_out("hyperboloid", {points("p1", {0, 0, 1}), points("p2", {0, 0, 2})}));
}

TEST(QuadricParameters, ASweepBeyondAFullTurnIsAFullTurn) {
  Made sphere("sphere", {floats("phimax", {720})});
  ASSERT_TRUE(sphere.ok());
  EXPECT_DOUBLE_EQ(intersect(sphere.analytic(), {1, -3, 0.1}, {-1, 3, -0.1}), 1 - 1 / std::sqrt(10.01));
}

TEST(HyperboloidAsPbrt, HasThePointsPbrtFits) {
  // pbrt's quadric goes through p2, not through p1: for p1 = (1, 0, 0), p2 = (0.3, 0.9, 2) the line's point at v = 2
  // is (-0.4, 1.8, 4), so ah = ((1 - 4) / 3.4) / (1 - 0.9 * 4 / 3.4) = 15, ch = (15 * 0.9 - 1) / 4 = 3.125, and
  // the radius at z = 0 is sqrt(1 / 15).
  Made made("hyperboloid", {points("p1", {1, 0, 0}), points("p2", {0.3, 0.9, 2})});
  ASSERT_TRUE(made.ok());
  EXPECT_NEAR(intersect(made.analytic(), {5, 0, 0}, {-1, 0, 0}), 5 - std::sqrt(1 / 15.0), 1e-12);
  EXPECT_NEAR(intersect(made.analytic(), {5, 0, 1}, {-1, 0, 0}), 5 - std::sqrt(4.125 / 15.0), 1e-12);
}

}  // namespace
}  // namespace whit::shape_test
