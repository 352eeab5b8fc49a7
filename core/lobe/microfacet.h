// Reflection and refraction by Trowbridge-Reitz microfacets, over any distribution of facets: Isotropic, Anisotropic,
// or one with another masking term and so a smith_sum() of its own. Their values, and directions by the visible facets.
#pragma once

#include "core/lobe/draw.h"
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
/// vector. through(oh, ih) is what a facet lets through at its cosines to wo and wi.
template <class Distribution, class Through>
inline float microfacet_transmission(const Distribution& d, const Pair& p, float eta, const Through& through) {
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
  const float value = through(oh, ih) * density * std::abs(oh * ih) * 2 * std::abs(p.zi) / (below > 0 ? below : 1.0f);
  // Both cosines of a facet that refracts have different signs, and so have those of the surface. Facets seen
  // from behind are not excluded, as they are not in pbrt-v3: only very rough glass has any.
  return e > 0 && p.zo * p.zi < 0 && oh * ih <= 0 ? value * p.transmits : 0.0f;
}

/// The same by Fresnel's equations.
template <class Distribution>
inline float microfacet_transmission(const Distribution& d, const Pair& p, float eta) {
  return microfacet_transmission(d, p, eta, [eta](float oh, float) { return 1 - fresnel_dielectric(oh, eta); });
}

/// Smith's masking of wo by the facets, G1, over |cos|; see smith_term().
template <class Distribution>
inline float masking_over_cosine(const Distribution& d, const Pair& p) {
  const float sum = std::abs(p.zo) + d.smith(p.wo, p.zo);
  return 2 / (sum > 0 ? sum : 1.0f);
}

/// The density of directions reflected by visible facets: their own, G1 D |wo . h| / |cos|, over 4 |wo . h|. Heitz
/// 2014. D is that of microfacet_reflection(), from the same half vector: it cancels in their quotient, rounding and
/// all.
template <class Distribution>
inline float reflection_density(const Distribution& d, const Pair& p) {
  const Vec3f h = normalize(p.wo + p.wi);
  const float e = d.e(h, dot(h, p.n), p.n);
  const float density = trowbridge_reitz(e > 0 ? e : 1.0f, d.alpha_xy());
  return p.zo * p.zi > 0 ? density * masking_over_cosine(d, p) * 0.25f : 0.0f;
}

/// The density of directions refracted by visible facets. Walter et al. 2007, equation 17.
template <class Distribution>
inline float transmission_density(const Distribution& d, const Pair& p, float eta) {
  const float n = relative_index(p.zo, eta);
  const Vec3f sum = p.wo + p.wi * n;
  const float length2 = dot(sum, sum);
  const Vec3f half = normalize(sum);
  const float side = dot(half, p.n) < 0 ? -1.0f : 1.0f;
  const Vec3f h = half * side;
  const float oh = dot(p.wo, h), ih = dot(p.wi, h), z = dot(h, p.n);
  const float e = d.e(h, z, p.n);
  const float density = trowbridge_reitz(e > 0 ? e : 1.0f, d.alpha_xy());
  const float value = density * std::abs(oh * ih) * masking_over_cosine(d, p) * n * n / (length2 > 0 ? length2 : 1.0f);
  // Facets seen from behind are not visible, hence never sampled.
  return length2 > 0 && p.zo * p.zi < 0 && oh * ih <= 0 && oh * z * p.zo > 0 ? value : 0.0f;
}

/// True when tangents are needed: the alphas are different arrays.
inline bool is_anisotropic(const Lobe& lobe) { return lobe.a != lobe.b; }

/// Calls add(i, pair, distribution, add_density) for every lane, with the distribution the lobe has, made into a Kind.
template <template <class> class Kind, class Add>
void for_facets(const LobeQuery& q, const LobeValues& out, const Add& add) {
  const Lobe& lobe = q.lobe;
  if (is_anisotropic(lobe)) {
    for_pairs(q, out, [&](int i, const Pair& p, const auto& add_density) {
      add(i, p, Kind<Anisotropic>{{lobe.a[i], lobe.b[i], q.frame.ss[i], q.frame.ts[i]}}, add_density);
    });
  } else {
    for_pairs(q, out, [&](int i, const Pair& p, const auto& add_density) {
      add(i, p, Kind<Isotropic>{{lobe.a[i]}}, add_density);
    });
  }
}

/// A facet's normal on wo's side, by the density of those that wo sees. Dupuy and Benyoub, Sampling Visible GGX Normals
/// with Spherical Caps, 2023.
inline Vec3f sample_visible_normal(const Vec3f& wo, float ax, float ay, float u, float v) {
  const float side = side_of(wo.z);
  const Vec3f o = normalize({ax * wo.x * side, ay * wo.y * side, wo.z * side});
  // A point of the unit sphere's part above -o.z; with o it makes the facet of a sphere that mirrors o there. Its
  // height above -o.z is exact.
  const float above = (1 - u) * (1 + o.z), z = above - o.z;
  const float r = safe_sqrt((1 - z) * (1 + z));
  const SinCos phi = sin_cos_2pi(v);
  const Vec3f h(r * phi.cos + o.x, r * phi.sin + o.y, above);
  return normalize({ax * h.x * side, ay * h.y * side, h.z * side});
}

/// wo mirrored by a facet; the zero vector if that is below the surface.
inline Vec3f reflect_at(const Vec3f& wo, const Vec3f& h) {
  const Vec3f wi = h * (2 * dot(wo, h)) - wo;
  return wi * (wi.z * wo.z > 0 ? 1.0f : 0.0f);
}

/// wo refracted by a facet on its side; the zero vector in total internal reflection, and if it stays above the
/// surface.
inline Vec3f refract_at(const Vec3f& wo, const Vec3f& h, float n) {
  const float c = dot(wo, h);
  const Refraction r = snell(c, n);
  const float sum = r.c + r.g;
  const Vec3f wi = (h * (-r.k / (sum > 0 ? sum : 1.0f)) - wo) * (1 / n);
  return wi * (r.g2 > 0 && c > 0 && wi.z * wo.z < 0 ? 1.0f : 0.0f);
}

/// Draw directions reflected, and refracted, by visible facets.
void draw_reflection(const LobeDraw& draw);
void draw_transmission(const LobeDraw& draw);

/// LobeRow::scale_strength of rough refraction.
void scale_rough_transmission(const Lobe& lobe, const ShadingBatch& s, float* to);

/// The part of the light that rough boundaries reflect, or let through, is about that of a smooth one; some facets have
/// other angles.
inline float of_rough_boundary(float fresnel) { return max_of(fresnel, 0.1f); }

}  // namespace whit
