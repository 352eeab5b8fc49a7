// The hyperboloid that pbrt-v3 makes of a line from p1 to p2 turned around the z axis: its quadric has its waist at
// z = 0 and goes through p2 and a point of the line beyond it, so it is the swept line exactly when the line is
// nearest to the axis there; parameters and normals are those of the swept line. Where pbrt-v3 finds no quadric
// (it does not end then: a line through the axis at z = 0) this is the swept line.

#include <cmath>

#include "core/base/quadratic.h"
#include "core/plugin/registry.h"
#include "core/plugin/shape.h"

namespace whit {
namespace {

double squared_radius(const Vec3d& p) { return p.x * p.x + p.y * p.y; }

struct Hyperboloid final : AnalyticShape {
  Point p1, p2;
  float phimax;

  /// Also derives the numbers below, which hold from here on.
  void check(Diagnostics& diagnostics, SourcePos statement) override {
    a_ = p1.value, b_ = p2.value;
    if (a_.z == b_.z) diagnostics.error(statement, "hyperboloid is flat", "p1 and p2 must differ in z");
    if (squared_radius(a_) == 0 && squared_radius(b_) == 0) {
      return report_no_surface(diagnostics, statement, "p1 and p2 are on the z axis");
    }
    if (b_.z == 0) std::swap(a_, b_);
    z_min_ = std::min(a_.z, b_.z), z_max_ = std::max(a_.z, b_.z);
    sweep_ = Sweep(static_cast<double>(phimax));
    if (!fit_as_pbrt()) fit_swept_line();
    const double r2 = std::max(radius2(z_min_), radius2(z_max_));
    r_max_ = std::sqrt(std::max({r2, squared_radius(a_), squared_radius(b_)}));
  }

  Box3d object_bounds() const override { return {{-r_max_, -r_max_, z_min_}, {r_max_, r_max_, z_max_}}; }

  void intersect(const ObjectRays& rays) const override {
    intersect_quadric(rays, quadric_, [&](const Vec3d& p) {
      return p.z >= z_min_ && p.z <= z_max_ && (sweep_.phi_max >= 2 * kPiD || turn(p) <= sweep_.phi_max);
    });
  }

  void surfaces(SurfacePointLanes& s) const override {
    for_surface_points(s, [this](const Vec3d& hit) { return point(hit); });
  }

  ShapeSample sample_area(double u0, double u1) const override {
    const double f0 = area_up_to(z_min_), f1 = area_up_to(z_max_), wanted = f0 + u0 * (f1 - f0);
    double low = z_min_, high = z_max_;
    for (int step = 0; step < 52; ++step) {
      const double z = (low + high) / 2;
      (area_up_to(z) < wanted ? low : high) = z;
    }
    const double z = (low + high) / 2, rho = std::sqrt(std::max(radius2(z), 0.0));
    const Vec3d on_line = a_ + (b_ - a_) * along({0, 0, z});
    const double phi = u1 * sweep_.phi_max + std::atan2(on_line.y, on_line.x);
    const Vec3d p{rho * std::cos(phi), rho * std::sin(phi), z};
    Vec3d n = quadric_.gradient(p) * (quadric_.wx < 0 ? -1 : 1);
    return {p, b_.z > a_.z ? n : -n, 1 / (sweep_.phi_max * (f1 - f0))};
  }

 private:
  SurfacePoint point(const Vec3d& hit) const {
    SurfacePoint s;
    s.p = quadric_.project(hit);
    s.p_error = rounding_bound({r_max_, z_min_, z_max_});
    const double phi = turn(s.p), c = std::cos(phi), sn = std::sin(phi);
    s.u = std::min(phi / sweep_.phi_max, 1.0);
    s.v = clamp_to(along(s.p), 0.0, 1.0);
    const Vec3d line = b_ - a_;
    SurfaceDerivatives d;
    // Where the surface meets the axis dpdu vanishes; a small radius keeps the direction of dpdu x dpdv.
    const Vec2d out = away_from_axis(s.p.x, s.p.y);
    const double rho = std::max(axis_distance(s.p.x, s.p.y), 1e-8 * r_max_);
    d.dpdu = Vec3d(-out.y, out.x, 0) * (sweep_.phi_max * rho);
    d.dpdv = {line.x * c - line.y * sn, line.x * sn + line.y * c, line.z};
    const double m = sweep_.phi_max;
    weingarten(Vec3d(out.x, out.y, 0) * (-m * m * rho), Vec3d(-d.dpdv.y, d.dpdv.x, 0) * m, Vec3d(0), d);
    s.dpdu = d.dpdu, s.dpdv = d.dpdv, s.dndu = d.dndu, s.dndv = d.dndv;
    return s;
  }

