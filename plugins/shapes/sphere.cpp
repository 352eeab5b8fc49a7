// A sphere around the origin, or the part of one between two heights and within a sweep around z, with the
// parameterisation of pbrt-v3. As a light it is sampled by the cone it subtends (Shirley and Wang 1992), in
// forms of 1 - cos that keep their digits at any distance, and from inside by direction; parts of spheres and
// ellipsoids are sampled by area.

#include <cmath>
#include <optional>

#include "core/base/fastmath.h"
#include "core/base/quadratic.h"
#include "core/plugin/registry.h"
#include "core/plugin/shape.h"

namespace whit {
namespace {

/// Two unit vectors that make a frame with the unit vector w; pbrt's choice, so that noise is alike.
void make_frame(const Vec3d& w, Vec3d& x, Vec3d& y) {
  x = std::abs(w.x) > std::abs(w.y) ? Vec3d(-w.z, 0, w.x) / std::sqrt(w.x * w.x + w.z * w.z)
                                    : Vec3d(0, w.z, -w.y) / std::sqrt(w.y * w.y + w.z * w.z);
  y = w.cross(x);
}

struct Sphere final : AnalyticShape {
  float radius;
  std::optional<float> zmin, zmax;
  float phimax;

  /// Also derives the numbers below, which hold from here on.
  void check(Diagnostics& diagnostics, SourcePos statement) override {
    r_ = static_cast<double>(radius);
    const double a = zmin ? static_cast<double>(*zmin) : -r_, b = zmax ? static_cast<double>(*zmax) : r_;
    z_min_ = std::clamp(std::min(a, b), -r_, r_), z_max_ = std::clamp(std::max(a, b), -r_, r_);
    if (radius == 0) return report_no_surface(diagnostics, statement, "the radius is 0");
    if (z_min_ == z_max_) return report_no_surface(diagnostics, statement, "there is no sphere between zmin and zmax");
    sweep_ = Sweep(static_cast<double>(phimax));
    theta_at_z_min_ = std::acos(z_min_ / r_), theta_at_z_max_ = std::acos(z_max_ / r_);
    whole_ = z_min_ == -r_ && z_max_ == r_ && phimax >= 360;
  }

  Box3d object_bounds() const override { return {{-r_, -r_, z_min_}, {r_, r_, z_max_}}; }

  bool cannot_shade_itself() const override { return whole_ && !flips_; }

  void intersect(const ObjectRays& rays) const override {
    if (whole_) {
      intersect_whole(rays);
    } else {
      intersect_quadric(rays, AxialQuadric{1, 1, 0, -r_ * r_}, [&](const Vec3d& p) {
        return (z_min_ == -r_ || p.z >= z_min_) && (z_max_ == r_ || p.z <= z_max_) && sweep_.covers(p.x, p.y);
      });
    }
  }

  void surfaces(SurfacePointLanes& s) const override {
    for_surface_points(s, [this](const Vec3d& hit) { return point(hit); });
  }

  ShapeSample sample_area(double u0, double u1) const override {
    // Archimedes: equal heights have equal areas.
    const double height = z_max_ - z_min_, z = std::clamp(z_max_ - u0 * height, -r_, r_);
    const double rho = std::sqrt((r_ - z) * (r_ + z)), phi = u1 * sweep_.phi_max;
    const Vec3d p{rho * std::cos(phi), rho * std::sin(phi), z};
    return {p, p, 1 / (sweep_.phi_max * r_ * height)};
  }

  ShapeSample sample_from(const Vec3d& ref, double u0, double u1) const override {
    const Cone cone(*this, ref);
    if (!whole_ || cone.stretch > kNearlyRound) return AnalyticShape::sample_from(ref, u0, u1);
    if (!cone.is_outside()) return sample_inside(ref, u0, u1);
    return cone.stretch < kRound ? cone.sample_sphere(flips_, u0, u1) : sample_nearly_round(cone, ref, u0, u1);
  }

