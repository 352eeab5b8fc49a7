#include "core/lobe/eval.h"

#include "core/lobe/microfacet.h"
#include "core/lobe/pair.h"
#include "core/lobe/shares.h"
#include "core/lobe/table.h"

namespace whit {

namespace {

bool is_plastic(const LobeSet& set) {
  return set.count == 2 && set.lobes[0].type == LobeType::LambertReflection &&
         set.lobes[1].type == LobeType::MicrofacetReflection && set.lobes[1].fresnel == FresnelType::Dielectric &&
         set.lobes[1].a == set.lobes[1].b;
}

/// Lambert and an isotropic dielectric gloss in one pass: the commonest pair, and the batch is read once.
template <class Density>
void eval_plastic(const LobeSet& set, const ShadingBatch& s, const Vec3Lanes& wi, const RGBLanes& out,
                  const Density& set_density) {
  const Lobe &diffuse = set.lobes[0], &gloss = set.lobes[1];
  for_lanes(s.n, [&](int i) {
    const Pair p = make_pair(s, wi, i);
    const Isotropic facets{gloss.a[i]};
    const float d = kInvPi * std::abs(p.zi) * p.reflects;
    const float g = microfacet_reflection(facets, p, FresnelType::Dielectric, gloss.eta[i]);
    out.r[i] = diffuse.weight.r[i] * d + gloss.weight.r[i] * g;
    out.g[i] = diffuse.weight.g[i] * d + gloss.weight.g[i] * g;
    out.b[i] = diffuse.weight.b[i] * d + gloss.weight.b[i] * g;
    set_density(i, p, facets);
  });
}

/// Adds up the lobes; shares are asked for where there is a pdf.
template <class ShareOf>
void eval_each(const LobeSet& set, const ShadingBatch& s, const LobeFrame& frame, const Vec3Lanes& wi,
               const RGBLanes& f, float* pdf, const ShareOf& share_of) {
  for_lanes(s.n, [&](int i) { f.r[i] = f.g[i] = f.b[i] = 0; });
  if (pdf) for_lanes(s.n, [&](int i) { pdf[i] = 0; });
  for (int k = 0; k < set.count; ++k) {
    const LobeRow& row = row_of(set.lobes[k].type);
    if (!row.specular) row.eval({set.lobes[k], s, frame, wi}, {f, share_of(k), pdf});
  }
}

}  // namespace

bool needs_frame(const LobeSet& set) {
  for (int k = 0; k < set.count; ++k) {
    const auto lobe_needs_frame = row_of(set.lobes[k].type).needs_frame;
    if (lobe_needs_frame && lobe_needs_frame(set.lobes[k])) return true;
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

void eval_with_shares(const LobeSet& set, const ShadingBatch& s, const LobeFrame& frame, const Vec3Lanes& wi,
                      const LobeShares& shares, const RGBLanes& f, float* pdf) {
  if (!is_plastic(set)) return eval_each(set, s, frame, wi, f, pdf, [&](int k) { return shares.of[k]; });
  const float *const diffuse = shares.of[0], *const gloss = shares.of[1];
  eval_plastic(set, s, wi, f, [=](int i, const Pair& p, const Isotropic& facets) {
    pdf[i] = diffuse[i] * diffuse_density(p) + gloss[i] * reflection_density(facets, p);
  });
}

void eval_lobes(const LobeSet& set, const ShadingBatch& s, const LobeFrame& frame, const Vec3Lanes& wi,
                const RGBLanes& f, float* pdf, LobeKinds kinds) {
  if (pdf) {
    const ArenaScope scratch(*s.arena);
    return eval_with_shares(set, s, frame, wi, lobe_shares(set, s, kinds), f, pdf);
  }
  if (is_plastic(set)) return eval_plastic(set, s, wi, f, [](int, const Pair&, const Isotropic&) {});
  eval_each(set, s, frame, wi, f, nullptr, [](int) { return nullptr; });
}

int count_lobes(const LobeSet& set, LobeType type) {
  int count = 0;
  for (int k = 0; k < set.count; ++k) count += set.lobes[k].type == type;
  return count;
}

}  // namespace whit
