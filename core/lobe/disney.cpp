// The lobes of Disney's BSDF: its diffuse family, its clear coat, and microfacets with its own masking and Fresnel
// terms. Burley, Physically Based Shading at Disney, 2012, and Extending the Disney BRDF to a BSDF with Integrated
// Subsurface Scattering, 2015, as pbrt-v3 has them.
#include "core/lobe/microfacet.h"

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
void eval_diffuse(const LobeQuery& q, const LobeValues& out, const F& f) {
  for_pairs(q, out, [&](int i, const Pair& p, const auto& add_density) {
    accumulate(out.f, i, q.lobe.weight, f(i, p) * std::abs(p.zi) * p.reflects);
    add_density(diffuse_density(p));
  });
}

void eval_base(const LobeQuery& q, const LobeValues& out) {
  eval_diffuse(q, out, [](int, const Pair& p) { return diffuse(angles(p)); });
}

void eval_fake_subsurface(const LobeQuery& q, const LobeValues& out) {
  eval_diffuse(q, out, [a = q.lobe.a](int i, const Pair& p) { return fake_subsurface(angles(p), p, a[i]); });
}

void eval_retro(const LobeQuery& q, const LobeValues& out) {
  eval_diffuse(q, out, [a = q.lobe.a](int i, const Pair& p) { return retro(angles(p), a[i]); });
}

void eval_sheen(const LobeQuery& q, const LobeValues& out) {
  eval_diffuse(q, out, [](int, const Pair& p) { return bounded_schlick(angles(p).cos_d); });
}

/// Of directions mirrored by facets that are drawn by the coat's distribution.
inline float clearcoat_density(const Pair& p, float alpha) {
  const Vec3f h = normalize(p.wo + p.wi);
  const float z = dot(h, p.n), cos_d = abs_dot(p.wo, h);
  const float density = gtr1(z * z, z != 0 ? across2(h, p.n) : 1.0f, alpha);
  return p.zo * p.zi > 0 && cos_d > 0 ? density * std::abs(z) / (4 * cos_d) : 0.0f;
}

void eval_clearcoat(const LobeQuery& q, const LobeValues& out) {
  const float* const a = q.lobe.a;
  for_pairs(q, out, [&](int i, const Pair& p, const auto& add_density) {
    accumulate(out.f, i, q.lobe.weight, clearcoat(p, a[i]) * std::abs(p.zi) * p.reflects);
    add_density(clearcoat_density(p, a[i]));
  });
}

void draw_clearcoat(const LobeDraw& d) {
  draw_lanes(d, [a = d.lobe.a](int i, const Vec3f& wo, float u, float v) {
    const float a2 = a[i] * a[i];
    const float cos2 = clamp_to((1 - pow_of(a2, 1 - u)) / (1 - a2), 0.0f, 1.0f);
    const float sin = safe_sqrt(1 - cos2);
    const SinCos phi = sin_cos_2pi(v);
    return reflect_at(wo, Vec3f(sin * phi.cos, sin * phi.sin, safe_sqrt(cos2)) * side_of(wo.z));
  });
}

/// The reflectance of a facet goes from a dielectric's to a coloured Schlick approximation as `metallic` says.
void eval_reflection(const LobeQuery& q, const LobeValues& out) {
  const Lobe& lobe = q.lobe;
  const RGBLanes r0 = lobe.colour1;
  for_facets<Separable>(q, out, [&](int i, const Pair& p, const auto& d, const auto& add_density) {
    const float f = microfacet_reflection(d, p, FresnelType::One, 1.0f);
    const Vec3f h = normalize(p.wo + p.wi);
    const float cos_facet = dot(p.wi, h) * (dot(h, p.n) < 0 ? -1.0f : 1.0f);
    const float metallic = lobe.c[i], weight = bounded_schlick(cos_facet);
    const float dielectric = (1 - metallic) * fresnel_dielectric(cos_facet, lobe.eta[i]);
    const auto reflectance = [&](float r) { return dielectric + metallic * lerp(weight, r, 1); };
    out.f.r[i] += lobe.weight.r[i] * f * reflectance(r0.r[i]);
    out.f.g[i] += lobe.weight.g[i] * f * reflectance(r0.g[i]);
    out.f.b[i] += lobe.weight.b[i] * f * reflectance(r0.b[i]);
    add_density(reflection_density(d, p));
  });
}

