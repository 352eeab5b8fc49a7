// A paraboloid around the z axis with its lowest point at the origin, between two heights, or a sweep of one, with
// the parameterisation of pbrt-v3. It can be a light, which pbrt-v3's cannot.

#include <cmath>

#include "core/base/quadratic.h"
#include "core/plugin/registry.h"
#include "core/plugin/shape.h"

namespace whit {
namespace {

struct Paraboloid final : AnalyticShape {
  float radius, zmin, zmax, phimax;

  /// Also derives the numbers below, which hold from here on.
  void check(Diagnostics& diagnostics, SourcePos statement) override {
    r_ = static_cast<double>(radius);
    v_min_ = static_cast<double>(std::min(zmin, zmax)), z_max_ = static_cast<double>(std::max(zmin, zmax));
    // The surface begins at z = 0, wherever v does.
    z_min_ = std::max(v_min_, 0.0);
    if (radius == 0) return report_no_surface(diagnostics, statement, "the radius is 0");
    if (!(z_min_ < z_max_)) return report_no_surface(diagnostics, statement, "zmax is not above 0 and zmin");
    k_ = z_max_ / (r_ * r_);
    quadric_ = {k_, 0, -0.5, 0};
    sweep_ = Sweep(static_cast<double>(phimax));
  }

  Box3d object_bounds() const override { return {{-r_, -r_, z_min_}, {r_, r_, z_max_}}; }

  void intersect(const ObjectRays& rays) const override {
    intersect_quadric(rays, quadric_,
                      [&](const Vec3d& p) { return p.z >= v_min_ && p.z <= z_max_ && sweep_.covers(p.x, p.y); });
  }

  void surfaces(SurfacePointLanes& s) const override {
    for_surface_points(s, [this](const Vec3d& hit) { return point(hit); });
  }

  ShapeSample sample_area(double u0, double u1) const override {
    // The area up to height z is phi_max / (12 k^2) times f(z), written so that flat paraboloids keep their digits.
    const auto f = [&](double z) { return std::expm1(1.5 * std::log1p(4 * k_ * z)); };  // (1 + 4 k z)^(3/2) - 1
    const double f0 = f(z_min_), f1 = f(z_max_), at = f0 + u0 * (f1 - f0);
    const double z = std::clamp(std::expm1(std::log1p(at) / 1.5) / (4 * k_), z_min_, z_max_);
    const double rho = std::sqrt(z / k_), phi = u1 * sweep_.phi_max, x = std::cos(phi), y = std::sin(phi);
    return {
        {rho * x, rho * y, z}, {2 * k_ * rho * x, 2 * k_ * rho * y, -1}, 12 * k_ * k_ / (sweep_.phi_max * (f1 - f0))};
  }

 private:
  SurfacePoint point(const Vec3d& hit) const {
    SurfacePoint s;
    s.p = quadric_.project(hit);
    s.p_error = rounding_bound({r_, 0, z_max_});
    s.u = sweep_.u(s.p.x, s.p.y);
    s.v = clamp_to((s.p.z - v_min_) / (z_max_ - v_min_), 0.0, 1.0);
    // At the lowest point dpdu vanishes and dpdv is infinite; a small radius keeps dpdu x dpdv pointing outward.
    const double rho = std::max(axis_distance(s.p.x, s.p.y), 1e-6 * r_), dz = z_max_ - v_min_;
    const double dr = dz / (2 * k_ * rho), ddr = -dr * dr / rho;
    const SurfaceDerivatives d = revolve({rho, dr, dz, ddr}, away_from_axis(s.p.x, s.p.y), sweep_.phi_max);
    s.dpdu = d.dpdu, s.dpdv = d.dpdv, s.dndu = d.dndu, s.dndv = d.dndv;
    return s;
  }

  double r_ = 1, v_min_ = 0, z_min_ = 0, z_max_ = 1, k_ = 1;
  Sweep sweep_;
  AxialQuadric quadric_;
};

const Register<Paraboloid> paraboloid{
    "paraboloid",
    "A paraboloid around the z axis, open upwards, with its lowest point at the origin.",
    param(&Paraboloid::radius, "radius", 1.0f, Unit::Length, "Radius at zmax.", kNonNegative),
    param(&Paraboloid::zmin, "zmin", 0.0f, Unit::Length, "Lower end."),
    param(&Paraboloid::zmax, "zmax", 1.0f, Unit::Length, "Upper end, above 0."),
    param(&Paraboloid::phimax, "phimax", 360.0f, Unit::Degrees, "Sweep around z, from x; above 360 is a full turn.",
          kPositive)};

}  // namespace
}  // namespace whit
