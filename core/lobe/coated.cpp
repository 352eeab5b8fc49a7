// A diffuse surface under a glossy coat.
#include "core/lobe/microfacet.h"

namespace whit {

namespace {

template <class Distribution>
struct Coat : Distribution {};

/// The angle-dependent factors of Ashikhmin and Shirley's blend, times |cos_i|: of Rd (1 - Rs), of the coat, and how
/// far the coat's Rs has risen to 1 at the facet.
struct Blend {
  float diffuse, coat, schlick;
};

/// Ashikhmin and Shirley, An Anisotropic Phong BRDF Model, 2000, with a Trowbridge-Reitz distribution as pbrt-v3 has
/// it; PBR book 8.5. Their max(cos_i, cos_o) takes the place of a masking term.
template <class Distribution>
inline Blend fresnel_blend(const Distribution& d, const Pair& p) {
  const float ci = std::abs(p.zi), co = std::abs(p.zo);
  const float diffuse = 28 / (23 * kPi) * (1 - schlick_weight(0.5f * ci)) * (1 - schlick_weight(0.5f * co));
  const Vec3f h = normalize(p.wo + p.wi);
  // Opposite grazing directions have a coat without bound; the cosine is not known better than 1e-7 anyway.
  const float ih = clamp_to(dot(p.wi, h), 1e-7f, 1.0f);
  const float e = d.e(h, dot(h, p.n), p.n);
  const float density = trowbridge_reitz(e > 0 ? e : 1.0f, d.alpha_xy());
  const float larger = max_of(ci, co);
  const float coat = e > 0 && larger > 0 ? density * (ci / larger) / (4 * ih) : 0.0f;
  return {diffuse * ci * p.reflects, coat * p.reflects, schlick_weight(ih)};
}

/// Half of the samples are the diffuse part's, half the coat's.
template <class Distribution>
inline float blend_density(const Distribution& d, const Pair& p) {
  return 0.5f * (diffuse_density(p) + reflection_density(d, p));
}

void eval_blend(const LobeQuery& q, const LobeValues& out) {
  const Lobe& lobe = q.lobe;
  const RGBLanes rd = lobe.colour1, rs = lobe.colour2;
  for_facets<Coat>(q, out, [&](int i, const Pair& p, const auto& d, const auto& add_density) {
    const Blend b = fresnel_blend(d, p);
    const auto add = [&](float* to, float weight, float diffuse, float coat) {
      to[i] += weight * (diffuse * (1 - coat) * b.diffuse + (coat + b.schlick * (1 - coat)) * b.coat);
    };
    add(out.f.r, lobe.weight.r[i], rd.r[i], rs.r[i]);
    add(out.f.g, lobe.weight.g[i], rd.g[i], rs.g[i]);
    add(out.f.b, lobe.weight.b[i], rd.b[i], rs.b[i]);
    add_density(blend_density(d, p));
  });
}

void draw_blend(const LobeDraw& d) {
  const float *const a = d.lobe.a, *const b = d.lobe.b;
  draw_lanes(d, [a, b](int i, const Vec3f& wo, float u, float v) {
    // Each half of u is stretched to a whole.
    const bool below = u < 0.5f;
    const float whole = below ? 2 * u : 2 * u - 1;
    const Vec3f diffuse = cosine_hemisphere(whole, v);
    const Vec3f coat = reflect_at(wo, sample_visible_normal(wo, a[i], b[i], whole, v));
    return Vec3f(below ? diffuse.x : coat.x, below ? diffuse.y : coat.y, below ? diffuse.z * side_of(wo.z) : coat.z);
  });
}

void scale_blend(const Lobe& lobe, const ShadingBatch& s, float* to) {
  const RGBLanes rd = lobe.colour1, rs = lobe.colour2;
  for_lanes(s.n, [&](int i) {
    const float diffuse = luminance({rd.r[i], rd.g[i], rd.b[i]}), coat = luminance({rs.r[i], rs.g[i], rs.b[i]});
    const float risen = lerp(schlick_weight(min_of(abs_dot(s.wo[i], s.ns[i]), 1.0f)), coat, 1);
    to[i] *= max_of(diffuse * (1 - coat), 0.0f) + of_rough_boundary(risen);
  });
}

}  // namespace

const LobeRow lobe_rows::FresnelBlend = {
    .name = "Fresnel blend",
    .effect = Effect::Glossy,
    .reflects = true,
    .transmits = false,
    .needs_frame = is_anisotropic,
    .scale_strength = scale_blend,
    .eval = eval_blend,
    .sample = draw_blend,
};

}  // namespace whit
