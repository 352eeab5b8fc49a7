// Microfacets whose reflectance is Schlick's, between a colour at normal and one at grazing incidence: reflection,
// refraction into a solid, and passage through a thin sheet. Schlick, An Inexpensive BRDF Model for Physically-based
// Rendering, 1994; glTF 2.0 Specification, appendix B, and its extension KHR_materials_transmission. Facets may be
// stretched along any direction.
#include "core/lobe/microfacet.h"

namespace whit {

namespace {

template <class Distribution>
struct Plain : Distribution {};

/// The tangents of the stretched facets: turned by `c` of a full turn.
struct Turned {
  Vec3f along, across;
};
inline Turned turned(const LobeQuery& q, int i) {
  const SinCos angle = sin_cos_2pi(q.lobe.c[i]);
  const Vec3f s = q.frame.ss[i], t = q.frame.ts[i];
  return {s * angle.cos + t * angle.sin, t * angle.cos - s * angle.sin};
}

/// As for_facets(), with the distribution turned.
template <class Add>
void for_turned_facets(const LobeQuery& q, const LobeValues& out, const Add& add) {
  const Lobe& lobe = q.lobe;
  if (!is_anisotropic(lobe)) return for_facets<Plain>(q, out, add);
  for_pairs(q, out, [&](int i, const Pair& p, const auto& add_density) {
    const Turned t = turned(q, i);
    add(i, p, Plain<Anisotropic>{{lobe.a[i], lobe.b[i], t.along, t.across}}, add_density);
  });
}

/// Draws direction(i, wo, u, v) in a frame whose x is along the stretched facets.
template <class Direction>
void draw_turned(const LobeDraw& d, const Direction& direction) {
  const float* const turn = d.lobe.c;
  draw_lanes(d, [&direction, turn](int i, const Vec3f& wo, float u, float v) {
    const SinCos t = sin_cos_2pi(turn[i]);
    const Vec3f wi = direction(i, Vec3f(wo.x * t.cos + wo.y * t.sin, wo.y * t.cos - wo.x * t.sin, wo.z), u, v);
    return Vec3f(wi.x * t.cos - wi.y * t.sin, wi.y * t.cos + wi.x * t.sin, wi.z);
  });
}

inline float largest(const RGBLanes& c, int i) { return max_of(max_of(c.r[i], c.g[i]), c.b[i]); }

/// What facets let through is what they do not reflect of any colour: so that reflections do not tint the light behind
/// them in the complementary colour.
inline float let_through(const Lobe& lobe, int i, float outer_cosine) {
  const float r = schlick_reflectance(outer_cosine, largest(lobe.colour1, i), largest(lobe.colour2, i));
  return max_of(1 - r, 0.0f);
}

void eval_reflection(const LobeQuery& q, const LobeValues& out) {
  const Lobe& lobe = q.lobe;
  const RGBLanes f0 = lobe.colour1, f90 = lobe.colour2;
  for_turned_facets(q, out, [&](int i, const Pair& pair, const auto& d, const auto& add_density) {
    Pair p = pair;
    p.reflects = reflects_in_front(q, pair, i);
    const float f = microfacet_reflection(d, p, FresnelType::One, 1.0f);
    const float c = outer_cosine(abs_dot(p.wi, normalize(p.wo + p.wi)), p.zo, lobe.eta[i]);
    out.f.r[i] += lobe.weight.r[i] * f * schlick_reflectance(c, f0.r[i], f90.r[i]);
    out.f.g[i] += lobe.weight.g[i] * f * schlick_reflectance(c, f0.g[i], f90.g[i]);
    out.f.b[i] += lobe.weight.b[i] * f * schlick_reflectance(c, f0.b[i], f90.b[i]);
    add_density(reflection_density(d, p));
  });
}

void draw_turned_reflection(const LobeDraw& d) {
  if (!is_anisotropic(d.lobe)) return draw_reflection(d);
  draw_turned(d, [a = d.lobe.a, b = d.lobe.b](int i, const Vec3f& wo, float u, float v) {
    return reflect_at(wo, sample_visible_normal(wo, a[i], b[i], u, v));
  });
}

void eval_transmission(const LobeQuery& q, const LobeValues& out) {
  const Lobe& lobe = q.lobe;
  for_turned_facets(q, out, [&](int i, const Pair& p, const auto& d, const auto& add_density) {
    // Of both angles of a refraction the larger one is on the outer side.
    const float f = microfacet_transmission(d, p, lobe.eta[i], [&](float oh, float ih) {
      return let_through(lobe, i, min_of(std::abs(oh), std::abs(ih)));
    });
    accumulate(out.f, i, lobe.weight, f);
    add_density(transmission_density(d, p, lobe.eta[i]));
  });
}

void draw_turned_transmission(const LobeDraw& d) {
  if (!is_anisotropic(d.lobe)) return draw_transmission(d);
  draw_turned(d, [a = d.lobe.a, b = d.lobe.b, eta = d.lobe.eta](int i, const Vec3f& wo, float u, float v) {
    return refract_at(wo, sample_visible_normal(wo, a[i], b[i], u, v), relative_index(wo.z, eta[i]));
  });
}

/// The pair whose reflection is this pair's passage through a sheet.
inline Pair mirrored(const Pair& p) {
  Pair m = p;
  m.wi = p.wi - p.n * (2 * p.zi);
  m.zi = -p.zi;
  m.reflects = p.zo * m.zi > 0 ? p.transmits : 0.0f;
  return m;
}

void eval_passage(const LobeQuery& q, const LobeValues& out) {
  const Lobe& lobe = q.lobe;
  for_turned_facets(q, out, [&](int i, const Pair& pair, const auto& d, const auto& add_density) {
    const Pair p = mirrored(pair);
    const float f = microfacet_reflection(d, p, FresnelType::One, 1.0f);
    const float c = abs_dot(p.wi, normalize(p.wo + p.wi));
    accumulate(out.f, i, lobe.weight, f * let_through(lobe, i, c));
    add_density(reflection_density(d, p));
  });
}

void draw_passage(const LobeDraw& d) {
  const auto direction = [a = d.lobe.a, b = d.lobe.b](int i, const Vec3f& wo, float u, float v) {
    const Vec3f wi = reflect_at(wo, sample_visible_normal(wo, a[i], b[i], u, v));
    return Vec3f(wi.x, wi.y, -wi.z);
  };
  if (is_anisotropic(d.lobe)) {
    draw_turned(d, direction);
  } else {
    draw_lanes(d, direction);
  }
}

void scale_reflection(const Lobe& lobe, const ShadingBatch& s, float* to) {
  const RGBLanes f0 = lobe.colour1, f90 = lobe.colour2;
  for_lanes(s.n, [&](int i) {
    const float z = dot(s.wo[i], s.ns[i]);
    const float c = outer_cosine(std::abs(z), z, lobe.eta[i]);
    to[i] *= of_rough_boundary(
        schlick_reflectance(c, luminance({f0.r[i], f0.g[i], f0.b[i]}), luminance({f90.r[i], f90.g[i], f90.b[i]})));
  });
}

void scale_passage(const Lobe& lobe, const ShadingBatch& s, float* to) {
  for_lanes(s.n, [&](int i) { to[i] *= of_rough_boundary(let_through(lobe, i, abs_dot(s.wo[i], s.ns[i]))); });
}

}  // namespace

const LobeRow lobe_rows::SchlickReflection = {
    .name = "Schlick reflection",
    .effect = Effect::Glossy,
    .reflects = true,
    .transmits = false,
    .needs_frame = is_anisotropic,
    .scale_strength = scale_reflection,
    .eval = eval_reflection,
    .sample = draw_turned_reflection,
};

const LobeRow lobe_rows::SchlickTransmission = {
    .name = "Schlick transmission",
    .effect = Effect::Glossy,
    .reflects = false,
    .transmits = true,
    .needs_frame = is_anisotropic,
    .scale_strength = scale_rough_transmission,
    .eval = eval_transmission,
    .sample = draw_turned_transmission,
};

const LobeRow lobe_rows::SchlickPassage = {
    .name = "Schlick passage",
    .effect = Effect::Glossy,
    .reflects = false,
    .transmits = true,
    .needs_frame = is_anisotropic,
    .scale_strength = scale_passage,
    .eval = eval_passage,
    .sample = draw_passage,
};

}  // namespace whit
