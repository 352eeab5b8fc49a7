#include "core/lobe/disney.h"

#include "core/lobe/microfacet.h"
#include "core/lobe/pair.h"

namespace whit {

namespace {

/// A distribution whose masking and shadowing are independent: G = G1(wo) G1(wi).
template <class Distribution>
struct Separable : Distribution {};

/// What makes of the height-correlated G the separable one: see smith_term() and the formulas it goes into.
template <class Distribution>
inline float smith_sum(const Separable<Distribution>& d, const Pair& p) {
  const float sum = 0.5f * (std::abs(p.zo) + d.smith(p.wo, p.zo)) * (std::abs(p.zi) + d.smith(p.wi, p.zi));
  return sum > 0 ? sum : 1.0f;
}

/// Calls add(i, pair, distribution) for every lane.
template <class Add>
void for_separable(const Lobe& lobe, const ShadingBatch& s, const LobeFrame& frame, const Vec3Lanes& wi,
                   const Add& add) {
  if (lobe.a == lobe.b) {
    for_lanes(s.n, [&](int i) { add(i, make_pair(s, wi, i), Separable<Isotropic>{{lobe.a[i]}}); });
  } else {
    for_lanes(s.n, [&](int i) {
      add(i, make_pair(s, wi, i), Separable<Anisotropic>{{lobe.a[i], lobe.b[i], frame.ss[i], frame.ts[i]}});
    });
  }
}

/// Schlick's weight of angles that rounding or a facet seen from behind takes out of the range.
inline float bounded_schlick(float x) { return schlick_weight(clamp_to(x, 0.0f, 1.0f)); }

/// Schlick's weights of both directions, and the cosine between wi and the half vector.
struct Angles {
  float o, i, cos_d;
};
inline Angles angles(const Pair& p) {
  return {bounded_schlick(std::abs(p.zo)), bounded_schlick(std::abs(p.zi)), dot(p.wi, normalize(p.wo + p.wi))};
}

/// Burley 2015, equation 4, base: halved at grazing angles.
inline float diffuse(const Angles& a) { return kInvPi * (1 - 0.5f * a.o) * (1 - 0.5f * a.i); }

/// Burley 2015, equation 4: rough surfaces send light back to where it came from.
inline float retro(const Angles& a, float roughness) {
  const float r = 2 * roughness * a.cos_d * a.cos_d;
  return kInvPi * r * (a.o + a.i + a.o * a.i * (r - 1));
}

/// Burley 2012, section 5.3: the Hanrahan-Krueger approximation of subsurface scattering, scaled to keep the albedo.
inline float fake_subsurface(const Angles& a, const Pair& p, float roughness) {
  const float f90 = roughness * a.cos_d * a.cos_d;
  const float f = lerp(a.o, 1, f90) * lerp(a.i, 1, f90);
  const float sum = std::abs(p.zo) + std::abs(p.zi);
  return kInvPi * 1.25f * (f * (1 / (sum > 0 ? sum : 1.0f) - 0.5f) + 0.5f);
}

/// Generalised Trowbridge-Reitz with exponent 1, from the squared cosine and sine to the normal; 0 < alpha < 1.
inline float gtr1(float cos2, float sin2, float alpha) {
  const float a2 = alpha * alpha;
  return (a2 - 1) / (kPi * log_of(a2) * (sin2 + a2 * cos2));
}

/// The coat's masking term is that of alpha 0.25, whatever its gloss.
inline float coat_masking(float cosine) {
  constexpr float a2 = 0.25f * 0.25f;
  return 1 / (cosine + std::sqrt(a2 + (1 - a2) * cosine * cosine));
}

/// Burley 2012, section 5.6: a layer of index 1.5, hence 0.04, at a quarter of its strength.
inline float clearcoat(const Pair& p, float alpha) {
  const Vec3f h = normalize(p.wo + p.wi);
  const float z = dot(h, p.n), cos_d = dot(p.wo, h);
  const float sin2 = across2(h, p.n);
  const float fresnel = lerp(bounded_schlick(cos_d), 0.04f, 1);
  const float masking = coat_masking(std::abs(p.zo)) * coat_masking(std::abs(p.zi));
  // Without a half vector there is no coat, and no division by 0.
  const float density = gtr1(z * z, z != 0 ? sin2 : 1.0f, alpha);
  return 0.25f * masking * fresnel * density;
}

/// f(i, pair) for every lane, times the cosine.
template <class F>
void add_reflected(const Lobe& lobe, const ShadingBatch& s, const Vec3Lanes& wi, const RGBLanes& out, const F& f) {
  for_lanes(s.n, [&](int i) {
    const Pair p = make_pair(s, wi, i);
    accumulate(out, i, lobe.weight, f(i, p) * std::abs(p.zi) * p.reflects);
  });
}

/// The reflectance of a facet goes from a dielectric's to a coloured Schlick approximation as `metallic` says.
void add_reflection(const Lobe& lobe, const ShadingBatch& s, const LobeFrame& frame, const Vec3Lanes& wi,
                    const RGBLanes& out) {
  const RGBLanes r0 = lobe.colour1;
  for_separable(lobe, s, frame, wi, [&](int i, const Pair& p, const auto& d) {
    const float f = microfacet_reflection(d, p, FresnelType::One, 1.0f);
    const Vec3f h = normalize(p.wo + p.wi);
    const float cos_facet = dot(p.wi, h) * (dot(h, p.n) < 0 ? -1.0f : 1.0f);
    const float metallic = lobe.c[i], weight = bounded_schlick(cos_facet);
    const float dielectric = (1 - metallic) * fresnel_dielectric(cos_facet, lobe.eta[i]);
    const auto reflectance = [&](float r) { return dielectric + metallic * lerp(weight, r, 1); };
    out.r[i] += lobe.weight.r[i] * f * reflectance(r0.r[i]);
    out.g[i] += lobe.weight.g[i] * f * reflectance(r0.g[i]);
    out.b[i] += lobe.weight.b[i] * f * reflectance(r0.b[i]);
  });
}

void add_transmission(const Lobe& lobe, const ShadingBatch& s, const LobeFrame& frame, const Vec3Lanes& wi,
                      const RGBLanes& out) {
  for_separable(lobe, s, frame, wi, [&](int i, const Pair& p, const auto& d) {
    accumulate(out, i, lobe.weight, microfacet_transmission(d, p, lobe.eta[i]));
  });
}

}  // namespace

void add_disney(const Lobe& lobe, const ShadingBatch& s, const LobeFrame& frame, const Vec3Lanes& wi,
                const RGBLanes& out) {
  const float* const a = lobe.a;
  switch (lobe.type) {
    case LobeType::DisneyDiffuse:
      return add_reflected(lobe, s, wi, out, [](int, const Pair& p) { return diffuse(angles(p)); });
    case LobeType::DisneyFakeSubsurface:
      return add_reflected(lobe, s, wi, out, [a](int i, const Pair& p) { return fake_subsurface(angles(p), p, a[i]); });
    case LobeType::DisneyRetro:
      return add_reflected(lobe, s, wi, out, [a](int i, const Pair& p) { return retro(angles(p), a[i]); });
    case LobeType::DisneySheen:
      return add_reflected(lobe, s, wi, out, [](int, const Pair& p) { return bounded_schlick(angles(p).cos_d); });
    case LobeType::DisneyClearcoat:
      return add_reflected(lobe, s, wi, out, [a](int i, const Pair& p) { return clearcoat(p, a[i]); });
    case LobeType::DisneyReflection: return add_reflection(lobe, s, frame, wi, out);
    case LobeType::DisneyTransmission: return add_transmission(lobe, s, frame, wi, out);
    default: return;
  }
}

float clearcoat_pdf(float alpha, const Vec3f& wo, const Vec3f& wi) {
  if (wo.z * wi.z <= 0) return 0;
  const Vec3f h = normalize(wo + wi);
  const float cos_d = abs_dot(wo, h);
  return cos_d > 0 ? gtr1(h.z * h.z, h.x * h.x + h.y * h.y, alpha) * std::abs(h.z) / (4 * cos_d) : 0.0f;
}

Vec3f sample_clearcoat(float alpha, const Vec3f& wo, float u, float v) {
  const float a2 = alpha * alpha;
  const float cos2 = clamp_to((1 - pow_of(a2, 1 - u)) / (1 - a2), 0.0f, 1.0f);
  const float sin = safe_sqrt(1 - cos2), side = wo.z < 0 ? -1.0f : 1.0f;
  const SinCos phi = sin_cos_2pi(v);
  const Vec3f h = Vec3f(sin * phi.cos, sin * phi.sin, safe_sqrt(cos2)) * side;
  const Vec3f wi = h * (2 * dot(wo, h)) - wo;
  return wi.z * wo.z > 0 ? wi : Vec3f(0, 0, 0);
}

}  // namespace whit
