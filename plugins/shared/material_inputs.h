// What materials make of their parameters before it goes into lobes.
#pragma once

#include "core/plugin/material.h"

namespace whit {

/// An array of s.n times the same number.
float* filled(const ShadingBatch& s, float value);

/// The Trowbridge-Reitz alphas of a roughness, at least pbrt-v3's 0.001; `remap` applies pbrt's
/// roughness_to_alpha().
float* alphas(const Tex<float>& roughness, bool remap, const ShadingBatch& s);

/// Sets a lobe's alphas from the roughness along u and v. Where both are the same they are one array, which makes the
/// lobe isotropic and cheaper.
void set_alphas(Lobe& lobe, const Tex<float>& u, const Tex<float>& v, bool remap, const ShadingBatch& s);

/// Relative indices of refraction, kept within [0.001, 1000]: a texture may give anything, and no index is 0.
float* indices(const Tex<float>& index, const ShadingBatch& s);

/// Reflectances or transmittances, clamped from below.
inline RGBLanes weights(const Tex<RGB>& colour, const ShadingBatch& s) { return clamp0(s.n, colour(s)); }

/// a * b, in new arrays.
RGBLanes product(const ShadingBatch& s, const RGBLanes& a, const RGBLanes& b);
/// 1 - share, at least 0, in new arrays.
RGBLanes one_minus(const ShadingBatch& s, const RGBLanes& share);

/// What is not solid lets rays on undeflected. Where there is any of it, pbrt-v3 takes the surface's index for ray
/// differentials, `eta` (null: 1), as 1.
void add_passage(const ShadingBatch& s, const RGBLanes& solid, const float* eta, LobeSet& out);

inline bool is_black(const Tex<RGB>& colour) {
  const RGB v = colour.value();
  return colour.is_constant() && v.x <= 0 && v.y <= 0 && v.z <= 0;
}

}  // namespace whit
