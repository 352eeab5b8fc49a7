// Rough boundaries of dielectrics and metals.
#include "core/lobe/microfacet.h"

namespace whit {

namespace {

/// A distribution as it is.
template <class Distribution>
struct Plain : Distribution {};

/// Microfacets of a metal: the reflectance of a facet is coloured.
void eval_metal(const LobeQuery& q, const LobeValues& out) {
  const RGBLanes eta = q.lobe.colour1, k = q.lobe.colour2, weight = q.lobe.weight, to = out.f;
  for_facets<Plain>(q, out, [&](int i, const Pair& p, const auto& d, const auto& add_density) {
    const float f = microfacet_reflection(d, p, FresnelType::One, 1.0f);
    const float c = dot(p.wi, normalize(p.wo + p.wi));
    to.r[i] += weight.r[i] * f * fresnel_conductor(c, eta.r[i], k.r[i]);
    to.g[i] += weight.g[i] * f * fresnel_conductor(c, eta.g[i], k.g[i]);
    to.b[i] += weight.b[i] * f * fresnel_conductor(c, eta.b[i], k.b[i]);
    add_density(reflection_density(d, p));
  });
}

void eval_reflection(const LobeQuery& q, const LobeValues& out) {
  const Lobe& lobe = q.lobe;
  if (lobe.fresnel == FresnelType::Conductor) return eval_metal(q, out);
  if (lobe.fresnel == FresnelType::One) {
    for_facets<Plain>(q, out, [&](int i, const Pair& p, const auto& d, const auto& add_density) {
      accumulate(out.f, i, lobe.weight, microfacet_reflection(d, p, FresnelType::One, 1.0f));
      add_density(reflection_density(d, p));
    });
  } else {
    for_facets<Plain>(q, out, [&](int i, const Pair& p, const auto& d, const auto& add_density) {
      accumulate(out.f, i, lobe.weight, microfacet_reflection(d, p, FresnelType::Dielectric, lobe.eta[i]));
      add_density(reflection_density(d, p));
    });
  }
}

void eval_transmission(const LobeQuery& q, const LobeValues& out) {
  const Lobe& lobe = q.lobe;
  for_facets<Plain>(q, out, [&](int i, const Pair& p, const auto& d, const auto& add_density) {
    accumulate(out.f, i, lobe.weight, microfacet_transmission(d, p, lobe.eta[i]));
    add_density(transmission_density(d, p, lobe.eta[i]));
  });
}

void scale_reflection(const Lobe& lobe, const ShadingBatch& s, float* to) {
  if (lobe.fresnel != FresnelType::Dielectric) return;
  for_lanes(s.n, [&](int i) { to[i] *= of_rough_boundary(fresnel_dielectric(dot(s.wo[i], s.ns[i]), lobe.eta[i])); });
}

}  // namespace

void draw_reflection(const LobeDraw& d) {
  const float *const a = d.lobe.a, *const b = d.lobe.b;
  draw_lanes(d, [a, b](int i, const Vec3f& wo, float u, float v) {
    return reflect_at(wo, sample_visible_normal(wo, a[i], b[i], u, v));
  });
}

void draw_transmission(const LobeDraw& d) {
  const float *const a = d.lobe.a, *const b = d.lobe.b, *const eta = d.lobe.eta;
  draw_lanes(d, [a, b, eta](int i, const Vec3f& wo, float u, float v) {
    return refract_at(wo, sample_visible_normal(wo, a[i], b[i], u, v), relative_index(wo.z, eta[i]));
  });
}

void scale_rough_transmission(const Lobe& lobe, const ShadingBatch& s, float* to) {
  for_lanes(s.n,
            [&](int i) { to[i] *= of_rough_boundary(1 - fresnel_dielectric(dot(s.wo[i], s.ns[i]), lobe.eta[i])); });
}

const LobeRow lobe_rows::MicrofacetReflection = {
    .name = "microfacet reflection",
    .effect = Effect::Glossy,
    .reflects = true,
    .transmits = false,
    .needs_frame = is_anisotropic,
    .scale_strength = scale_reflection,
    .eval = eval_reflection,
    .sample = draw_reflection,
};

const LobeRow lobe_rows::MicrofacetTransmission = {
    .name = "microfacet transmission",
    .effect = Effect::Glossy,
    .reflects = false,
    .transmits = true,
    .needs_frame = is_anisotropic,
    .scale_strength = scale_rough_transmission,
    .eval = eval_transmission,
    .sample = draw_transmission,
};

}  // namespace whit
