// A diffuse body under facets that reflect some of the light before it gets in, and again before it gets out.
#include "core/lobe/albedo_table.h"
#include "core/lobe/draw.h"
#include "core/lobe/pair.h"

namespace whit {

namespace {

/// Kelemen and Szirmay-Kalos, A Microfacet Based Coupled Specular-Matte BRDF Model with Importance Sampling, 2001: (1 -
/// E(wo)) (1 - E(wi)) / ((1 - Emean) pi), of which the weight has all but what depends on wi.
void eval(const LobeQuery& q, const LobeValues& out) {
  const float *const position = q.lobe.a, *const f0 = q.lobe.c, *const f90 = q.lobe.d;
  const FacetAlbedo& albedo = facet_albedo();
  for_pairs(q, out, [&](int i, const Pair& p, const auto& add_density) {
    const float z = std::abs(p.zi);
    const float enters = max_of(1 - albedo(z, position[i], f0[i], f90[i]), 0.0f);
    accumulate(out.f, i, q.lobe.weight, kInvPi * enters * z * reflects_in_front(q, p, i));
    add_density(diffuse_density(p));
  });
}

}  // namespace

const LobeRow lobe_rows::CoupledDiffuse = {
    .name = "coupled diffuse",
    .effect = Effect::Diffuse,
    .reflects = true,
    .transmits = false,
    .eval = eval,
    .sample = draw_diffuse,
};

}  // namespace whit
