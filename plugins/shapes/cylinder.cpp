// An open cylinder around the z axis, or a sweep of one, with the parameterisation of pbrt-v3.

#include <cmath>

#include "core/base/quadratic.h"
#include "core/plugin/registry.h"
#include "core/plugin/shape.h"

namespace whit {
namespace {

struct Cylinder final : AnalyticShape {
  float radius, zmin, zmax, phimax;

  /// Also derives the numbers below, which hold from here on.
  void check(Diagnostics& diagnostics, SourcePos statement) override {
    if (radius == 0) return report_no_surface(diagnostics, statement, "the radius is 0");
    if (zmin == zmax) return report_no_surface(diagnostics, statement, "zmin is zmax");
    r_ = static_cast<double>(radius);
    z_min_ = static_cast<double>(std::min(zmin, zmax)), z_max_ = static_cast<double>(std::max(zmin, zmax));
    sweep_ = Sweep(static_cast<double>(phimax));
  }

  Box3d object_bounds() const override { return {{-r_, -r_, z_min_}, {r_, r_, z_max_}}; }

  void intersect(const ObjectRays& rays) const override {
    intersect_quadric(rays, AxialQuadric{1, 0, 0, -r_ * r_},
                      [&](const Vec3d& p) { return p.z >= z_min_ && p.z <= z_max_ && sweep_.covers(p.x, p.y); });
  }

  void surfaces(SurfacePointLanes& s) const override {
    for_surface_points(s, [this](const Vec3d& hit) { return point(hit); });
  }

  ShapeSample sample_area(double u0, double u1) const override {
    const double phi = u1 * sweep_.phi_max, x = std::cos(phi), y = std::sin(phi);
    return {
        {r_ * x, r_ * y, z_min_ + u0 * (z_max_ - z_min_)}, {x, y, 0}, 1 / ((z_max_ - z_min_) * r_ * sweep_.phi_max)};
  }

 private:
  SurfacePoint point(const Vec3d& hit) const {
    const Vec2d out = away_from_axis(hit.x, hit.y);
    const SurfaceDerivatives d = revolve({r_, 0, z_max_ - z_min_, 0}, out, sweep_.phi_max);
    SurfacePoint s;
    s.p = {r_ * out.x, r_ * out.y, hit.z};
    s.p_error = rounding_bound({r_, 0, 0});
    s.u = sweep_.u(hit.x, hit.y);
    s.v = clamp_to((hit.z - z_min_) / (z_max_ - z_min_), 0.0, 1.0);
    s.dpdu = d.dpdu, s.dpdv = d.dpdv, s.dndu = d.dndu, s.dndv = d.dndv;
    return s;
  }

  double r_ = 1, z_min_ = -1, z_max_ = 1;
  Sweep sweep_;
};

const Register<Cylinder> cylinder{"cylinder",
                                  "An open cylinder around the z axis.",
                                  param(&Cylinder::radius, "radius", 1.0f, Unit::Length, "Radius.", kNonNegative),
                                  param(&Cylinder::zmin, "zmin", -1.0f, Unit::Length, "Lower end."),
                                  param(&Cylinder::zmax, "zmax", 1.0f, Unit::Length, "Upper end."),
                                  param(&Cylinder::phimax, "phimax", 360.0f, Unit::Degrees,
                                        "Sweep around z, from x; above 360 is a full turn.", kPositive)};

}  // namespace
}  // namespace whit
