// Evaluating and sampling the lobes of a run of points: what a material's surface does to light.
//
// Directions are unit vectors in render space that point away from the surface. pbrt-v3's rules hold: whether
// a pair of directions reflects or transmits is decided by the geometric normal, angles are measured from the
// shading normal, and radiance (not importance) is transported. A lane with ns . wo == 0 scatters nothing.
#pragma once

#include "core/batch/shading.h"
#include "core/lobe/lobe.h"

namespace whit {

/// True when evaluating a lobe needs tangents: hair, and microfacets whose `a` and `b` are different arrays.
bool needs_frame(const LobeSet& set);

/// Tangents for eval_lobes() and sample_lobes(), in s.arena; empty when needs_frame() says no.
LobeFrame prepare_frame(const LobeSet& set, const ShadingBatch& s);
/// Tangents in any case.
LobeFrame make_frame(const ShadingBatch& s);

/// Which lobes a direction is sampled from.
enum class LobeKinds : uint8_t { All, NonSpecular, Specular };

/// out f = sum of the non-specular lobes f(wo, wi) |wi . ns|, per steradian, for s.n directions wi. If `pdf` is not
/// null: the density (solid angle) with which sample_lobes() of the same kinds, never Specular, chooses wi (with All: including the
/// probability that no specular lobe was chosen instead).
void eval_lobes(const LobeSet& set, const ShadingBatch& s, const LobeFrame& frame, const Vec3Lanes& wi,
                const RGBLanes& f, float* pdf = nullptr, LobeKinds kinds = LobeKinds::NonSpecular);

/// What sample_lobes() fills.
struct LobeSamples {
  Vec3Lanes wi;     ///< Unit vectors; -wo where nothing came out.
  RGBLanes weight;  ///< f |cos| / pdf, all lobes at wi summed for a non-specular choice; black where nothing came out.
  float* pdf;       ///< Solid angle; infinite where a specular lobe was chosen; 0 where nothing came out.
  /// Null unless asked for: the factor on pbrt-v3's etaScale. For a refracted specular ray eta^2 entering (wo on the
  /// outside) or 1 / eta^2 leaving; 1 otherwise.
  float* eta2 = nullptr;
};

/// Samples directions: one of the lane's lobes of these kinds is chosen by lobe_u, its density sampled with (u, v), all
/// in [0, 1). A lobe is chosen in proportion to the light it scatters, about: the luminance of its weight times, if it
/// is the boundary of a dielectric, Fresnel's factor at wo. That factor is exact for specular lobes, so that smooth
/// glass reflects as often as it reflects light, and at least 1/10 for rough ones, whose facets have other angles.
void sample_lobes(const LobeSet& set, const ShadingBatch& s, const LobeFrame& frame, const float* lobe_u,
                  const float* u, const float* v, LobeKinds kinds, const LobeSamples& out);

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

}  // namespace whit
