// Reflection and refraction by Trowbridge-Reitz microfacets, over any distribution of facets: Isotropic, Anisotropic,
// or one with another masking term and so a smith_sum() of its own.
#pragma once

#include "core/lobe/formulas.h"
#include "core/lobe/lobe.h"
#include "core/lobe/pair.h"

namespace whit {

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
  const float below = smith_sum(d, p) * length2;  // 0 also where the product is too small for a float
  const float value =
      (1 - fresnel_dielectric(oh, eta)) * density * std::abs(oh * ih) * 2 * std::abs(p.zi) / (below > 0 ? below : 1.0f);
  // Both cosines of a facet that refracts have different signs, and so have those of the surface. Facets seen
  // from behind are not excluded, as they are not in pbrt-v3: only very rough glass has any.
  return e > 0 && p.zo * p.zi < 0 && oh * ih <= 0 ? value * p.transmits : 0.0f;
}

}  // namespace whit
