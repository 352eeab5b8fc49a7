// Quadratic equations solved without cancellation, and the geometry that quadric shapes share.
//
// Coefficients are carried as unevaluated sums of two doubles (about 106 bits: Dekker 1971, Knuth's two-sum, and
// fma for exact products), so that b^2 - ac keeps its digits even for a ray that comes from a million radii away or
// grazes the surface. All of it is branch-free, so loops over rays vectorise.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/fastmath.h"
#include "core/base/vec.h"

namespace whit {

/// A number of about 106 bits: hi + lo, with |lo| at most half a unit in the last place of hi.
struct DoubleDouble {
  double hi = 0, lo = 0;
};

/// a + b exactly.
inline DoubleDouble exact_sum(double a, double b) {
  const double s = a + b, bb = s - a;
  return {s, (a - (s - bb)) + (b - bb)};
}

/// a * b exactly (unless the error underflows).
inline DoubleDouble exact_product(double a, double b) {
  const double p = a * b;
  return {p, std::fma(a, b, -p)};
}

inline DoubleDouble operator-(const DoubleDouble& a) { return {-a.hi, -a.lo}; }

[[gnu::always_inline]] inline DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble s = exact_sum(a.hi, b.hi), t = exact_sum(a.lo, b.lo);
  const double lo = s.lo + t.hi, hi = s.hi + lo;
  const double rest = (lo - (hi - s.hi)) + t.lo, sum = hi + rest;
  return {sum, rest - (sum - hi)};
}

inline DoubleDouble operator-(const DoubleDouble& a, const DoubleDouble& b) { return a + (-b); }

[[gnu::always_inline]] inline DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble p = exact_product(a.hi, b.hi);
  const double lo = p.lo + (a.hi * b.lo + a.lo * b.hi), hi = p.hi + lo;
  return {hi, lo - (hi - p.hi)};
}

/// ax bx + ay by + az bz to 106 bits.
[[gnu::always_inline]] inline DoubleDouble exact_dot(double ax, double ay, double az, double bx, double by, double bz) {
  return exact_product(ax, bx) + exact_product(ay, by) + exact_product(az, bz);
}

/// a / b rounded to double; infinite or NaN where the quotient of the leading parts is.
[[gnu::always_inline]] inline double quotient(const DoubleDouble& a, const DoubleDouble& b) {
  const double t = a.hi / b.hi;
  const DoubleDouble rest = a - b * DoubleDouble{t, 0};
  const double correction = rest.hi / b.hi;
  return std::abs(correction) <= std::abs(t) ? t + correction : t;
}

/// The roots t0 <= t1 of a t^2 + 2 half_b t + c = 0, each within one unit in the last place of the exact root of
/// these coefficients. Returns false when there are none. Where a is 0 the one root is finite and the other
/// infinite; where nothing determines a root it is NaN, which no comparison accepts.
[[gnu::always_inline]] inline bool solve_quadratic(const DoubleDouble& a, const DoubleDouble& half_b,
                                                   const DoubleDouble& c, double& t0, double& t1) {
  const DoubleDouble d = half_b * half_b - a * c;
  const bool real = d.hi >= 0;
  const double s = std::sqrt(real ? d.hi : 0.0);
  const DoubleDouble rest = d - exact_product(s, s);
  const DoubleDouble root = exact_sum(s, s > 0 ? rest.hi / (2 * s) : 0.0);
  // Both terms of q have the same sign: nothing cancels.
  const double sign = half_b.hi >= 0 ? 1.0 : -1.0;
  const DoubleDouble q = -(half_b + DoubleDouble{sign * root.hi, sign * root.lo});
  const double ta = quotient(q, a), tb = quotient(c, q);
  t0 = ta < tb ? ta : tb;
  t1 = ta < tb ? tb : ta;
  return real;
}

