#include "core/batch/lobe_eval.h"

#include "core/batch/lobe_formulas.h"

namespace whit {

namespace {

/// One pair of directions at one point.
struct Pair {
  Vec3f wo, wi, n;
  float zo, zi;               ///< Cosines to the shading normal, signed.
  float reflects, transmits;  ///< 1 or 0: which lobes the geometric normal allows.
};

inline Pair make_pair(const ShadingBatch& s, const Vec3Lanes& wi_lanes, int i) {
  const Vec3f wo = s.wo[i], wi = wi_lanes[i], ng = s.ng[i], n = s.ns[i];
  const float zo = dot(wo, n), zi = dot(wi, n);
  const bool same_side = dot(wi, ng) * dot(wo, ng) > 0;
  const float on = zo != 0 ? 1.0f : 0.0f;
  return {wo, wi, n, zo, zi, same_side ? on : 0.0f, same_side ? 0.0f : on};
}

inline void accumulate(const RGBLanes& out, int i, const RGBLanes& weight, float f) {
  out.r[i] += weight.r[i] * f;
  out.g[i] += weight.g[i] * f;
  out.b[i] += weight.b[i] * f;
}

/// Squared length of the part of w across n, for unit vectors, without cancellation where w is near n.
inline float across2(const Vec3f& w, const Vec3f& n) {
  const Vec3f t = cross(w, n);
  return dot(t, t);
}

/// A Trowbridge-Reitz distribution with equal alphas: needs no tangents.
struct Isotropic {
  float alpha;
  float alpha_xy() const { return alpha * alpha; }
  float e(const Vec3f& h, float z, const Vec3f& n) const { return z * z + across2(h, n) / (alpha * alpha); }
  float smith(const Vec3f& /*w*/, float z) const {
    return smith_term(std::abs(z), alpha * alpha * max_of(1 - z * z, 0.0f));
  }
};

struct Anisotropic {
  float ax, ay;
  Vec3f ss, ts;
  float alpha_xy() const { return ax * ay; }
  float e(const Vec3f& h, float z, const Vec3f& /*n*/) const {
    const float x = dot(h, ss) / ax, y = dot(h, ts) / ay;
    return z * z + x * x + y * y;
  }
  float smith(const Vec3f& w, float z) const {
    const float x = dot(w, ss) * ax, y = dot(w, ts) * ay;
    return smith_term(std::abs(z), x * x + y * y);
  }
};

/// s_o c_i + s_i c_o, see smith_term(); never 0, so that a division by it is safe.
template <class Distribution>
inline float smith_sum(const Distribution& d, const Pair& p) {
  const float sum = d.smith(p.wo, p.zo) * std::abs(p.zi) + d.smith(p.wi, p.zi) * std::abs(p.zo);
  return sum > 0 ? sum : 1.0f;
}

/// Torrance-Sparrow reflection times |cos_i|, for weight 1. Torrance and Sparrow 1967; PBR book 8.4.4.
template <class Distribution>
inline float microfacet_reflection(const Distribution& d, const Pair& p, FresnelType fresnel, float eta) {
  const Vec3f h = normalize(p.wo + p.wi);
  const float z = dot(h, p.n);
  // The facet is seen from the side of the normal, so that the sign of its angle tells inside from outside.
  const float cos_facet = dot(p.wi, h) * (z < 0 ? -1.0f : 1.0f);
  const float f = fresnel == FresnelType::One ? 1.0f : fresnel_dielectric(cos_facet, eta);
  const float e = d.e(h, z, p.n);
  const float density = trowbridge_reitz(e > 0 ? e : 1.0f, d.alpha_xy());
  const float value = density * f * std::abs(p.zi) / (2 * smith_sum(d, p));
  return e > 0 && p.zi != 0 ? value * p.reflects : 0.0f;
}

/// Refraction by microfacets times |cos_i|, for weight 1, radiance. Walter et al. 2007, equation 21; their
/// eta^2 and radiance's 1 / eta^2 cancel, and the denominator is the squared length of the unnormalised half
/// vector.
template <class Distribution>
inline float microfacet_transmission(const Distribution& d, const Pair& p, float eta) {
  const float n = relative_index(p.zo, eta);
  const Vec3f sum = p.wo + p.wi * n;
  const float length2 = dot(sum, sum);
  const Vec3f half = normalize(sum);
  const float side = dot(half, p.n) < 0 ? -1.0f : 1.0f;
  const Vec3f h = half * side;
  const float oh = dot(p.wo, h), ih = dot(p.wi, h), z = dot(h, p.n);
  const float e = d.e(h, z, p.n);
  const float density = trowbridge_reitz(e > 0 ? e : 1.0f, d.alpha_xy());
  const float value = (1 - fresnel_dielectric(oh, eta)) * density * std::abs(oh * ih) * 2 * std::abs(p.zi) /
                      (smith_sum(d, p) * (length2 > 0 ? length2 : 1.0f));
  // Both cosines of a facet that refracts have different signs, and so have those of the surface. Facets seen
  // from behind are not excluded, as they are not in pbrt-v3: only very rough glass has any.
  return e > 0 && p.zo * p.zi < 0 && oh * ih <= 0 ? value * p.transmits : 0.0f;
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

void add_microfacet_reflection(const Lobe& lobe, const ShadingBatch& s, const LobeFrame& frame, const Vec3Lanes& wi,
                               const RGBLanes& out) {
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
    const bool microfacet =
        lobe.type == LobeType::MicrofacetReflection || lobe.type == LobeType::MicrofacetTransmission;
    if (microfacet && lobe.a != lobe.b) return true;
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