  double density_from(const Vec3d& ref, const Vec3d& p) const override {
    const Cone cone(*this, ref);
    if (!whole_ || cone.stretch > kNearlyRound) return AnalyticShape::density_from(ref, p);
    return cone.is_outside() && !is_on_surface(cone, ref) ? cone.pdf() : 1 / (4 * kPiD);
  }

  void sample_lanes(const ShapeSampleLanes& s) const override {
    // Of the placement only, not of the reference point: any point does.
    const Cone placed(*this,
                      Vec3d(object_to_scene_[3][0], object_to_scene_[3][1], object_to_scene_[3][2]) + Vec3d(1, 0, 0));
    if (!whole_ || placed.stretch > kNearlyRound) return AnalyticShape::sample_lanes(s);
    const bool round = placed.stretch < kRound;
    if (round) sample_cones(placed.center, placed.radius, s);
    for (int i = 0; i < s.n; ++i) {
      if (round && s.pdf[i] > 0) continue;
      const Vec3d ref(s.ref[i]);
      const double u0 = static_cast<double>(s.u[i]), u1 = static_cast<double>(s.v[i]);
      set_sample(s, i, is_on_surface(Cone(*this, ref), ref) ? sample_on(ref, u0, u1) : sample_from(ref, u0, u1));
    }
  }

 private:
  SurfacePoint point(const Vec3d& hit) const {
    SurfacePoint s;
    s.p = hit * (r_ / std::sqrt(hit.dot(hit)));
    s.p_error = rounding_bound(s.p);
    const double from_axis = axis_distance(s.p.x, s.p.y), d_theta = theta_at_z_max_ - theta_at_z_min_;
    const double theta = detail::atan2_kernel(from_axis, s.p.z);  // not by acos, which loses its digits at the poles
    s.u = sweep_.u(s.p.x, s.p.y);
    s.v = clamp_to((theta - theta_at_z_min_) / d_theta, 0.0, 1.0);
    // At the poles dpdu vanishes; a small radius keeps dpdu x dpdv pointing outward.
    const double rho = std::max(from_axis, kPole * r_);
    const SurfaceDerivatives d =
        revolve({rho, d_theta * s.p.z, -d_theta * rho, 0}, away_from_axis(s.p.x, s.p.y), sweep_.phi_max);
    s.dpdu = d.dpdu, s.dpdv = d.dpdv;
    s.dndu = d.dpdu / r_, s.dndv = d.dpdv / r_;  // The unit normal is p / r.
    return s;
  }

  static constexpr double kPole = 1e-8, kHuge = 1e300;
  static constexpr double kRound = 1e-13, kNearlyRound = 1e-2;
  /// Half a unit in the last place of a coordinate, and a little: by so much a point of the sphere is off.
  static constexpr double kRounding = 6e-8;

  /// The smallest cone from a point around the sphere that surrounds the placed one.
  struct Cone {
    Vec3d center, w;  ///< Scene space; w is the unit axis.
    double radius;    ///< Of the surrounding sphere.
    double stretch;   ///< How much the placed sphere's longest radius exceeds the shortest, at most; 0 for a sphere.
    double distance;

    Cone(const Sphere& sphere, const Vec3d& ref) {
      const Mat4d& m = sphere.object_to_scene();
      const Vec3d x{m[0][0], m[0][1], m[0][2]}, y{m[1][0], m[1][1], m[1][2]}, z{m[2][0], m[2][1], m[2][2]};
      // Gershgorin's circles bound the eigenvalues of M M^T, the squared stretches.
      const double xx = x.length2(), yy = y.length2(), zz = z.length2();
      const double xy = std::abs(x.dot(y)), yz = std::abs(y.dot(z)), zx = std::abs(z.dot(x));
      const double most = std::max({xx + xy + zx, yy + xy + yz, zz + yz + zx});
      const double least = std::min({xx - xy - zx, yy - xy - yz, zz - yz - zx});
      stretch = (most - least) / most;
      radius = std::sqrt(most) * sphere.r_;
      center = {m[3][0], m[3][1], m[3][2]};
      w = center - ref;
      distance = w.length();
      w /= distance;
    }
    bool is_outside() const { return distance > radius; }