/// The quadric wx (x^2 + y^2) + wz z^2 + 2 lz z + w = 0 around the z axis.
struct AxialQuadric {
  double wx = 1, wz = 0, lz = 0, w = 0;

  /// The values t0 <= t1 at which the line o + t d meets it; NaN when it does not. The quadric's own origin lies at
  /// z_shift on the z axis: subtracted here, where the difference keeps all its digits.
  [[gnu::always_inline]] void roots(double ox, double oy, double oz, double dx, double dy, double dz, double& t0,
                                    double& t1, double z_shift = 0) const {
    const DoubleDouble z = exact_sum(oz, -z_shift), two_z{2 * z.hi, 2 * z.lo};
    const DoubleDouble dwx{wx, 0}, dwz{wz, 0}, dlz{lz, 0};
    const DoubleDouble a = dwx * (exact_product(dx, dx) + exact_product(dy, dy)) + dwz * exact_product(dz, dz);
    const DoubleDouble half_b = dwx * (exact_product(ox, dx) + exact_product(oy, dy)) +
                                dwz * (z * DoubleDouble{dz, 0}) + dlz * DoubleDouble{dz, 0};
    const DoubleDouble c =
        dwx * (exact_product(ox, ox) + exact_product(oy, oy)) + dwz * (z * z) + dlz * two_z + DoubleDouble{w, 0};
    double near_root, far_root;
    const bool real = solve_quadratic(a, half_b, c, near_root, far_root);
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    t0 = real ? near_root : kNone;
    t1 = real ? far_root : kNone;
  }

  Vec3d gradient(const Vec3d& p) const { return {2 * wx * p.x, 2 * wx * p.y, 2 * (wz * p.z + lz)}; }

  /// A point near the surface moved onto it, along the gradient (two steps of Newton).
  Vec3d project(Vec3d p) const {
    for (int step = 0; step < 2; ++step) {
      const double f = wx * (p.x * p.x + p.y * p.y) + (wz * p.z + 2 * lz) * p.z + w;
      const Vec3d g = gradient(p);
      const double length2 = g.length2();
      if (length2 > 0) p -= g * (f / length2);
    }
    return p;
  }
};

/// Finds the nearest hits of rays (ObjectRays of core/plugin/shape.h) with the part of a quadric that
/// `covers(const Vec3d& p)` accepts: the nearer root first, then the farther one. The quadric's own origin lies at
/// z_shift on the z axis; covers() gets points relative to that.
template <class Rays, class Covers>
void intersect_quadric(const Rays& rays, const AxialQuadric& quadric, const Covers& covers, double z_shift = 0) {
  constexpr int kBlock = 16;
  double near_root[kBlock], far_root[kBlock];
  for (int first = 0; first < rays.n; first += kBlock) {
    const int n = std::min(kBlock, rays.n - first);
    const double *ox = rays.ox + first, *oy = rays.oy + first, *oz = rays.oz + first;
    const double *dx = rays.dx + first, *dy = rays.dy + first, *dz = rays.dz + first;
#pragma omp simd
    for (int i = 0; i < n; ++i) {
      quadric.roots(ox[i], oy[i], oz[i], dx[i], dy[i], dz[i], near_root[i], far_root[i], z_shift);
    }
    for (int i = 0; i < n; ++i) {
      const auto hits = [&](double t) {
        return t > rays.t_min[first + i] && t < rays.t[first + i] &&
               covers(Vec3d(ox[i] + t * dx[i], oy[i] + t * dy[i], oz[i] - z_shift + t * dz[i]));
      };
      if (hits(near_root[i])) {
        rays.t[first + i] = near_root[i];
      } else if (hits(far_root[i])) {
        rays.t[first + i] = far_root[i];
      }
    }
  }
}

inline constexpr double kPiD = 3.14159265358979323846;

/// Degrees to radians.
inline double radians(double degrees) { return degrees * (kPiD / 180); }

