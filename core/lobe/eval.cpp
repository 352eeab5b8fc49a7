#include "core/lobe/eval.h"

#include "core/lobe/disney.h"
#include "core/lobe/formulas.h"
#include "core/lobe/fourier.h"
#include "core/lobe/hair.h"
#include "core/lobe/microfacet.h"
#include "core/lobe/pair.h"

namespace whit {

namespace {

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

void add_lambert(const Lobe& lobe, const ShadingBatch& s, const Vec3Lanes& wi, const RGBLanes& out) {
  const bool transmits = lobe.type == LobeType::LambertTransmission;
  for_lanes(s.n, [&](int i) {
    const Pair p = make_pair(s, wi, i);
    accumulate(out, i, lobe.weight, kInvPi * std::abs(p.zi) * (transmits ? p.transmits : p.reflects));
  });
}

void add_oren_nayar(const Lobe& lobe, const ShadingBatch& s, const Vec3Lanes& wi, const RGBLanes& out) {
  for_lanes(s.n, [&](int i) {
    const Pair p = make_pair(s, wi, i);
    const float tangential = dot(p.wi - p.n * p.zi, p.wo - p.n * p.zo);
    const float f = oren_nayar(lobe.a[i], lobe.b[i], std::abs(p.zi), std::abs(p.zo), tangential);
    accumulate(out, i, lobe.weight, kInvPi * f * std::abs(p.zi) * p.reflects);
  });
}

/// Calls add(i, pair, distribution) for every lane, with the distribution the lobe has.
template <class Add>
void for_distribution(const Lobe& lobe, const ShadingBatch& s, const LobeFrame& frame, const Vec3Lanes& wi,
                      const Add& add) {
  if (lobe.a == lobe.b) {
    for_lanes(s.n, [&](int i) { add(i, make_pair(s, wi, i), Isotropic{lobe.a[i]}); });
  } else {
    for_lanes(s.n, [&](int i) {
      add(i, make_pair(s, wi, i), Anisotropic{lobe.a[i], lobe.b[i], frame.ss[i], frame.ts[i]});
    });
  }
}

void add_fresnel_blend(const Lobe& lobe, const ShadingBatch& s, const LobeFrame& frame, const Vec3Lanes& wi,
                       const RGBLanes& out) {
  const RGBLanes rd = lobe.colour1, rs = lobe.colour2;
  for_distribution(lobe, s, frame, wi, [&](int i, const Pair& p, const auto& d) {
    const Blend b = fresnel_blend(d, p);
    const auto add = [&](float* to, float weight, float diffuse, float coat) {
      to[i] += weight * (diffuse * (1 - coat) * b.diffuse + (coat + b.schlick * (1 - coat)) * b.coat);
    };
    add(out.r, lobe.weight.r[i], rd.r[i], rs.r[i]);
    add(out.g, lobe.weight.g[i], rd.g[i], rs.g[i]);
    add(out.b, lobe.weight.b[i], rd.b[i], rs.b[i]);
  });
}

/// Microfacets of a metal: the reflectance of a facet is coloured.
void add_metal(const Lobe& lobe, const ShadingBatch& s, const LobeFrame& frame, const Vec3Lanes& wi,
               const RGBLanes& out) {
  const RGBLanes eta = lobe.colour1, k = lobe.colour2;
  for_distribution(lobe, s, frame, wi, [&](int i, const Pair& p, const auto& d) {
    const float f = microfacet_reflection(d, p, FresnelType::One, 1.0f);
    const float c = dot(p.wi, normalize(p.wo + p.wi));
    out.r[i] += lobe.weight.r[i] * f * fresnel_conductor(c, eta.r[i], k.r[i]);
    out.g[i] += lobe.weight.g[i] * f * fresnel_conductor(c, eta.g[i], k.g[i]);
    out.b[i] += lobe.weight.b[i] * f * fresnel_conductor(c, eta.b[i], k.b[i]);
  });
}

void add_microfacet_reflection(const Lobe& lobe, const ShadingBatch& s, const LobeFrame& frame, const Vec3Lanes& wi,
                               const RGBLanes& out) {
  if (lobe.fresnel == FresnelType::Conductor) return add_metal(lobe, s, frame, wi, out);
  if (lobe.fresnel == FresnelType::One) {
    for_distribution(lobe, s, frame, wi, [&](int i, const Pair& p, const auto& d) {
      accumulate(out, i, lobe.weight, microfacet_reflection(d, p, FresnelType::One, 1.0f));
    });
  } else {
    for_distribution(lobe, s, frame, wi, [&](int i, const Pair& p, const auto& d) {
      accumulate(out, i, lobe.weight, microfacet_reflection(d, p, FresnelType::Dielectric, lobe.eta[i]));
    });
  }
}

void add_microfacet_transmission(const Lobe& lobe, const ShadingBatch& s, const LobeFrame& frame, const Vec3Lanes& wi,
                                 const RGBLanes& out) {
  for_distribution(lobe, s, frame, wi, [&](int i, const Pair& p, const auto& d) {
    accumulate(out, i, lobe.weight, microfacet_transmission(d, p, lobe.eta[i]));
  });
}

bool is_plastic(const LobeSet& set) {
  return set.count == 2 && set.lobes[0].type == LobeType::LambertReflection &&
         set.lobes[1].type == LobeType::MicrofacetReflection && set.lobes[1].fresnel == FresnelType::Dielectric &&
         set.lobes[1].a == set.lobes[1].b;
}

/// Lambert and an isotropic dielectric gloss in one pass: the commonest pair, and the batch is read once.
void eval_plastic(const LobeSet& set, const ShadingBatch& s, const Vec3Lanes& wi, const RGBLanes& out) {
  const Lobe &diffuse = set.lobes[0], &gloss = set.lobes[1];
  for_lanes(s.n, [&](int i) {
    const Pair p = make_pair(s, wi, i);
    const float d = kInvPi * std::abs(p.zi) * p.reflects;
    const float g = microfacet_reflection(Isotropic{gloss.a[i]}, p, FresnelType::Dielectric, gloss.eta[i]);
    out.r[i] = diffuse.weight.r[i] * d + gloss.weight.r[i] * g;
    out.g[i] = diffuse.weight.g[i] * d + gloss.weight.g[i] * g;
    out.b[i] = diffuse.weight.b[i] * d + gloss.weight.b[i] * g;
  });
}

}  // namespace

bool needs_frame(const LobeSet& set) {
  for (int k = 0; k < set.count; ++k) {
    const Lobe& lobe = set.lobes[k];
    const bool microfacet = lobe.type == LobeType::MicrofacetReflection ||
                            lobe.type == LobeType::MicrofacetTransmission || lobe.type == LobeType::FresnelBlend ||
                            lobe.type == LobeType::DisneyReflection || lobe.type == LobeType::DisneyTransmission;
    if ((microfacet && lobe.a != lobe.b) || lobe.type == LobeType::Hair) return true;
  }
  return false;
}

LobeFrame prepare_frame(const LobeSet& set, const ShadingBatch& s) {
  return needs_frame(set) ? make_frame(s) : LobeFrame{};
}

LobeFrame make_frame(const ShadingBatch& s) {
  const LobeFrame frame{s.arena->vec3(s.n), s.arena->vec3(s.n)};
  for_lanes(s.n, [&](int i) {
    const Vec3f n = s.ns[i];
    const Vec3f along = normalize_any(s.dpdu[i]);
    const float length2 = dot(along, along);
    const Frame any = coordinate_system(n);
    const bool usable = length2 > 0.5f;  // false also for NaN
    const Vec3f ss{usable ? along.x : any.s.x, usable ? along.y : any.s.y, usable ? along.z : any.s.z};
    frame.ss.set(i, ss);
    frame.ts.set(i, cross(n, ss));
  });
  return frame;
}

void eval_lobes(const LobeSet& set, const ShadingBatch& s, const LobeFrame& frame, const Vec3Lanes& wi,
                const RGBLanes& out) {
  if (is_plastic(set)) return eval_plastic(set, s, wi, out);
  for_lanes(s.n, [&](int i) { out.r[i] = out.g[i] = out.b[i] = 0; });
  for (int k = 0; k < set.count; ++k) {
    const Lobe& lobe = set.lobes[k];
    switch (lobe.type) {
      case LobeType::LambertReflection:
      case LobeType::LambertTransmission: add_lambert(lobe, s, wi, out); break;
      case LobeType::OrenNayar: add_oren_nayar(lobe, s, wi, out); break;
      case LobeType::MicrofacetReflection: add_microfacet_reflection(lobe, s, frame, wi, out); break;
      case LobeType::MicrofacetTransmission: add_microfacet_transmission(lobe, s, frame, wi, out); break;
      case LobeType::FresnelBlend: add_fresnel_blend(lobe, s, frame, wi, out); break;
      case LobeType::DisneyDiffuse:
      case LobeType::DisneyFakeSubsurface:
      case LobeType::DisneyRetro:
      case LobeType::DisneySheen:
      case LobeType::DisneyClearcoat:
      case LobeType::DisneyReflection:
      case LobeType::DisneyTransmission: add_disney(lobe, s, frame, wi, out); break;
      case LobeType::Hair: add_hair(lobe, s, frame, wi, out); break;
      case LobeType::Fourier: add_fourier(lobe, s, wi, out); break;
      case LobeType::SpecularReflection:
      case LobeType::SpecularTransmission: break;  // no pair of given directions meets a delta
    }
  }
}

int count_lobes(const LobeSet& set, LobeType type) {
  int count = 0;
  for (int k = 0; k < set.count; ++k) count += set.lobes[k].type == type;
  return count;
}

}  // namespace whit