    double sine() const { return radius / distance; }
    /// 1 - cos of the cone's half angle.
    double one_minus_cos_max() const {
      // sin^2 as a difference of squares near 1: just outside the sphere 1 - sin^2 cancels.
      const double s = sine(), cos2 = (distance - radius) * (distance + radius) / (distance * distance);
      return s * s / (1 + std::sqrt(cos2));
    }
    double pdf() const { return 1 / (2 * kPiD * one_minus_cos_max()); }

    /// A point of the sphere itself, the nearer one along a direction uniform in the cone.
    ShapeSample sample_sphere(bool flips, double u0, double u1) const {
      const double x_max = one_minus_cos_max(), x = u0 * x_max, s = sine(), cos_theta = 1 - x;
      // The sine of the angle of incidence is sin theta / s; its square in factors that do not cancel.
      const double sin2 = u0 * (2 - x) / (2 - x_max), cos2 = (1 - u0) * (2 - x_max * (1 + u0)) / (2 - x_max);
      const double sin_in = std::sqrt(sin2), cos_in = std::sqrt(std::max(cos2, 0.0));
      // From the centre the point lies at (angle of incidence - theta) off the axis.
      const double cos_alpha = sin2 * s + cos_theta * cos_in;
      const double sin_alpha = sin_in * (cos_theta - s * cos_in);
      const double phi = 2 * kPiD * u1;
      Vec3d a, b;
      make_frame(w, a, b);
      const Vec3d n = -(a * (std::cos(phi) * sin_alpha) + b * (std::sin(phi) * sin_alpha) + w * cos_alpha);
      return {center + n * radius, flips ? -n : n, pdf()};
    }
    Vec3d direction(double u0, double u1) const {
      const double x = u0 * one_minus_cos_max(), sin_theta = std::sqrt(x * (2 - x)), phi = 2 * kPiD * u1;
      Vec3d a, b;
      make_frame(w, a, b);
      return -(a * (std::cos(phi) * sin_theta) + b * (std::sin(phi) * sin_theta)) + w * (1 - x);
    }
  };

  /// Cone::sample_sphere() for a batch, as one loop that vectorises: directions, distances and densities straight
  /// from the cone, without the point. The density is 0 for reference points that are not clearly outside.
  void sample_cones(const Vec3d& center, double r, const ShapeSampleLanes& s) const {
    const double cx = center.x, cy = center.y, cz = center.z;
    const float side = flips_ ? -1.0f : 1.0f;
    for_lanes(s.n, [=](int i) {
      double wx = cx - static_cast<double>(s.ref.x[i]), wy = cy - static_cast<double>(s.ref.y[i]);
      double wz = cz - static_cast<double>(s.ref.z[i]);
      const double d = std::sqrt(wx * wx + wy * wy + wz * wz), inverse = 1 / d;
      wx *= inverse, wy *= inverse, wz *= inverse;
      const double sine = r * inverse, gap = (d - r) * (d + r);
      const double off =
          kRounding * (std::abs(wx * static_cast<double>(s.ref.x[i])) + std::abs(wy * static_cast<double>(s.ref.y[i])) +
                       std::abs(wz * static_cast<double>(s.ref.z[i])));
      const bool outside = d - r > off;
      const double cos_max = std::sqrt(outside ? gap : 0.0) * inverse;
      const double x_max = sine * sine / (1 + cos_max);
      const double u0 = static_cast<double>(s.u[i]), x = u0 * x_max, cos_theta = 1 - x;
      const double sin_theta = std::sqrt(x * (2 - x));
      const double cos2_in = (1 - u0) * (2 - x_max * (1 + u0)) / (2 - x_max);
      const double cos_in = std::sqrt(cos2_in > 0 ? cos2_in : 0.0);
      // make_frame()'s tangents, selected without a branch.
      const bool use_x = std::abs(wx) > std::abs(wy);
      const double len = 1 / std::sqrt(wz * wz + (use_x ? wx * wx : wy * wy));
      const double ax = use_x ? -wz * len : 0.0, ay = use_x ? 0.0 : wz * len, az = (use_x ? wx : -wy) * len;
      const double bx = wy * az - wz * ay, by = wz * ax - wx * az, bz = wx * ay - wy * ax;
      const SinCos phi = sin_cos_2pi(s.v[i]);
      const double p = -sin_theta * static_cast<double>(phi.cos), q = -sin_theta * static_cast<double>(phi.sin);
      s.wi.x[i] = static_cast<float>(ax * p + bx * q + wx * cos_theta);
      s.wi.y[i] = static_cast<float>(ay * p + by * q + wy * cos_theta);
      s.wi.z[i] = static_cast<float>(az * p + bz * q + wz * cos_theta);
      s.distance[i] = static_cast<float>(gap / (d * cos_theta + r * cos_in));
      s.cosine[i] = side * static_cast<float>(cos_in);
      s.pdf[i] = outside ? static_cast<float>(1 / (2 * kPiD * x_max)) : 0.0f;
    });
  }