/// The angle of (x, y) from the x axis, in [0, 2 pi], within 1e-12; 0 at the origin.
inline double azimuth(double x, double y) {
  const double phi = detail::atan2_kernel(y, x);
  return phi < 0 ? phi + 2 * kPiD : phi;
}

/// The part of a turn around the z axis that a shape sweeps, from the x axis.
struct Sweep {
  double phi_max = 2 * kPiD;  ///< Radians, in (0, 2 pi].
  explicit Sweep(double degrees = 360) : phi_max(degrees >= 360 ? 2 * kPiD : radians(degrees)) {}
  bool covers(double x, double y) const { return phi_max >= 2 * kPiD || azimuth(x, y) <= phi_max; }
  /// The parameter u in [0,1] of a point.
  double u(double x, double y) const { return clamp_to(azimuth(x, y) / phi_max, 0.0, 1.0); }
};

/// The distance of a point from the z axis. Coordinates come from floats: their squares stay within double's range.
inline double axis_distance(double x, double y) { return std::sqrt(x * x + y * y); }

/// The unit vector from the z axis towards a point; (1, 0) on the axis, where any direction is as good.
inline Vec2d away_from_axis(double x, double y) {
  const double r = axis_distance(x, y), inverse = 1 / (r > 0 ? r : 1.0);
  return Vec2d(r > 0 ? x * inverse : 1.0, y * inverse);
}

/// A point of a curve r(v), z(v) that is turned around the z axis, with its derivatives by v. z'' is 0.
struct Meridian {
  double r, dr, dz, ddr;
};

/// The partial derivatives of a surface of revolution and of its unit normal, by u (phi = u phi_max) and v.
struct SurfaceDerivatives {
  Vec3d dpdu, dpdv, dndu, dndv;
};

/// Derivatives at the azimuth of the unit vector `out`. Where the surface meets its axis (m.r is 0) m.r must be
/// replaced by a small radius, so that dpdu x dpdv still has a direction.
inline SurfaceDerivatives revolve(const Meridian& m, const Vec2d& out, double phi_max) {
  const Vec3d e{out.x, out.y, 0}, around{-out.y, out.x, 0};
  const double l = std::sqrt(m.dz * m.dz + m.dr * m.dr), dl = m.dr * m.ddr / l;
  // The unit normal is (dz e - dr k) / l, k the z axis.
  return {phi_max * m.r * around, m.dr * e + Vec3d(0, 0, m.dz), phi_max * (m.dz / l) * around,
          e * (-m.dz * dl / (l * l)) + Vec3d(0, 0, (-m.ddr + m.dr * dl / l) / l)};
}

/// The derivatives of the unit normal from those of the surface (Weingarten's equations).
inline void weingarten(const Vec3d& dpduu, const Vec3d& dpduv, const Vec3d& dpdvv, SurfaceDerivatives& s) {
  const Vec3d n = s.dpdu.cross(s.dpdv).normalized();
  const double E = s.dpdu.dot(s.dpdu), F = s.dpdu.dot(s.dpdv), G = s.dpdv.dot(s.dpdv);
  const double e = n.dot(dpduu), f = n.dot(dpduv), g = n.dot(dpdvv), area2 = E * G - F * F;
  s.dndu = s.dpdu * ((f * F - e * G) / area2) + s.dpdv * ((e * F - f * E) / area2);
  s.dndv = s.dpdu * ((g * F - f * G) / area2) + s.dpdv * ((f * F - g * E) / area2);
}

/// A bound on the error of a point that was put on a quadric in double precision: 16 roundings of its largest
/// component.
inline Vec3d rounding_bound(const Vec3d& p) {
  const double xy = std::abs(p.x) > std::abs(p.y) ? std::abs(p.x) : std::abs(p.y);
  const double largest = std::abs(p.z) > xy ? std::abs(p.z) : xy;
  return Vec3d(largest * 16 * 1.1102230246251565e-16);
}

}  // namespace whit