  /// The parameter v of a point: how far along the line its height is.
  double along(const Vec3d& p) const { return (p.z - a_.z) / (b_.z - a_.z); }

  /// The angle, in [0, 2 pi], by which the line has turned when it is at the point's azimuth.
  double turn(const Vec3d& p) const {
    const Vec3d q = a_ + (b_ - a_) * along(p);
    return azimuth(p.x * q.x + p.y * q.y, q.x * p.y - p.x * q.y);
  }

  /// pbrt's coefficients: ah (x^2 + y^2) - ch z^2 = 1 through p2 and the line's points at v = 2, 4, ...
  bool fit_as_pbrt() {
    const double z2 = b_.z * b_.z, r2 = squared_radius(b_);
    Vec3d p = a_;
    for (int step = 0; step < 16; ++step) {
      p += 2.0 * (b_ - a_);
      const double rp = squared_radius(p), zp = p.z * p.z / z2, bottom = 1 - r2 * zp / rp;
      const double ah = (1 - zp) / rp / bottom, ch = (ah * r2 - 1) / z2;
      // What rounding leaves of a denominator that is 0 is not a coefficient.
      if (!std::isfinite(ah) || std::abs(bottom) < 1e-14) continue;
      quadric_ = {ah, -ch, 0, -1};
      return true;
    }
    return false;
  }

  /// x^2 + y^2 = |p1 + v (p2 - p1)|^2 in x and y, with v linear in z.
  void fit_swept_line() {
    const Vec3d d = b_ - a_;
    const double s = 1 / d.z, q2 = squared_radius(d) * s * s, q1 = (a_.x * d.x + a_.y * d.y) * s;
    quadric_ = {1, -q2, -(q1 - q2 * a_.z), -(squared_radius(a_) - 2 * q1 * a_.z + q2 * a_.z * a_.z)};
  }

  double radius2(double z) const { return -((quadric_.wz * z + 2 * quadric_.lz) * z + quadric_.w) / quadric_.wx; }

  /// The area from some height to z, for a sweep of 1 radian: the integral of sqrt(r^2 + (r r')^2), whose square is
  /// q2 (z + shift)^2 + q0.
  double area_up_to(double z) const {
    const double c2 = -quadric_.wz / quadric_.wx, c1 = -quadric_.lz / quadric_.wx, c0 = -quadric_.w / quadric_.wx;
    // r^2 = c2 z^2 + 2 c1 z + c0, r r' = c2 z + c1.
    const double q2 = c2 + c2 * c2, q1 = c1 + c1 * c2, shift = q2 == 0 ? 0 : q1 / q2;
    const double q0 = c0 + c1 * c1 - q1 * shift, x = z + shift, s = std::sqrt(std::max(q2 * x * x + q0, 0.0));
    if (q2 == 0) return s * x;
    const double root = std::sqrt(std::abs(q2));
    if (q2 < 0) return (s * x + q0 / root * std::atan2(root * x, s)) / 2;
    const double inside = std::abs(root * x + s);
    return (s * x + (inside > 0 ? q0 / root * std::log(inside) : 0)) / 2;
  }

  Vec3d a_, b_;  ///< The line; v is 0 at a_.
  double z_min_ = 0, z_max_ = 1, r_max_ = 1;
  Sweep sweep_;
  AxialQuadric quadric_;
};

const Register<Hyperboloid> hyperboloid{
    "hyperboloid", "A line turned around the z axis, as pbrt-v3 approximates it.",
    param(&Hyperboloid::p1, "p1", Point{{0, 0, 0}}, Unit::Length, "One end of the line."),
    param(&Hyperboloid::p2, "p2", Point{{1, 1, 1}}, Unit::Length, "Other end of the line."),
    param(&Hyperboloid::phimax, "phimax", 360.0f, Unit::Degrees, "Sweep around z; above 360 is a full turn.",
          kPositive)};

}  // namespace
}  // namespace whit
