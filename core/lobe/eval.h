// Evaluating and sampling the lobes of a run of points: what a material's surface does to light.
//
// Directions are unit vectors in render space that point away from the surface. pbrt-v3's rules hold: whether
// a pair of directions reflects or transmits is decided by the geometric normal, angles are measured from the
// shading normal, and radiance (not importance) is transported. A lane with ns . wo == 0 scatters nothing.
#pragma once

#include "core/batch/shading.h"
#include "core/lobe/lobe.h"

namespace whit {

/// The tangents of a run's points: with ns, an orthonormal basis. Null when no lobe needs them.
struct LobeFrame {
  Vec3Lanes ss, ts;  ///< Along dpdu (any direction when dpdu is 0), and cross(ns, ss).
};

/// True when evaluating a lobe needs tangents: anisotropic microfacets (`a` and `b` are different arrays).
bool needs_frame(const LobeSet& set);

/// Tangents for eval_lobes(), in s.arena; empty when needs_frame() says no.
LobeFrame prepare_frame(const LobeSet& set, const ShadingBatch& s);
/// Tangents in any case, which sampling needs.
LobeFrame make_frame(const ShadingBatch& s);

/// out = sum of the non-specular lobes f(wo, wi) times |wi . ns|, per steradian, for s.n directions wi.
void eval_lobes(const LobeSet& set, const ShadingBatch& s, const LobeFrame& frame, const Vec3Lanes& wi,
                const RGBLanes& out);

/// How many lobes of a type the set has: with one, choice_u below may be null.
int count_lobes(const LobeSet& set, LobeType type);

/// The mirror direction of each lane and its weight f |wi . ns| / pdf; black where the lane has no such lobe.
/// If several have weight, one is chosen uniformly by choice_u in [0, 1) and its weight multiplied by their
/// number, as pbrt does. Returns the number of lanes that are not black.
int specular_reflection(const LobeSet& set, const ShadingBatch& s, const float* choice_u, const Vec3Lanes& wi,
                        const RGBLanes& weight);

/// The same for the refracted direction. The weight holds 1 - F and the scaling of radiance (eta_near /
/// eta_far)^2; it is black in total internal reflection, where wi is -wo.
int specular_transmission(const LobeSet& set, const ShadingBatch& s, const float* choice_u, const Vec3Lanes& wi,
                          const RGBLanes& weight);

/// The density (solid angle) with which sample_lobes() chooses wi: the mean of the densities of the lane's
/// non-specular lobes; 0 where there are none.
void pdf_lobes(const LobeSet& set, const ShadingBatch& s, const LobeFrame& frame, const Vec3Lanes& wi, float* pdf);

/// Samples directions: one of the lane's non-specular lobes is chosen uniformly by lobe_u, its density
/// sampled with (u, v), all in [0, 1). f is eval_lobes() of wi (so the cosine is in it); pdf is pdf_lobes();
/// both are 0 where no direction came out (wi is then -wo). The frame comes from make_frame().
void sample_lobes(const LobeSet& set, const ShadingBatch& s, const LobeFrame& frame, const float* lobe_u,
                  const float* u, const float* v, const Vec3Lanes& wi, const RGBLanes& f, float* pdf);

}  // namespace whit
