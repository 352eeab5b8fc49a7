// Case 5: where rays meet quadrics, to the last digits. The reference is the root of the shape's equation along the ray
// nearest to whit's, by bisection in 113 bits: long double would not do. A ray that grazes at 1e-6 radians at a distance
// of 1e6 changes the equation by 2^-53 x 1e6 x 1e-6 = 1e-16 for one ulp of t, and 64 bits round its coordinates by
// 2^-64 x 1e6 = 5e-14.
#include <fmt/core.h>

#include <optional>

#include "tests/hard/hard_case.h"
#include "tests/plugins/shape_support.h"

namespace whit {
namespace {

using namespace shape_test;
using test::HardCase;
__extension__ using Real = __float128;

struct Quadric {
  const char* name;
  ParameterList parameters;
  Real (*f)(Real x, Real y, Real z);  ///< 0 on the surface.
};

std::vector<Quadric> quadrics() {
  return {{"sphere", {}, [](Real x, Real y, Real z) { return x * x + y * y + z * z - 1; }},
          {"cylinder", {}, [](Real x, Real y, Real) { return x * x + y * y - 1; }},
          {"cone", {}, [](Real x, Real y, Real z) { return x * x + y * y - (1 - z) * (1 - z); }},
          {"paraboloid", {}, [](Real x, Real y, Real z) { return x * x + y * y - z; }},
          // From (1, 0, -1) to (0, 1, 1) the line's distance to the axis is x^2 + y^2 = (1 + z^2) / 2.
          {"hyperboloid",
           {points("p1", {1, 0, -1}), points("p2", {0, 1, 1})},
           [](Real x, Real y, Real z) { return x * x + y * y - (1 + z * z) / 2; }},
          {"disk", {}, [](Real, Real, Real z) { return z; }}};
}

double ulps_away(double t, int n) { return t + n * (std::nextafter(t, INFINITY) - t); }

/// By how many ulp t is off; nothing where the ray grazes so closely that both roots are within 1000 ulp.
std::optional<double> error_in_ulps(const Quadric& q, const Vec3d& o, const Vec3d& d, double t) {
  const auto f = [&](Real s) {
    return q.f(Real{o.x} + s * Real{d.x}, Real{o.y} + s * Real{d.y}, Real{o.z} + s * Real{d.z});
  };
  Real low = ulps_away(t, -1000), high = ulps_away(t, 1000);
  const bool rising = f(high) > 0;
  if ((f(low) > 0) == rising) return {};
  for (int i = 0; i < 24; ++i) {
    const Real middle = (low + high) / 2;
    ((f(middle) > 0) == rising ? high : low) = middle;
  }
  return std::abs(static_cast<double>(t - low)) / (std::nextafter(t, INFINITY) - t);
}

/// A ray to p from a distance: in any direction, tangent to within 1e-6 .. 1 radians, or in a plane nearly through p's.
Vec3d direction_to(Numbers& u, const Vec3d& n, bool grazing) {
  const Vec3d d = u.direction();
  if (!grazing) return d;
  const Vec3d along = (d - n * n.dot(d)).normalized();
  return along + n * (std::pow(10, u.between(-6, 0)) * (u() < 0.5 ? -1 : 1));
}

TEST(Hard, QuadricRoots) {
  for (const Quadric& q : quadrics()) {
    HardCase worst({5, fmt::format("ray and {}", q.name), "distances 10 to 1e6, any direction and tangent, 2e4 rays",
                    "ulp of t from a 113-bit reference", 2, ""});
    Made made(q.name, q.parameters);
    ASSERT_TRUE(made.ok()) << made.said();
    const AnalyticShape& shape = made.analytic();
    Numbers u;
    int tested = 0;
    for (int i = 0; i < 20000; ++i) {
      const ShapeSample s = shape.sample_area(u.between(0.001, 0.999), u.between(0.001, 0.999));
      const Vec3d o = s.p - direction_to(u, s.n.normalized(), i % 2 == 1) * std::pow(10, u.between(1, 6));
      const Vec3d d = (s.p - o) * (i % 3 == 0 ? std::pow(10, u.between(-6, 6)) : 1.0);
      const double t = intersect(shape, o, d);
      if (t == 1e300) continue;
      if (const std::optional<double> e = error_in_ulps(q, o, d, t)) {
        ++tested;
        worst.see(*e, fmt::format("ray {}", i));
      }
    }
    EXPECT_GT(tested, 15000) << q.name;
  }
}

}  // namespace
}  // namespace whit
