// Mirror and refraction: the delta lobes.
#include "core/lobe/eval.h"
#include "core/lobe/formulas.h"
#include "core/lobe/table.h"

namespace whit {

namespace {

inline bool has_weight(const Lobe& lobe, int i) {
  return (lobe.weight.r[i] != 0) | (lobe.weight.g[i] != 0) | (lobe.weight.b[i] != 0);
}

/// For each lane, which lobe of a type is taken, and how many have weight.
struct Chosen {
  int32_t* lobe = nullptr;  ///< Index into the set; null when the set has only one of the type, `only`.
  float* count = nullptr;
  int only = -1;
};

/// Chooses uniformly among the lobes of `type` that have weight.
Chosen choose(const LobeSet& set, LobeType type, const ShadingBatch& s, const float* choice_u) {
  Chosen chosen;
  for (int k = 0; k < set.count; ++k)
    if (set.lobes[k].type == type) chosen.only = k;
  if (count_lobes(set, type) < 2) return chosen;

  chosen.lobe = s.arena->alloc<int32_t>(s.n);
  chosen.count = s.arena->floats(s.n);
  for_lanes(s.n, [&](int i) { chosen.count[i] = 0, chosen.lobe[i] = -1; });
  for (int k = 0; k < set.count; ++k) {
    const Lobe& lobe = set.lobes[k];
    if (lobe.type == type) for_lanes(s.n, [&](int i) { chosen.count[i] += has_weight(lobe, i) ? 1.0f : 0.0f; });
  }
  // The lobe whose turn it is when `seen` of the candidates have passed.
  float* const seen = s.arena->floats(s.n);
  for_lanes(s.n, [&](int i) { seen[i] = 0; });
  for (int k = 0; k < set.count; ++k) {
    const Lobe& lobe = set.lobes[k];
    if (lobe.type != type) continue;
    for_lanes(s.n, [&](int i) {
      const float wanted = min_of(std::floor(choice_u[i] * chosen.count[i]), chosen.count[i] - 1);
      const bool candidate = has_weight(lobe, i);
      chosen.lobe[i] = candidate && seen[i] == wanted ? k : chosen.lobe[i];
      seen[i] += candidate ? 1.0f : 0.0f;
    });
  }
  return chosen;
}

void clear(int n, const ShadingBatch& s, const Vec3Lanes& wi, const RGBLanes& weight) {
  for_lanes(n, [&](int i) {
    wi.x[i] = -s.wo.x[i], wi.y[i] = -s.wo.y[i], wi.z[i] = -s.wo.z[i];
    weight.r[i] = weight.g[i] = weight.b[i] = 0;
  });
}

int count_lit(int n, const RGBLanes& weight) {
  int lit = 0;
  for (int i = 0; i < n; ++i) lit += (weight.r[i] != 0) | (weight.g[i] != 0) | (weight.b[i] != 0);
  return lit;
}

/// A direction and the factor of the lobe's weight.
struct Delta {
  Vec3f wi;
  float f;
};

inline Delta reflect(const Vec3f& wo, const Vec3f& n, FresnelType fresnel, float eta) {
  const float z = dot(wo, n);
  const Vec3f wi = normalize(n * (2 * z) - wo);
  const float f = fresnel == FresnelType::One ? 1.0f : fresnel_dielectric(z, eta);
  return {wi, z != 0 ? f : 0.0f};
}

/// Snell's law in vector form. The coefficient of the normal, (cos_o - n cos_t) / n, is written without the
/// difference, so that a ray passes an index of 1 undeflected.
inline Delta refract(const Vec3f& wo, const Vec3f& normal, FresnelType fresnel, float eta) {
  const float z = dot(wo, normal);
  const float n = relative_index(z, eta);
  const Refraction r = snell(z, n);
  const float sum = r.c + r.g;
  const float along = (z < 0 ? 1.0f : -1.0f) * r.k / (sum > 0 ? sum : 1.0f);
  const Vec3f bent = normalize(normal * along - wo);
  const bool straight = eta == 1 || r.g2 <= 0;
  const Vec3f wi{straight ? -wo.x : bent.x, straight ? -wo.y : bent.y, straight ? -wo.z : bent.z};
  const float f = (fresnel == FresnelType::One ? 1.0f : 1 - fresnel_dielectric(z, eta)) / (n * n);
  // An index of 1 is no boundary, also where the square of the cosine is too small for a float.
  return {wi, eta == 1 || (z != 0 && r.g2 > 0) ? f : 0.0f};
}

/// Writes direction and weight of lobe k where it was chosen; delta(i) gives them for weight 1.
template <class DeltaOf>
void take_lobe(const LobeSet& set, int k, const Chosen& chosen, const ShadingBatch& s, const Vec3Lanes& wi,
               const RGBLanes& weight, const DeltaOf& delta) {
  const RGBLanes& w = set.lobes[k].weight;
  if (!chosen.lobe) {
    for_lanes(s.n, [&](int i) {
      const Delta d = delta(i);
      wi.set(i, d.wi);
      weight.r[i] = w.r[i] * d.f, weight.g[i] = w.g[i] * d.f, weight.b[i] = w.b[i] * d.f;
    });
    return;
  }
  for_lanes(s.n, [&](int i) {
    const Delta d = delta(i);
    // Loaded before they are chosen from, or the compiler makes branches of the choices.
    const float count = chosen.count[i];
    const Vec3f before = wi[i];
    const bool mine = chosen.lobe[i] == k;
    const float f = mine ? d.f * count : 0.0f;
    wi.set(i, {mine ? d.wi.x : before.x, mine ? d.wi.y : before.y, mine ? d.wi.z : before.z});
    weight.r[i] += w.r[i] * f, weight.g[i] += w.g[i] * f, weight.b[i] += w.b[i] * f;
  });
}

/// Runs take(k, chosen) for the lobes of a type and counts the lanes that came out lit.
template <class Take>
int take_lobes(const LobeSet& set, LobeType type, const ShadingBatch& s, const float* choice_u, const Vec3Lanes& wi,
               const RGBLanes& weight, const Take& take) {
  const ArenaScope scratch(*s.arena);
  const Chosen chosen = choose(set, type, s, choice_u);
  if (chosen.only < 0 || chosen.lobe) clear(s.n, s, wi, weight);
  if (chosen.only < 0) return 0;
  for (int k = 0; k < set.count; ++k)
    if (set.lobes[k].type == type) take(k, chosen);
  return count_lit(s.n, weight);
}

/// Hands out delta(i) to the lanes that chose the lobe.
template <class DeltaOf>
void draw_delta(const LobeDraw& d, const DeltaOf& delta) {
  const RGBLanes w = d.lobe.weight;
  for_lanes(d.s.n, [&](int i) {
    const Delta to = delta(i);
    const Vec3f before = d.wi[i];
    const RGB weight = w[i], weight_before = d.weight[i];
    const bool mine = d.chosen[i] == d.index;
    d.wi.set(i, {mine ? to.wi.x : before.x, mine ? to.wi.y : before.y, mine ? to.wi.z : before.z});
    d.weight.set(i, {mine ? weight.x * to.f : weight_before.x, mine ? weight.y * to.f : weight_before.y,
                     mine ? weight.z * to.f : weight_before.z});
  });
}

void draw_reflection(const LobeDraw& d) {
  const ShadingBatch& s = d.s;
  const float* const eta = d.lobe.eta;
  if (d.lobe.fresnel == FresnelType::One) {
    draw_delta(d, [&](int i) { return reflect(s.wo[i], s.ns[i], FresnelType::One, 1.0f); });
  } else {
    draw_delta(d, [&](int i) { return reflect(s.wo[i], s.ns[i], FresnelType::Dielectric, eta[i]); });
  }
}

void draw_transmission(const LobeDraw& d) {
  const ShadingBatch& s = d.s;
  const float* const eta = d.lobe.eta;
  if (d.lobe.fresnel == FresnelType::One) {
    draw_delta(d, [&](int i) { return refract(s.wo[i], s.ns[i], FresnelType::One, eta[i]); });
  } else {
    draw_delta(d, [&](int i) { return refract(s.wo[i], s.ns[i], FresnelType::Dielectric, eta[i]); });
  }
  if (!d.eta2) return;
  for_lanes(s.n, [&](int i) {
    const float n = relative_index(dot(s.wo[i], s.ns[i]), eta[i]), before = d.eta2[i];
    d.eta2[i] = d.chosen[i] == d.index ? n * n : before;
  });
}

void scale_reflection(const Lobe& lobe, const ShadingBatch& s, float* to) {
  if (lobe.fresnel == FresnelType::One) return;
  for_lanes(s.n, [&](int i) { to[i] *= fresnel_dielectric(dot(s.wo[i], s.ns[i]), lobe.eta[i]); });
}

void scale_transmission(const Lobe& lobe, const ShadingBatch& s, float* to) {
  if (lobe.fresnel == FresnelType::One) return;
  for_lanes(s.n, [&](int i) { to[i] *= 1 - fresnel_dielectric(dot(s.wo[i], s.ns[i]), lobe.eta[i]); });
}

}  // namespace

int specular_reflection(const LobeSet& set, const ShadingBatch& s, const float* choice_u, const Vec3Lanes& wi,
                        const RGBLanes& weight) {
  return take_lobes(set, LobeType::SpecularReflection, s, choice_u, wi, weight, [&](int k, const Chosen& chosen) {
    const Lobe& lobe = set.lobes[k];
    if (lobe.fresnel == FresnelType::One) {
      take_lobe(set, k, chosen, s, wi, weight,
                [&](int i) { return reflect(s.wo[i], s.ns[i], FresnelType::One, 1.0f); });
    } else {
      take_lobe(set, k, chosen, s, wi, weight,
                [&](int i) { return reflect(s.wo[i], s.ns[i], FresnelType::Dielectric, lobe.eta[i]); });
    }
  });
}

int specular_transmission(const LobeSet& set, const ShadingBatch& s, const float* choice_u, const Vec3Lanes& wi,
                          const RGBLanes& weight) {
  return take_lobes(set, LobeType::SpecularTransmission, s, choice_u, wi, weight, [&](int k, const Chosen& chosen) {
    const Lobe& lobe = set.lobes[k];
    if (lobe.fresnel == FresnelType::One) {
      take_lobe(set, k, chosen, s, wi, weight,
                [&](int i) { return refract(s.wo[i], s.ns[i], FresnelType::One, lobe.eta[i]); });
    } else {
      take_lobe(set, k, chosen, s, wi, weight,
                [&](int i) { return refract(s.wo[i], s.ns[i], FresnelType::Dielectric, lobe.eta[i]); });
    }
  });
}

const LobeRow lobe_rows::SpecularReflection = {
    .name = "specular reflection",
    .effect = Effect::Reflection,
    .reflects = true,
    .transmits = false,
    .specular = true,
    .scale_strength = scale_reflection,
    .sample = draw_reflection,
};

const LobeRow lobe_rows::SpecularTransmission = {
    .name = "specular transmission",
    .effect = Effect::Refraction,
    .reflects = false,
    .transmits = true,
    .specular = true,
    .scale_strength = scale_transmission,
    .sample = draw_transmission,
};

}  // namespace whit