  /// Whether a point whose coordinates are floats is on the sphere as far as they tell: neither inside nor outside.
  bool is_on_surface(const Cone& cone, const Vec3d& ref) const {
    const double from_center = transform_point(scene_to_object_, ref).length() / r_;
    const double off = std::abs(cone.w.x * ref.x) + std::abs(cone.w.y * ref.y) + std::abs(cone.w.z * ref.z);
    return std::abs(from_center - 1) * cone.radius <= kRounding * off;
  }

  /// From a point of the sphere itself, whichever side of it rounding put it on: what it sees of the sphere is the far
  /// side, by half of all directions.
  ShapeSample sample_on(const Vec3d& ref, double u0, double u1) const {
    const Vec3d o = transform_point(scene_to_object_, ref), on = o * (r_ / o.length());
    const Vec3d d = transform_vector(scene_to_object_, any_direction(u0, u1));
    const double t = -2 * on.dot(d) / d.length2();
    if (!(t > 0)) return {ref, {0, 0, 1}, 0};
    return on_sphere(on + t * d, 1 / (4 * kPiD));
  }

  /// For a sphere under a transform that is a similarity but for rounding (matrices written with six digits): a
  /// direction of the surrounding cone, and the point it hits, if any. The density stays exactly that of the cone.
  ShapeSample sample_nearly_round(const Cone& cone, const Vec3d& ref, double u0, double u1) const {
    const Vec3d o = transform_point(scene_to_object_, ref);
    const Vec3d d = transform_vector(scene_to_object_, cone.direction(u0, u1));
    double t0, t1;
    AxialQuadric{1, 1, 0, -r_ * r_}.roots(o.x, o.y, o.z, d.x, d.y, d.z, t0, t1);
    if (!(t0 > 0)) return {cone.center, -cone.w, 0};
    return on_sphere(o + t0 * d, cone.pdf());
  }

  /// Of all directions, evenly.
  static Vec3d any_direction(double u0, double u1) {
    const double z = 1 - 2 * u0, across = std::sqrt(std::max(0.0, 1 - z * z)), phi = 2 * kPiD * u1;
    return {across * std::cos(phi), across * std::sin(phi), z};
  }

  /// From inside: every direction meets the sphere, so all are equally likely. By area, a point just below the surface
  /// would get half of its light from the few samples next to it.
  ShapeSample sample_inside(const Vec3d& ref, double u0, double u1) const {
    const Vec3d o = transform_point(scene_to_object_, ref);
    const Vec3d d = transform_vector(scene_to_object_, any_direction(u0, u1));
    double t0, t1;
    AxialQuadric{1, 1, 0, -r_ * r_}.roots(o.x, o.y, o.z, d.x, d.y, d.z, t0, t1);
    // Not quite a sphere: there may be room for the point between it and the sphere around it.
    const double t = t0 > 0 ? t0 : t1;
    if (!(t > 0)) return {ref, {0, 0, 1}, 0};
    return on_sphere(o + t * d, 1 / (4 * kPiD));
  }

