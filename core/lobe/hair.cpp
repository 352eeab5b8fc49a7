#include "core/lobe/hair.h"

#include "core/lobe/draw.h"
#include "core/lobe/formulas.h"
#include "core/lobe/pair.h"

namespace whit {

namespace {

/// The terms with a direction of their own: R, TT, TRT. One more holds the rest.
constexpr int kPaths = 3;

/// The angle of a direction to the fibre's normal plane.
struct Inclination {
  float sin, cos;
};
inline Inclination inclination(float along) { return {along, safe_sqrt((1 - along) * (1 + along))}; }

/// a + b, with the cosine's sign dropped: scales tilt no ray beyond the fibre's axis.
inline Inclination tilted(const Inclination& a, float sin_b, float cos_b) {
  return {a.sin * cos_b + a.cos * sin_b, std::abs(a.cos * cos_b - a.sin * sin_b)};
}

/// What happens to light that arrives from wo's side, but for its direction.
struct Fibre {
  Inclination r, tt, trt, o;  ///< The inclination of wo, as the scales tilt it for each path; o for all others.
  float gamma_o, gamma_t;     ///< Angles of the offset outside and inside.
  float reflected;            ///< Fresnel's reflectance at the surface.
  float length;               ///< Of a passage through the inside, in radii.
  float scale;                ///< Azimuthal, and the factor that makes its distribution integrate to 1:
  float norm;
};

inline Fibre fibre(const Lobe& lobe, int i, float along) {
  Fibre f;
  const Inclination o = inclination(along);
  const SinCos t1 = sin_cos(lobe.d[i]);
  const float sin2 = 2 * t1.sin * t1.cos, cos2 = 1 - 2 * t1.sin * t1.sin;
  const float sin4 = 2 * sin2 * cos2, cos4 = 1 - 2 * sin2 * sin2;
  f.r = tilted(o, -sin2, cos2);
  f.tt = tilted(o, t1.sin, t1.cos);
  f.trt = tilted(o, sin4, cos4);
  f.o.sin = o.sin, f.o.cos = o.cos;  // one by one: GCC vectorises no copy of a struct
  const float h = lobe.a[i], eta = lobe.eta[i];
  f.reflected = fresnel_dielectric(o.cos * safe_sqrt((1 - h) * (1 + h)), eta);
  // Bravais: across the fibre light refracts by the index sqrt(eta^2 - sin^2) / cos.
  const float bent = safe_sqrt((eta - o.sin) * (eta + o.sin));
  const float sin_t = clamp_to(h * o.cos / max_of(bent, 1e-6f), -1.0f, 1.0f);
  f.length = 2 * safe_sqrt((1 - sin_t) * (1 + sin_t)) * eta / max_of(bent, 1e-6f);
  f.gamma_o = asin_of(h), f.gamma_t = asin_of(sin_t);
  f.scale = lobe.c[i];
  const float e = exp_of(-kPi / f.scale);
  f.norm = (1 + e) / (f.scale * (1 - e));
  return f;
}

/// e^-x I0(x) for x >= 0, relative error 2e-7. Abramowitz and Stegun 9.8.1 and 9.8.2.
inline float scaled_bessel(float x) {
  const float y = x / 3.75f, t = y * y, r = 1 / max_of(y, 1.0f);
  const float near =
      1 + t * (3.5156229f + t * (3.0899424f + t * (1.2067492f + t * (0.2659732f + t * (0.0360768f + t * 0.0045813f)))));
  const float far =
      0.39894228f +
      r * (0.01328592f +
           r * (0.00225319f +
                r * (-0.00157565f +
                     r * (0.00916281f +
                          r * (-0.02057706f + r * (0.02635537f + r * (-0.01647633f + r * 0.00392377f)))))));
  const float below = exp_of(-x) * near, above = far / std::sqrt(max_of(x, 3.75f));
  return y < 1 ? below : above;
}

/// The longitudinal distribution M of variance v over the inclination of wi, per steradian and 1 / (2 pi): d'Eon et
/// al., equation 7. Its exponentials are gathered in that of cos(i + o) - 1, which is written without the difference.
inline float longitudinal(const Inclination& i, const Inclination& o, float v) {
  const float c = i.cos * o.cos - i.sin * o.sin, s = i.sin * o.cos + i.cos * o.sin;
  const float below_one = c > 0 ? s * s / (1 + c) : 1 - c;
  return exp_of(-below_one / v) * scaled_bessel(i.cos * o.cos / v) / (v * (1 - exp_of(-2 / v)));
}

/// The variance of path p; what follows TRT is as wide as it.
inline float path_variance(float v, int p) { return p == 0 ? v : p == 1 ? 0.25f * v : 4 * v; }

/// By how much path p turns a ray around the fibre that meets only smooth surfaces.
inline float turn(const Fibre& f, int p) {
  const float n = static_cast<float>(p);
  return 2 * n * f.gamma_t - 2 * f.gamma_o + n * kPi;
}

/// The azimuthal distribution N of path p, trimmed to one turn, at the angle phi from wo to wi.
inline float azimuthal(const Fibre& f, int p, float phi) {
  const float x = phi - turn(f, p);
  const float wrapped = x - kTwoPi * std::floor(x * (1 / kTwoPi) + 0.5f);
  const float e = exp_of(-std::abs(wrapped) / f.scale);
  return f.norm * e / ((1 + e) * (1 + e));
}

/// The directional part of each path: M times N.
struct Shape {
  float p[kPaths + 1];
};
inline Shape shape(const Fibre& f, float v, const Inclination& i, float phi) {
  return {{longitudinal(i, f.r, path_variance(v, 0)) * azimuthal(f, 0, phi),
           longitudinal(i, f.tt, path_variance(v, 1)) * azimuthal(f, 1, phi),
           longitudinal(i, f.trt, path_variance(v, 2)) * azimuthal(f, 2, phi),
           longitudinal(i, f.o, path_variance(v, 3)) * (1 / kTwoPi)}};
}

/// The share A of the light that each path has, for one colour channel.
inline Shape attenuation(const Fibre& f, float absorption) {
  const float passes = exp_of(-absorption * f.length);
  const float enters = (1 - f.reflected) * (1 - f.reflected);
  const float tt = enters * passes, again = passes * f.reflected, trt = tt * again;
  // All orders beyond: a geometric series. Where nothing enters, its quotient may be 1.
  const float left = 1 - again;
  return {{f.reflected, tt, trt, trt * again / (left > 0 ? left : 1.0f)}};
}

inline float sum_of(const Shape& a, const Shape& b) {
  return a.p[0] * b.p[0] + a.p[1] * b.p[1] + a.p[2] * b.p[2] + a.p[3] * b.p[3];
}

/// The share of samples of each path: that of the light, in luminance.
Shape path_shares(const Lobe& lobe, int i, const Fibre& f) {
  const Shape r = attenuation(f, lobe.colour1.r[i]), g = attenuation(f, lobe.colour1.g[i]),
              b = attenuation(f, lobe.colour1.b[i]);
  Shape share;
  float sum = 0;
  for (int p = 0; p <= kPaths; ++p) sum += share.p[p] = luminance({r.p[p], g.p[p], b.p[p]});
  for (float& x : share.p) x = sum > 0 ? x / sum : 0.25f;
  return share;
}

/// Two numbers in [0, 1) of the even and the odd bits of one.
Vec2f two_of(float u) {
  const auto bits = static_cast<uint32_t>(min_of(u, 0.99999994f) * 16777216.0f);
  uint32_t even = 0, odd = 0;
  for (int k = 0; k < 12; ++k) {
    even |= ((bits >> (2 * k)) & 1u) << k;
    odd |= ((bits >> (2 * k + 1)) & 1u) << k;
  }
  return {(static_cast<float>(even) + 0.5f) / 4096, (static_cast<float>(odd) + 0.5f) / 4096};
}

/// An inclination by the distribution M around o. d'Eon, A Fast Guide to Hair Sampling, 2013.
Inclination sample_longitudinal(const Inclination& o, float v, const Vec2f& u) {
  const float cos = clamp_to(1 + v * log_of(u.x + (1 - u.x) * exp_of(-2 / v)), -1.0f, 1.0f);
  const float sin = safe_sqrt((1 - cos) * (1 + cos));
  return inclination(clamp_to(-cos * o.sin + sin * sin_cos_2pi(u.y).cos * o.cos, -1.0f, 1.0f));
}

/// An angle by the trimmed logistic distribution.
float sample_logistic(float scale, float u) {
  const float low = exp_of(-kPi / scale) / (1 + exp_of(-kPi / scale));
  const float cdf = lerp(u, low, 1 - low);
  return clamp_to(scale * (log_of(cdf) - log_of(1 - cdf)), -kPi, kPi);
}

/// The density with which sample() finds wi, at point i; both in the local frame.
float density(const Lobe& lobe, int i, const Vec3f& wo, const Vec3f& wi) {
  const Fibre f = fibre(lobe, i, clamp_to(wo.x, -1.0f, 1.0f));
  const float phi = atan2_of(wo.y * wi.z - wo.z * wi.y, wo.y * wi.y + wo.z * wi.z);
  return sum_of(path_shares(lobe, i, f), shape(f, lobe.b[i], inclination(clamp_to(wi.x, -1.0f, 1.0f)), phi));
}

Vec3f sample(const Lobe& lobe, int i, const Vec3f& wo, float u, float v) {
  const Fibre f = fibre(lobe, i, clamp_to(wo.x, -1.0f, 1.0f));
  const Shape share = path_shares(lobe, i, f);
  int p = 0;
  while (p < kPaths && u >= share.p[p]) u -= share.p[p++];
  const float rest = share.p[p] > 0 ? clamp_to(u / share.p[p], 1e-7f, 1 - 1e-7f) : 0.5f;
  const Inclination tilts[] = {f.r, f.tt, f.trt, f.o};
  const Inclination w = sample_longitudinal(tilts[p], path_variance(lobe.b[i], p), two_of(v));
  const float turned = p < kPaths ? turn(f, p) + sample_logistic(f.scale, rest) : kTwoPi * rest;
  const SinCos phi = sin_cos(atan2_of(wo.z, wo.y) + turned);
  return {w.sin, w.cos * phi.cos, w.cos * phi.sin};
}

void eval(const LobeQuery& q, const LobeValues& out) {
  const Lobe& lobe = q.lobe;
  const ShadingBatch& s = q.s;
  const RGBLanes absorption = lobe.colour1;
  for_lanes(s.n, [&](int i) {
    const Vec3f o = s.wo[i], w = q.wi[i], x = q.frame.ss[i], y = q.frame.ts[i], z = s.ns[i];
    const float yo = dot(o, y), zo = dot(o, z), yi = dot(w, y), zi = dot(w, z);
    const float phi = atan2_of(yo * zi - zo * yi, yo * yi + zo * zi);
    const Fibre f = fibre(lobe, i, clamp_to(dot(o, x), -1.0f, 1.0f));
    const Shape m = shape(f, lobe.b[i], inclination(clamp_to(dot(w, x), -1.0f, 1.0f)), phi);
    // The model's own 1 / |cos| makes up for the surface's cosine: there is none.
    const float on = zo != 0 ? 1.0f : 0.0f;
    out.f.r[i] += on * lobe.weight.r[i] * sum_of(attenuation(f, absorption.r[i]), m);
    out.f.g[i] += on * lobe.weight.g[i] * sum_of(attenuation(f, absorption.g[i]), m);
    out.f.b[i] += on * lobe.weight.b[i] * sum_of(attenuation(f, absorption.b[i]), m);
  });
  if (!out.pdf) return;
  for (int i = 0; i < s.n; ++i) {
    const Frame t{q.frame.ss[i], q.frame.ts[i]};
    const Vec3f n = s.ns[i], wo = to_local(t, n, s.wo[i]);
    if (wo.z != 0) out.pdf[i] += out.share[i] * density(lobe, i, wo, to_local(t, n, q.wi[i]));
  }
}

void draw(const LobeDraw& d) {
  draw_one_by_one(d, [&](int i, const Vec3f& wo, float u, float v) { return sample(d.lobe, i, wo, u, v); });
}

}  // namespace

float hair_variance(float beta_m) {
  const float b2 = beta_m * beta_m, b4 = b2 * b2, b16 = b4 * b4 * b4 * b4;
  const float width = 0.726f * beta_m + 0.812f * b2 + 3.7f * (b16 * b4);
  return width * width;
}

float hair_azimuthal_scale(float beta_n) {
  constexpr float kRootPiOver8 = 0.626657069f;
  const float b2 = beta_n * beta_n, b4 = b2 * b2, b16 = b4 * b4 * b4 * b4;
  return kRootPiOver8 * (0.265f * beta_n + 1.194f * b2 + 5.372f * (b16 * b4 * b2));
}

const LobeRow lobe_rows::Hair = {
    .name = "hair",
    .effect = Effect::Glossy,
    .reflects = true,
    .transmits = true,
    .needs_frame = [](const Lobe&) { return true; },
    .eval = eval,
    .sample = draw,
};

}  // namespace whit
