// The lobes of Disney's BSDF: its diffuse family, its clear coat, and microfacets with its own masking and Fresnel
// terms. Burley, Physically Based Shading at Disney, 2012, and Extending the Disney BRDF to a BSDF with Integrated
// Subsurface Scattering, 2015, as pbrt-v3 has them.
#pragma once

#include "core/lobe/eval.h"

namespace whit {

/// Adds to `out` a lobe of one of the Disney types, times |wi . ns|, as eval_lobes() does.
void add_disney(const Lobe& lobe, const ShadingBatch& s, const LobeFrame& frame, const Vec3Lanes& wi,
                const RGBLanes& out);

/// The density with which sample_clearcoat() finds wi; both in the local frame.
float clearcoat_pdf(float alpha, const Vec3f& wo, const Vec3f& wi);
/// The zero vector when no direction comes out.
Vec3f sample_clearcoat(float alpha, const Vec3f& wo, float u, float v);

}  // namespace whit
