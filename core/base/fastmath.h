// Elementary functions and small vector helpers for loops over batches.
//
// Why not <cmath>: a vectorised loop and its scalar tail would call different routines, so a lane's bits
// would depend on where in a batch it stands, and many libm calls do not vectorise at all. The functions here
// are branch-free basic arithmetic. They take and return floats and work in double inside, so that plain
// polynomials without compensation are right to 1 ulp; the polynomials are minimax fits (Remez) made for this
// file.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "core/base/vec.h"

namespace whit {

inline constexpr float kPi = 3.14159265358979323846f;
inline constexpr float kInvPi = 0.31830988618379067154f;
inline constexpr float kTwoPi = 6.28318530717958647693f;
inline constexpr float kPiOver2 = 1.57079632679489661923f;

/// The smaller of two numbers; b when either is NaN.
inline float min_of(float a, float b) { return a < b ? a : b; }
/// The larger of two numbers; b when either is NaN.
inline float max_of(float a, float b) { return a > b ? a : b; }
/// x kept within [lo, hi]; lo when x is NaN.
inline float clamp_to(float x, float lo, float hi) { return min_of(max_of(x, lo), hi); }
inline double clamp_to(double x, double lo, double hi) {
  const double above = x > lo ? x : lo;
  return above < hi ? above : hi;
}
/// The square root of max(x, 0).
inline float safe_sqrt(float x) { return std::sqrt(max_of(x, 0.0f)); }
inline float lerp(float t, float a, float b) { return (1 - t) * a + t * b; }

struct SinCos {
  float sin, cos;
};

namespace detail {

/// Adding and subtracting this rounds a double to an integer, and leaves that integer in the low bits of the
/// sum.
inline constexpr double kRoundMagic = 6755399441055744.0;  // 1.5 * 2^52

struct SinCosD {
  double sin, cos;
};

/// sin and cos of q * pi/2 + r for an integer q given in the low bits of `quadrant`, |r| <= pi/4.
inline SinCosD sin_cos_quadrant(uint64_t quadrant, double r) {
  const double x = r * r;
  const double s =
      r * (0.999999999999995692 +
           x * (-0.16666666666616435 +
                x * (0.0083333333238403535 +
                     x * (-0.000198412632787955473 + x * (2.75552678116286436e-6 + x * -2.47562648495596106e-8)))));
  const double c =
      0.999999999999944076 +
      x * (-0.499999999993478705 +
           x * (0.0416666665434206514 +
                x * (-0.00138888803683454748 + x * (0.0000247989234579707064 + x * -2.71730483901980864e-7))));
  const bool swap = (quadrant & 1) != 0;
  const double sin_abs = swap ? c : s, cos_abs = swap ? s : c;
  const double sin_sign = (quadrant & 2) != 0 ? -1.0 : 1.0;
  const double cos_sign = ((quadrant + 1) & 2) != 0 ? -1.0 : 1.0;
  return {sin_abs * sin_sign, cos_abs * cos_sign};
}

/// log2 of x > 0 (finite, normal), relative error 1e-13.
inline double log2_kernel(double x) {
  constexpr uint64_t kOne = 0x3ff0000000000000u;
  constexpr uint64_t kSqrtHalf = 0x3fe6a09e667f3bcdu;
  const uint64_t u = std::bit_cast<uint64_t>(x);
  const uint64_t biased = (u + (kOne - kSqrtHalf)) >> 52;  // so that the mantissa lies in [sqrt(1/2), sqrt(2))
  const double m = std::bit_cast<double>(u - ((biased - 1023) << 52));
  const double e = std::bit_cast<double>(biased | 0x4330000000000000u) - (4503599627370496.0 + 1023.0);
  const double f = (m - 1) / (m + 1), t = f * f;
  const double atanh_over_f =
      0.999999999999973433 +
      t * (0.333333333398224771 +
           t * (0.199999974354896849 +
                t * (0.142860842071016911 + t * (0.110870753990268667 + t * 0.0980479618257920297))));
  return e + 2.88539008177792681 * f * atanh_over_f;  // 2 / ln 2
}

/// 2^t for |t| <= 1000, relative error 5e-11.
inline double exp2_kernel(double t) {
  const double k = t + kRoundMagic;
  const double r = t - (k - kRoundMagic);
  const double p =
      0.999999999959496961 +
      r * (0.693147180556827427 +
           r * (0.240226512141200535 +
                r * (0.0555041090637373728 + r * (0.00961802553039820806 +
                                                  r * (0.00133334784098653989 +
                                                       r * (0.00015469755744925822 + r * 0.0000153037211308013651))))));
  const double scale = std::bit_cast<double>((std::bit_cast<uint64_t>(k) << 52) + 0x3ff0000000000000u);
  return p * scale;
}

/// asin of |z| <= 1/2.
inline double asin_kernel(double z) {
  const double t = z * z;
  return z * (1.00000000000000318 +
              t * (0.166666666663588187 +
                   t * (0.0750000004900650661 +
                        t * (0.044642826841211414 +
                             t * (0.0303829006485010063 +
                                  t * (0.0223546660027981493 +
                                       t * (0.0175505525122664311 +
                                            t * (0.0125473468401732298 +
                                                 t * (0.0179352920631600573 + t * (-0.00733106668790879818 +
                                                                                   t * 0.0315194831774761267))))))))));
}

inline constexpr double kPiD = 3.14159265358979323846;

/// The angle of (x, y) in (-pi, pi], error 1e-12; 0 at the origin.
inline double atan2_kernel(double y, double x) {
  const double ax = std::abs(x), ay = std::abs(y);
  const double small = ax < ay ? ax : ay, large = ax < ay ? ay : ax;
  const bool upper = small > 0.41421356237309503 * large;  // tan(pi/8): reduce by 45 degrees
  const double num = upper ? small - large : small;
  const double den = upper ? small + large : large;
  const double z = num / (den > 0 ? den : 1.0), t = z * z;
  const double p =
      z *
      (0.999999999999239115 +
       t * (-0.333333332765574532 +
            t * (0.199999930155473431 +
                 t * (-0.142853850858703831 +
                      t * (0.111034301559724669 +
                           t * (-0.0899230448651733591 + t * (0.0697306111496183722 + t * -0.0376347887053254317)))))));
  const double octant = upper ? p + 0.25 * kPiD : p;
  const double quadrant = ax < ay ? 0.5 * kPiD - octant : octant;
  const double half = x < 0 ? kPiD - quadrant : quadrant;
  return y < 0 ? -half : half;
}

}  // namespace detail

/// Sine and cosine of x in radians, within 1 ulp for |x| <= 1e6; useless but finite beyond 1e9.
inline SinCos sin_cos(float x) {
  const double xd = x;
  const double k = xd * 0.63661977236758134308 + detail::kRoundMagic;
  const double q = k - detail::kRoundMagic;
  // pi/2 in two parts: the first has so few bits that its product with q is exact.
  const double r = (xd - q * 1.5707963267341256) - q * 6.0771005065061926e-11;
  const auto sc = detail::sin_cos_quadrant(std::bit_cast<uint64_t>(k), r);
  return {static_cast<float>(sc.sin), static_cast<float>(sc.cos)};
}

/// Sine and cosine of 2 pi u, within 1 ulp; exact at multiples of a quarter. For |u| <= 1e6.
inline SinCos sin_cos_2pi(float u) {
  const double k = 4.0 * static_cast<double>(u) + detail::kRoundMagic;
  const double r = (4.0 * static_cast<double>(u) - (k - detail::kRoundMagic)) * (0.5 * detail::kPiD);
  const auto sc = detail::sin_cos_quadrant(std::bit_cast<uint64_t>(k), r);
  return {static_cast<float>(sc.sin), static_cast<float>(sc.cos)};
}

inline float sin_of(float x) { return sin_cos(x).sin; }
inline float cos_of(float x) { return sin_cos(x).cos; }
/// Tangent of x in radians, within 2 ulp for |x| <= 1e6.
inline float tan_of(float x) {
  const SinCos sc = sin_cos(x);
  return sc.sin / sc.cos;
}

/// e^x within 1 ulp; 0 far below, infinity above 88.7; 0 for NaN.
inline float exp_of(float x) {
  const float bounded = clamp_to(x, -150.0f, 150.0f);
  return static_cast<float>(detail::exp2_kernel(1.44269504088896340736 * static_cast<double>(bounded)));
}

/// Natural logarithm within 1 ulp; -infinity at 0, NaN below and for NaN, infinity at infinity.
inline float log_of(float x) {
  const double y = 0.69314718055994530942 * detail::log2_kernel(static_cast<double>(x));
  constexpr float inf = std::numeric_limits<float>::infinity();
  const float edge = x == 0 ? -inf : (x > 0 ? inf : std::numeric_limits<float>::quiet_NaN());
  return x > 0 && x < inf ? static_cast<float>(y) : edge;
}

/// x^y within 1 ulp for x >= 0 (a negative x counts as 0, as does NaN). x^0 is 1 everywhere.
inline float pow_of(float x, float y) {
  constexpr float inf = std::numeric_limits<float>::infinity();
  const bool regular = x > 0 && x < inf;
  const double t = static_cast<double>(y) * detail::log2_kernel(static_cast<double>(x));
  const double bounded = t > 300 ? 300.0 : (t > -300 ? t : -300.0);
  const float value = static_cast<float>(detail::exp2_kernel(bounded));
  const float towards = x > 0 ? y : -y;  // positive: to infinity, from x = infinity or x = 0
  const float edge = towards > 0 ? inf : 0.0f;
  const float v = regular ? value : edge;
  return y == 0 ? 1.0f : v;
}

/// The angle of (x, y) in (-pi, pi], within 1 ulp; 0 at the origin.
inline float atan2_of(float y, float x) {
  return static_cast<float>(detail::atan2_kernel(static_cast<double>(y), static_cast<double>(x)));
}

/// Arc sine within 1 ulp; the argument is clamped to [-1, 1], because rounding leaves the closed range.
inline float asin_of(float x) {
  const double a = static_cast<double>(min_of(std::abs(x), 1.0f));
  const bool large = a > 0.5;
  const double y = detail::asin_kernel(large ? std::sqrt(0.5 * (1 - a)) : a);
  const double r = large ? 0.5 * detail::kPiD - 2 * y : y;
  return static_cast<float>(x < 0 ? -r : r);
}

/// Arc cosine in [0, pi] within 1 ulp; the argument is clamped to [-1, 1], because rounding leaves the closed
/// range.
inline float acos_of(float x) {
  const double a = static_cast<double>(min_of(std::abs(x), 1.0f));
  const bool large = a > 0.5;
  const double y = detail::asin_kernel(large ? std::sqrt(0.5 * (1 - a)) : a);
  const double r = large ? 2 * y : 0.5 * detail::kPiD - y;  // of |x|
  return static_cast<float>(x < 0 ? detail::kPiD - r : r);
}

inline float dot(const Vec3f& a, const Vec3f& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline float abs_dot(const Vec3f& a, const Vec3f& b) { return std::abs(dot(a, b)); }
inline Vec3f cross(const Vec3f& a, const Vec3f& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline float length(const Vec3f& v) { return std::sqrt(dot(v, v)); }

/// v / |v|; (0, 0, 0) for the zero vector. For vectors whose squared length neither over- nor underflows.
inline Vec3f normalize(const Vec3f& v) {
  const float d = dot(v, v);
  const float s = d > 0 ? 1 / std::sqrt(d) : 0.0f;
  return {v.x * s, v.y * s, v.z * s};
}

/// v / |v| for vectors of any finite length (surface derivatives can be tiny or huge); (0, 0, 0) for zero.
inline Vec3f normalize_any(const Vec3f& v) {
  const float m = max_of(std::abs(v.x), max_of(std::abs(v.y), std::abs(v.z)));
  // In two steps, because 1/m overflows for a denormal m.
  const float s = m > 1.17549435e-38f ? 1 / m : 0.0f;
  return normalize(Vec3f(v.x * s, v.y * s, v.z * s));
}

/// `v`, turned to the side of `n`: v or -v, v when perpendicular.
inline Vec3f face_forward(const Vec3f& v, const Vec3f& n) {
  const float s = dot(v, n) < 0 ? -1.0f : 1.0f;
  return {v.x * s, v.y * s, v.z * s};
}

struct Frame {
  Vec3f s, t;  ///< With the vector it was built around, a right-handed orthonormal basis (s, t, n).
};

/// Two unit vectors perpendicular to the unit vector n and to each other, without branches or singularities.
/// Source: Duff et al., Building an Orthonormal Basis, Revisited, JCGT 6(1), 2017.
inline Frame coordinate_system(const Vec3f& n) {
  const float sign = n.z < 0 ? -1.0f : 1.0f;
  const float a = -1 / (sign + n.z);
  const float b = n.x * n.y * a;
  return {{1 + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}};
}

}  // namespace whit
