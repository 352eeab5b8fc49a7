// The scalar formulas of the lobes: branch-free, so that a loop over lanes vectorises.
//
// Sources: Pharr, Jakob, Humphreys, Physically Based Rendering, 3rd ed., chapter 8 (as pbrt-v3 has them);
// Walter, Marschner, Li, Torrance, Microfacet Models for Refraction, 2007; Heitz, Understanding the
// Masking-Shadowing Function, 2014. They are rearranged so that nothing cancels and nothing divides by a
// cosine that may be 0.
#pragma once

#include "core/base/fastmath.h"

namespace whit {

/// The index of the far side over that of the near side, for a direction whose cosine to the normal is
/// cos_near. `eta` is the index inside over the index outside; the normal points outside.
inline float relative_index(float cos_near, float eta) { return cos_near > 0 ? eta : 1 / eta; }

/// What Snell's law makes of a direction with cosine cos_i at a boundary of relative index n (far over near).
struct Refraction {
  float k;   ///< n^2 - 1
  float c;   ///< |cos_i|
  float g2;  ///< (n cos_t)^2; <= 0 for total internal reflection
  float g;   ///< n cos_t
};
inline Refraction snell(float cos_i, float n) {
  const float c = min_of(std::abs(cos_i), 1.0f);
  const float k = (n - 1) * (n + 1);  // exactly 0 at n = 1, unlike n * n - 1 at n = 1 + epsilon
  const float g2 = k + c * c;
  return {k, c, g2, safe_sqrt(g2)};
}

/// Unpolarised Fresnel reflectance in [0, 1] of a dielectric boundary, from the side cos_i (signed) says. An
/// index of 1 is invisible at every angle; total internal reflection gives 1. The usual quotients (c - g)/(c
/// + g) and (n^2 c - g)/(n^2 c + g), extended by their denominators, because c - g cancels.
inline float fresnel_dielectric(float cos_i, float eta) {
  const float n = relative_index(cos_i, eta);
  const Refraction r = snell(cos_i, n);
  const float n2 = n * n;
  const float a = r.c + r.g, b = n2 * r.c + r.g;
  const float perpendicular = r.k / (a * a);
  const float parallel = r.k * ((n2 + 1) * (r.c * r.c) - 1) / (b * b);
  const float f = 0.5f * (perpendicular * perpendicular + parallel * parallel);
  const float refracted = r.g2 > 0 ? min_of(f, 1.0f) : 1.0f;
  return eta == 1 ? 0.0f : refracted;
}

/// Unpolarised Fresnel reflectance in [0, 1] of the boundary to a metal of relative index eta + i k, the same from
/// both sides. With g = n cos_t = a + i b, a^2 - b^2 = eta^2 - k^2 - sin^2 and a b = eta k; the reflectances are
/// written as quotients of sums of squares, and the smaller of a and b comes from their product: nothing cancels.
inline float fresnel_conductor(float cos_i, float eta, float k) {
  const float c = min_of(std::abs(cos_i), 1.0f);
  const float s2 = (1 - c) * (1 + c);
  const float difference = (eta - 1) * (eta + 1) - k * k + c * c, product = std::abs(eta * k);
  const float modulus = std::sqrt(difference * difference + 4 * product * product);
  const float larger = std::sqrt(0.5f * (modulus + std::abs(difference)));
  const float smaller = larger > 0 ? product / larger : 0.0f;
  const float a = difference > 0 ? larger : smaller, b = difference > 0 ? smaller : larger;
  const float below = (a + c) * (a + c) + b * b;
  const float perpendicular = ((a - c) * (a - c) + b * b) / (below > 0 ? below : 1.0f);
  const float ca = c * a, cb = c * b;
  const float below_p = (ca + s2) * (ca + s2) + cb * cb;
  const float ratio = ((ca - s2) * (ca - s2) + cb * cb) / (below_p > 0 ? below_p : 1.0f);
  // Where both indices are 0 everything is reflected; so it is at the grazing angle, by the formula.
  return below > 0 && below_p > 0 ? 0.5f * perpendicular * (1 + ratio) : 1.0f;
}

/// (1 - x)^5, Schlick's angular dependence.
inline float schlick_weight(float x) {
  const float m = 1 - x, m2 = m * m;
  return m2 * m2 * m;
}

/// The cosine on the outer side of a boundary, where the index is smaller, of light that meets it at the cosine c from
/// the side that cos_near (signed) says; below 0 in total internal reflection. With an index of 1 it is c.
inline float outer_cosine(float c, float cos_near, float eta) {
  const float n = relative_index(cos_near, eta);
  const float c1 = min_of(c, 1.0f), s2 = (1 - c1) * (1 + c1);
  const float bent = 1 - s2 / (n * n), outer = bent > 0 ? safe_sqrt(bent) : -1.0f;
  return n < 1 ? outer : c1;
}

/// Schlick's reflectance at an outer_cosine(), from f0 at normal incidence to f90 at grazing incidence.
inline float schlick_reflectance(float outer_cosine, float f0, float f90) {
  const float f = lerp(schlick_weight(max_of(outer_cosine, 0.0f)), f0, f90);
  return outer_cosine < 0 ? 1.0f : f;
}

/// pbrt-v3's map from a user's roughness in [0, 1] to the Trowbridge-Reitz alpha (a fit by its authors).
inline float roughness_to_alpha(float roughness) {
  const float x = log_of(max_of(roughness, 1e-3f));
  return 1.62142f + x * (0.819955f + x * (0.1734f + x * (0.0171201f + x * 0.000640711f)));
}

/// pbrt-v3's smallest alpha.
inline constexpr float kMinAlpha = 1e-3f;

/// Trowbridge-Reitz density of facet normals, per steradian of projected area, from e = z^2 + (x/alpha_x)^2 +
/// (y/alpha_y)^2 of the half vector and the product of the alphas.
inline float trowbridge_reitz(float e, float alpha_xy) { return 1 / (kPi * alpha_xy * e * e); }

/// |cos| (1 + 2 Lambda): the masking term of one direction, from its cosine c and (x alpha_x)^2 + (y
/// alpha_y)^2. With it Smith's height-correlated G / (4 c_i c_o) is 1 / (2 (s_o c_i + s_i c_o)), finite at
/// grazing angles.
inline float smith_term(float c, float stretched2) { return std::sqrt(c * c + stretched2); }

/// Oren-Nayar's A and B for sigma in radians.
struct OrenNayarAB {
  float a, b;
};
inline OrenNayarAB oren_nayar_ab(float sigma) {
  const float s2 = sigma * sigma;
  return {1 - s2 / (2 * (s2 + 0.33f)), 0.45f * s2 / (s2 + 0.09f)};
}

/// Oren-Nayar's factor of weight / pi, from the absolute cosines and wi . wo of the tangential parts: its
/// max(0, cos dphi) sin(alpha) tan(beta) is max(0, tangential dot) / max(c_i, c_o), because alpha is the
/// larger angle.
inline float oren_nayar(float a, float b, float c_i, float c_o, float tangential) {
  const float c = max_of(c_i, c_o);
  return a + b * (max_of(tangential, 0.0f) / (c > 0 ? c : 1.0f));
}

}  // namespace whit
