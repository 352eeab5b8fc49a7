// A disk, or a sector of a ring, parallel to the xy plane, with the parameterisation of pbrt-v3. Sampled uniformly
// by area through the concentric map of Shirley and Chiu 1997, stretched over the part that exists.

#include <cmath>

#include "core/base/quadratic.h"
#include "core/plugin/registry.h"
#include "core/plugin/shape.h"

namespace whit {
namespace {

/// A point of the unit disk, in polar coordinates with phi in [0, 2 pi].
struct Polar {
  double r, phi;
};

/// The concentric map of the unit square onto the unit disk.
Polar concentric(double u0, double u1) {
  const double x = 2 * u0 - 1, y = 2 * u1 - 1;
  if (x == 0 && y == 0) return {0, 0};
  const bool wide = std::abs(x) > std::abs(y);
  const double r = wide ? x : y, phi = wide ? kPiD / 4 * (y / x) : kPiD / 2 - kPiD / 4 * (x / y);
  const double turned = r < 0 ? phi + kPiD : phi;
  return {std::abs(r), turned < 0 ? turned + 2 * kPiD : turned};
}

struct Disk final : AnalyticShape {
  float height, radius, innerradius, phimax;

  /// Also derives the numbers below, which hold from here on.
  void check(Diagnostics& diagnostics, SourcePos statement) override {
    if (radius == 0) return report_no_surface(diagnostics, statement, "the radius is 0");
    if (innerradius >= radius) return report_no_surface(diagnostics, statement, "innerradius is not below radius");
    h_ = static_cast<double>(height), r_ = static_cast<double>(radius), inner_ = static_cast<double>(innerradius);
    sweep_ = Sweep(static_cast<double>(phimax));
  }

  Box3d object_bounds() const override { return {{-r_, -r_, h_}, {r_, r_, h_}}; }

  bool cannot_shade_itself() const override { return true; }

  bool is_planar() const override { return true; }

  void intersect(const ObjectRays& rays) const override {
    for (int i = 0; i < rays.n; ++i) {
      // A ray in the disk's plane divides by 0; the infinity or NaN fails the next comparison.
      const double t = (h_ - rays.oz[i]) / rays.dz[i];
      if (!(t > rays.t_min[i] && t < rays.t[i])) continue;
      const double x = rays.ox[i] + t * rays.dx[i], y = rays.oy[i] + t * rays.dy[i], d2 = x * x + y * y;
      if (d2 <= r_ * r_ && d2 >= inner_ * inner_ && sweep_.covers(x, y)) rays.t[i] = t;
    }
  }

  void surfaces(SurfacePointLanes& s) const override {
    for_surface_points(s, [this](const Vec3d& hit) { return point(hit); });
  }

  ShapeSample sample_area(double u0, double u1) const override {
    const Polar polar = concentric(u0, u1);
    const double ring = (r_ - inner_) * (r_ + inner_);
    const double rho = std::sqrt(inner_ * inner_ + polar.r * polar.r * ring);
    const double phi = polar.phi * (sweep_.phi_max / (2 * kPiD));
    return {{rho * std::cos(phi), rho * std::sin(phi), h_}, {0, 0, 1}, 2 / (sweep_.phi_max * ring)};
  }

 private:
  SurfacePoint point(const Vec3d& hit) const {
    SurfacePoint s;
    s.p = {hit.x, hit.y, h_};
    s.p_error = Vec3d(0);  // h_ is exact, and every x and y is on the disk.
    const Vec2d out = away_from_axis(hit.x, hit.y);
    const double rho = axis_distance(hit.x, hit.y);
    s.u = sweep_.u(hit.x, hit.y);
    s.v = clamp_to(1 - (rho - inner_) / (r_ - inner_), 0.0, 1.0);
    // At the centre dpdu vanishes; a small radius keeps dpdu x dpdv pointing along z.
    s.dpdu = Vec3d(-out.y, out.x, 0) * (sweep_.phi_max * std::max(rho, 1e-8 * r_));
    s.dpdv = Vec3d(out.x, out.y, 0) * (inner_ - r_);
    s.dndu = s.dndv = Vec3d(0);
    return s;
  }

  double h_ = 0, r_ = 1, inner_ = 0;
  Sweep sweep_;
};

const Register<Disk> disk{
    "disk",
    "A disk, or a sector of a ring, across the z axis.",
    param(&Disk::height, "height", 0.0f, Unit::Length, "Where on the z axis it lies."),
    param(&Disk::radius, "radius", 1.0f, Unit::Length, "Outer radius.", kNonNegative),
    param(&Disk::innerradius, "innerradius", 0.0f, Unit::Length, "Radius of the hole.", kNonNegative),
    param(&Disk::phimax, "phimax", 360.0f, Unit::Degrees, "Sweep around z, from x; above 360 is a full turn.",
          kPositive)};

}  // namespace
}  // namespace whit