void eval_transmission(const LobeQuery& q, const LobeValues& out) {
  const Lobe& lobe = q.lobe;
  for_facets<Separable>(q, out, [&](int i, const Pair& p, const auto& d, const auto& add_density) {
    accumulate(out.f, i, lobe.weight, microfacet_transmission(d, p, lobe.eta[i]));
    add_density(transmission_density(d, p, lobe.eta[i]));
  });
}

/// Retro-reflection and sheen are there at grazing angles only, and at half a rough surface's strength at most.
void scale_grazing(const Lobe& /*lobe*/, const ShadingBatch& s, float* to) {
  for_lanes(s.n, [&](int i) { to[i] *= 0.25f; });
}

void scale_clearcoat(const Lobe& /*lobe*/, const ShadingBatch& s, float* to) {
  for_lanes(s.n, [&](int i) {
    to[i] *= 0.25f * of_rough_boundary(lerp(bounded_schlick(abs_dot(s.wo[i], s.ns[i])), 0.04f, 1));
  });
}

void scale_reflection(const Lobe& lobe, const ShadingBatch& s, float* to) {
  const RGBLanes r0 = lobe.colour1;
  for_lanes(s.n, [&](int i) {
    const float z = dot(s.wo[i], s.ns[i]), metallic = lobe.c[i];
    const float metal = lerp(bounded_schlick(std::abs(z)), luminance({r0.r[i], r0.g[i], r0.b[i]}), 1);
    to[i] *= of_rough_boundary((1 - metallic) * fresnel_dielectric(z, lobe.eta[i]) + metallic * metal);
  });
}

}  // namespace

const LobeRow lobe_rows::DisneyDiffuse = {
    .name = "Disney diffuse",
    .effect = Effect::Diffuse,
    .reflects = true,
    .transmits = false,
    .eval = eval_base,
    .sample = draw_diffuse,
};

const LobeRow lobe_rows::DisneyFakeSubsurface = {
    .name = "Disney fake subsurface",
    .effect = Effect::Diffuse,
    .reflects = true,
    .transmits = false,
    .eval = eval_fake_subsurface,
    .sample = draw_diffuse,
};

const LobeRow lobe_rows::DisneyRetro = {
    .name = "Disney retro-reflection",
    .effect = Effect::Diffuse,
    .reflects = true,
    .transmits = false,
    .scale_strength = scale_grazing,
    .eval = eval_retro,
    .sample = draw_diffuse,
};

const LobeRow lobe_rows::DisneySheen = {
    .name = "Disney sheen",
    .effect = Effect::Diffuse,
    .reflects = true,
    .transmits = false,
    .scale_strength = scale_grazing,
    .eval = eval_sheen,
    .sample = draw_diffuse,
};

const LobeRow lobe_rows::DisneyClearcoat = {
    .name = "Disney clearcoat",
    .effect = Effect::Glossy,
    .reflects = true,
    .transmits = false,
    .scale_strength = scale_clearcoat,
    .eval = eval_clearcoat,
    .sample = draw_clearcoat,
};

const LobeRow lobe_rows::DisneyReflection = {
    .name = "Disney reflection",
    .effect = Effect::Glossy,
    .reflects = true,
    .transmits = false,
    .needs_frame = is_anisotropic,
    .scale_strength = scale_reflection,
    .eval = eval_reflection,
    .sample = draw_reflection,
};

const LobeRow lobe_rows::DisneyTransmission = {
    .name = "Disney transmission",
    .effect = Effect::Glossy,
    .reflects = false,
    .transmits = true,
    .needs_frame = is_anisotropic,
    .scale_strength = scale_rough_transmission,
    .eval = eval_transmission,
    .sample = draw_transmission,
};

}  // namespace whit
