// An open cone that stands on the xy plane with its tip on the z axis, or a sweep of one, with the parameterisation
// of pbrt-v3. It can be a light, which pbrt-v3's cannot.

#include <cmath>

#include "core/base/quadratic.h"
#include "core/plugin/registry.h"
#include "core/plugin/shape.h"

namespace whit {
namespace {

struct Cone final : AnalyticShape {
  float radius, height, phimax;

  /// Also derives the numbers below, which hold from here on.
  void check(Diagnostics& diagnostics, SourcePos statement) override {
    if (radius == 0) return report_no_surface(diagnostics, statement, "the radius is 0");
    r_ = static_cast<double>(radius), h_ = static_cast<double>(height);
    sweep_ = Sweep(static_cast<double>(phimax));
    // Around the tip, where it has no constant term: h^2 (x^2 + y^2) = r^2 z^2.
    quadric_ = {h_ * h_, -r_ * r_, 0, 0};
  }

  Box3d object_bounds() const override { return {{-r_, -r_, 0}, {r_, r_, h_}}; }

  void intersect(const ObjectRays& rays) const override {
    intersect_quadric(
        rays, quadric_, [&](const Vec3d& p) { return p.z >= -h_ && p.z <= 0 && sweep_.covers(p.x, p.y); }, h_);
  }

  void surfaces(SurfacePointLanes& s) const override {
    for_surface_points(s, [this](const Vec3d& hit) { return point(hit); });
  }

  ShapeSample sample_area(double u0, double u1) const override {
    // The area above a height goes with the square of the distance to the tip.
    const double w = std::sqrt(u0), phi = u1 * sweep_.phi_max, x = std::cos(phi), y = std::sin(phi);
    const double area = sweep_.phi_max / 2 * r_ * std::hypot(r_, h_);
    return {{w * r_ * x, w * r_ * y, h_ * (1 - w)}, {h_ * x, h_ * y, r_}, 1 / area};
  }

 private:
  SurfacePoint point(const Vec3d& hit) const {
    const Vec3d q = quadric_.project(hit - Vec3d(0, 0, h_));
    SurfacePoint s;
    s.p = q + Vec3d(0, 0, h_);
    s.p_error = rounding_bound({r_, 0, h_});
    s.u = sweep_.u(s.p.x, s.p.y);
    s.v = clamp_to(s.p.z / h_, 0.0, 1.0);
    // At the tip dpdu vanishes; a small radius keeps dpdu x dpdv pointing outward.
    const double rho = std::max(r_ * -q.z / h_, 1e-8 * r_);
    const SurfaceDerivatives d = revolve({rho, -r_, h_, 0}, away_from_axis(q.x, q.y), sweep_.phi_max);
    s.dpdu = d.dpdu, s.dpdv = d.dpdv, s.dndu = d.dndu, s.dndv = d.dndv;
    return s;
  }

  double r_ = 1, h_ = 1;
  Sweep sweep_;
  AxialQuadric quadric_;
};

const Register<Cone> cone{"cone", "An open cone with its base in the xy plane and its tip on the z axis.",
                          param(&Cone::radius, "radius", 1.0f, Unit::Length, "Radius of the base.", kNonNegative),
                          param(&Cone::height, "height", 1.0f, Unit::Length, "Height of the tip.", kPositive),
                          param(&Cone::phimax, "phimax", 360.0f, Unit::Degrees,
                                "Sweep around z, from x; above 360 is a full turn.", kPositive)};

}  // namespace
}  // namespace whit
