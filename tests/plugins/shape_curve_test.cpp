// Curves: every kind of control points becomes the same cubic Bezier segments.
#include <cmath>

#include "shape_support.h"

namespace whit::shape_test {
namespace {

Vec3d control(const CurveData& c, size_t segment, size_t i) {
  const double* p = c.control_points.data() + 12 * segment + 3 * i;
  return {p[0], p[1], p[2]};
}
Vec3d normal(const CurveData& c, size_t segment, size_t i) {
  const float* n = c.normals.data() + 12 * segment + 3 * i;
  return {n[0], n[1], n[2]};
}
Vec3d bezier(const Vec3d p[4], double t) {
  const double s = 1 - t;
  return p[0] * (s * s * s) + p[1] * (3 * s * s * t) + p[2] * (3 * s * t * t) + p[3] * (t * t * t);
}
Vec3d evaluate(const CurveData& c, size_t segment, double t) {
  const Vec3d p[4] = {control(c, segment, 0), control(c, segment, 1), control(c, segment, 2), control(c, segment, 3)};
  return bezier(p, t);
}
void expect_near(const Vec3d& a, const Vec3d& b, double tolerance = 1e-13) {
  EXPECT_LT((a - b).length(), tolerance) << a << " " << b;
}

const std::vector<double> kPoints{0, 0, 0, 1, 2, 0, 3, 2, 1, 4, 0, 2, 5, -1, 3, 7, 0, 0, 8, 1, 1};
Vec3d point(size_t i) { return {kPoints[3 * i], kPoints[3 * i + 1], kPoints[3 * i + 2]}; }

TEST(Curve, CubicBezierSegmentsShareTheirEnds) {
  Made made("curve", {points("P", kPoints), floats("width0", {1}), floats("width1", {4})});
  CurveData c;
  ASSERT_TRUE(made.ok() && made.build(c)) << made.said();
  EXPECT_EQ(c.kind, CurveData::Kind::Flat);
  ASSERT_EQ(c.control_points.size(), 24u);
  for (size_t s = 0; s < 2; ++s)
    for (size_t i = 0; i < 4; ++i) expect_near(control(c, s, i), point(3 * s + i));
  EXPECT_EQ(c.u_range, (std::vector<float>{0, 1, 0, 1}));  // pbrt's u starts anew with every segment
  ASSERT_EQ(c.widths.size(), 8u);
  for (size_t i = 0; i < 4; ++i) {
    EXPECT_FLOAT_EQ(c.widths[i], 1 + 1.5f * static_cast<float>(i) / 3);
    EXPECT_FLOAT_EQ(c.widths[4 + i], 2.5f + 1.5f * static_cast<float>(i) / 3);
  }
}

TEST(Curve, QuadraticBezierIsElevated) {
  Made made("curve",
            {points("P", {kPoints.begin(), kPoints.begin() + 15}), integers("degree", {2}), text("type", "cylinder")});
  CurveData c;
  ASSERT_TRUE(made.ok() && made.build(c)) << made.said();
  EXPECT_EQ(c.kind, CurveData::Kind::Cylinder);
  ASSERT_EQ(c.control_points.size(), 24u);
  for (size_t s = 0; s < 2; ++s) {
    for (const double t : {0.0, 0.3, 0.8, 1.0}) {
      const size_t i = 2 * s;
      expect_near(evaluate(c, s, t),
                  point(i) * ((1 - t) * (1 - t)) + point(i + 1) * (2 * t * (1 - t)) + point(i + 2) * (t * t));
    }
  }
}

TEST(Curve, BsplinesFollowTheirBasis) {
  for (const int degree : {2, 3}) {
    Made made("curve", {points("P", kPoints), integers("degree", {degree}), text("basis", "bspline")});
    CurveData c;
    ASSERT_TRUE(made.ok() && made.build(c)) << made.said();
    ASSERT_EQ(c.u_range.size(), 2u * static_cast<size_t>(7 - degree));
    for (size_t s = 0; s < static_cast<size_t>(7 - degree); ++s) {
      for (const double t : {0.0, 0.25, 0.9, 1.0}) {
        const double r = 1 - t;
        // The uniform B-spline's blending functions.
        const Vec3d expected =
            degree == 2 ? point(s) * (r * r / 2) + point(s + 1) * (0.5 + t * r) + point(s + 2) * (t * t / 2)
                        : point(s) * (r * r * r / 6) + point(s + 1) * ((3 * t * t * t - 6 * t * t + 4) / 6) +
                              point(s + 2) * ((3 * r * r * r - 6 * r * r + 4) / 6) + point(s + 3) * (t * t * t / 6);
        expect_near(evaluate(c, s, t), expected);
      }
    }
  }
}

TEST(Curve, SplitDepthIsPbrtsWithinReason) {
  for (const auto& [given, made_of] : {std::pair{0, 0}, std::pair{3, 3}, std::pair{99, 5}}) {
    Made made("curve", {points("P", kPoints), integers("splitdepth", {given})});
    CurveData c;
    ASSERT_TRUE(made.ok() && made.build(c)) << made.said();
    EXPECT_EQ(c.split_depth, made_of);
  }
}

TEST(Curve, SplitDepthMayBeAFloat) {
  // pbrt-v3 truncates it, and takes the integer where both are given. A parameter of two values is none.
  const auto depth = [](std::vector<Parameter> given) {
    ParameterList list{points("P", kPoints)};
    list.insert(list.end(), given.begin(), given.end());
    Made made("curve", list);
    CurveData c;
    EXPECT_TRUE(made.ok() && made.build(c)) << made.said();
    return c.split_depth;
  };
  EXPECT_EQ(depth({floats("splitdepth", {1})}), 1);
  EXPECT_EQ(depth({floats("splitdepth", {2.9})}), 2);
  EXPECT_EQ(depth({floats("splitdepth", {1e30})}), 5);
  EXPECT_EQ(depth({floats("splitdepth", {1}), integers("splitdepth", {4})}), 4);
  EXPECT_EQ(depth({integers("splitdepth", {4}), floats("splitdepth", {1})}), 4);
  EXPECT_EQ(depth({integers("splitdepth", {4, 4}), floats("splitdepth", {1})}), 1);
}

Parameter normals(std::vector<double> v) { return numbers(ParamType::Normal3, "N", std::move(v)); }

TEST(Curve, NormalsOfARibbonTurnEvenly) {
  const std::vector<double> straight{0, 0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0};
  for (const double degrees : {0.0, 30.0, 90.0, 150.0, 180.0}) {
    const double a = degrees * M_PI / 180;
    Made made("curve",
              {points("P", straight), text("type", "ribbon"), normals({0, 0, 2, 0, std::sin(a), std::cos(a)})});
    CurveData c;
    ASSERT_TRUE(made.ok() && made.build(c)) << made.said();
    ASSERT_EQ(c.normals.size(), 12u);
    const Vec3d n[4] = {normal(c, 0, 0), normal(c, 0, 1), normal(c, 0, 2), normal(c, 0, 3)};
    expect_near(n[0], {0, 0, 1}, 1e-6);
    expect_near(n[3], {0, std::sin(a), std::cos(a)}, 1e-6);
    for (const double t : {0.25, 0.5, 0.75}) {
      const Vec3d at = bezier(n, t);
      EXPECT_NEAR(at.length(), 1, 0.02);
      EXPECT_NEAR(at.x, 0, 1e-6);  // opposite normals too turn around the curve
      EXPECT_NEAR(std::acos(std::min(1.0, at.normalized().z)), t * a, 0.03 * a + 1e-3);
    }
  }
}

TEST(Curve, MistakesAreErrors) {
  const auto refused = [](ParameterList list, const char* what) {
    Made made("curve", std::move(list));
    EXPECT_FALSE(made.ok()) << what;
    EXPECT_TRUE(made.says(what)) << made.said();
  };
  const std::vector<double> three(kPoints.begin(), kPoints.begin() + 9), five(kPoints.begin(), kPoints.begin() + 15);
  refused({points("P", three)}, "number of control points does not fit: degree 3 bezier needs 4 + n * 3, not 3");
  refused({points("P", five)}, "not 5");
  refused({points("P", three), text("basis", "bspline")}, "needs 4 or more, not 3");
  refused({points("P", kPoints), integers("degree", {4})}, "degree");
  refused({points("P", kPoints), text("type", "ribbon")}, "needs normals");
  refused({points("P", kPoints), text("type", "ribbon"), normals({0, 0, 1, 0, 0, 1})}, "need 3 normals, not 2");
  refused({points("P", kPoints), text("type", "ribbon"), normals({0, 0, 1, 0, 0, 0, 0, 0, 1})},
          "normal 1 of the curve is zero");
  // pbrt-v3 warns of a type that it does not know, and takes the default.
  Made tube("curve", {points("P", kPoints), text("type", "tube")});
  EXPECT_TRUE(tube.ok() && tube.says("tube")) << tube.said();
  Made flat("curve", {points("P", kPoints), normals({0, 0, 1})});
  EXPECT_TRUE(flat.ok() && flat.says("ribbon")) << flat.said();
}

}  // namespace
}  // namespace whit::shape_test