  /// A sample at a point of the sphere, or next to it, in object space.
  ShapeSample on_sphere(const Vec3d& p, double pdf) const {
    // Normals go by the inverse transpose.
    Vec3d n;
    scene_to_object_.transposed().multDirMatrix(p, n);
    n.normalize();
    return {transform_point(object_to_scene_, p * (r_ / p.length())), flips_ ? -n : n, pdf};
  }

  /// Whether a hit in (t_min, t_max) of any ray is possible: the roots in plain double, with a generous bound on their
  /// error. Most packets that meet the sphere's box end here, shadow rays towards it above all.
  bool may_hit(const ObjectRays& rays) const {
    const double minus_r2 = -r_ * r_;
    int any = 0;
#pragma omp simd reduction(| : any)
    for (int i = 0; i < rays.n; ++i) {
      const double ox = rays.ox[i], oy = rays.oy[i], oz = rays.oz[i];
      const double dx = rays.dx[i], dy = rays.dy[i], dz = rays.dz[i];
      const double a = dx * dx + dy * dy + dz * dz, o2 = ox * ox + oy * oy + oz * oz;
      const double half_b = ox * dx + oy * dy + oz * dz, d = half_b * half_b - a * (o2 + minus_r2);
      // half_b^2 <= a o2, so no term is larger than a (o2 + r^2), and there are a dozen roundings: 1e-14 covers them.
      const double largest = a * (o2 - minus_r2), slack = 1e-14 * largest, off = 1e-14 * std::sqrt(largest);
      const double s = std::sqrt(d + slack > 0 ? d + slack : 0.0);
      any |= (d + slack >= 0) & (-half_b - s - off < rays.t[i] * a) & (-half_b + s + off > rays.t_min[i] * a);
      any |= !(a * o2 < kHuge);  // not to be judged here
    }
    return any != 0;
  }

  /// The loop of the common case, kept free of branches so that it vectorises.
  void intersect_whole(const ObjectRays& rays) const {
    if (!may_hit(rays)) return;
    const double *ox = rays.ox, *oy = rays.oy, *oz = rays.oz, *dx = rays.dx, *dy = rays.dy, *dz = rays.dz;
    const double* t_min = rays.t_min;
    double* t_out = rays.t;
    const double minus_r2 = -r_ * r_;
    for_lanes(rays.n, [=](int i) {
      const DoubleDouble a = exact_dot(dx[i], dy[i], dz[i], dx[i], dy[i], dz[i]);
      const DoubleDouble half_b = exact_dot(ox[i], oy[i], oz[i], dx[i], dy[i], dz[i]);
      const DoubleDouble c = exact_dot(ox[i], oy[i], oz[i], ox[i], oy[i], oz[i]) + DoubleDouble{minus_r2, 0};
      double t0, t1;
      const bool real = solve_quadratic(a, half_b, c, t0, t1);
      const double t = t0 > t_min[i] ? t0 : t1;
      const bool hit = real & (t > t_min[i]) & (t < t_out[i]);
      t_out[i] = hit ? t : t_out[i];
    });
  }

  double r_ = 1, z_min_ = -1, z_max_ = 1, theta_at_z_min_ = kPiD, theta_at_z_max_ = 0;
  Sweep sweep_;
  bool whole_ = true;
};

const Register<Sphere> sphere{
    "sphere",
    "A sphere around the origin, or a part of one.",
    param(&Sphere::radius, "radius", 1.0f, Unit::Length, "Radius.", kNonNegative),
    param(&Sphere::zmin, "zmin", Unit::Length, "Lower end of the part that is there; -radius by default."),
    param(&Sphere::zmax, "zmax", Unit::Length, "Upper end of the part that is there; radius by default."),
    param(&Sphere::phimax, "phimax", 360.0f, Unit::Degrees, "Sweep around z, from x; above 360 is a full turn.",
          kPositive)};

}  // namespace
}  // namespace whit
