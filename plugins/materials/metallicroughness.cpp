// The material of glTF models: a metal, or a diffuse or transparent body, under facets, with a sheen and a coat on top.
// glTF 2.0 Specification, appendix B, and the extensions KHR_materials_ior, _specular, _transmission, _volume,
// _clearcoat, _sheen and _anisotropy. Facets reflect by Schlick's approximation; light that meets two of them is left
// out, as there. A layer leaves to what is below it the light that it does not reflect itself, so that white surfaces
// of any roughness reflect all light. Shadow rays see neither opacity nor transmission.
#include <cmath>

#include "core/lobe/albedo_table.h"
#include "core/plugin/registry.h"
#include "plugins/shared/material_inputs.h"

namespace whit {
namespace {

constexpr float kCoatF0 = 0.04f;  // of the index 1.5

bool may_be_positive(const Tex<float>& t) { return !t.is_constant() || t.value() > 0; }
bool may_be_below_one(const Tex<float>& t) { return !t.is_constant() || t.value() < 1; }
bool is_zero(const Tex<float>& t) { return !may_be_positive(t); }

/// A share, whatever a texture gives.
float* share_of(const Tex<float>& t, const ShadingBatch& s) {
  float* const share = t(s);
  for_lanes(s.n, [&](int i) { share[i] = clamp_to(share[i], 0.0f, 1.0f); });
  return share;
}

RGBLanes grey(float* values) { return {values, values, values}; }

/// The facets' alpha for a roughness, never perfectly smooth.
float* rough_alphas(const Tex<float>& roughness, const ShadingBatch& s) {
  float* const alpha = share_of(roughness, s);
  for_lanes(s.n, [&](int i) { alpha[i] = max_of(alpha[i] * alpha[i], kMinAlpha); });
  return alpha;
}

float largest(const RGB& c) { return max_of(max_of(c.x, c.y), c.z); }

/// The body at the points of a batch.
struct Body {
  const float* share;  ///< What the layers above leave to it.
  const float* eta;    ///< The index inside, 1 if there is no inside.
  RGBLanes colour;
  float *metal, *through;  ///< Shares: of metal, and of light that passes the part that is no metal.
  RGBLanes f0, f90;        ///< What facets reflect at normal and grazing incidence ...
  float *own0, *own90;     ///< ... and where there is no metal: the largest of the colours.
  float *a = nullptr, *b = nullptr, *turn = nullptr;  ///< Of the facets; null where they are one mirror.
};

struct MetallicRoughness : Material {
  Tex<RGB> basecolor, specularcolor, sheencolor;
  Tex<float> metallic, roughness, specular, transmission, opacity;
  Tex<float> clearcoat, clearcoatroughness, sheenroughness, anisotropy, anisotropyrotation;
  float ior = 1.5f;
  bool thin = true;

  void lobes(const ShadingBatch& s, LobeSet& out) const override {
    float* const share = share_of(opacity, s);
    const float* const eta = filled(s, is_solid() ? clamp_to(ior, 1e-3f, 1e3f) : 1.0f);
    if (is_solid() && !is_zero(opacity)) out.eta = eta;
    if (may_be_below_one(opacity)) add_passage(s, grey(copy(share, s)), out.eta, out);
    if (is_zero(opacity)) return;
    const RGBLanes mirror = s.arena->rgb(s.n);
    for_lanes(s.n, [&](int i) { mirror.set(i, RGB(0.0f)); });
    if (may_be_positive(clearcoat)) add_coat(s, share, mirror, out);
    if (!is_black(sheencolor)) add_sheen(s, share, out);
    const Body body = make_body(s, share, eta);
    if (is_shiny()) add_reflection(s, body, mirror, out);
    if (is_body_seen() && may_be_below_one(transmission)) add_diffuse(s, body, out);
    if (lets_through()) add_transmission(s, body, out);
    if ((is_shiny() && is_smooth()) || has_smooth_coat()) {
      Lobe& lobe = add(LobeType::SpecularReflection, mirror, out);
      lobe.eta = eta;
    }
  }

 private:
  bool is_smooth() const { return is_zero(roughness) && is_zero(anisotropy); }
  bool has_smooth_coat() const { return may_be_positive(clearcoat) && is_zero(clearcoatroughness); }
  /// Below the metal.
  bool is_body_seen() const { return may_be_below_one(metallic); }
  /// Its light meets facets.
  bool is_coupled() const { return is_body_seen() && may_be_positive(specular); }
  bool lets_through() const { return is_body_seen() && may_be_positive(transmission); }
  /// An index of 0 stands for one without bound: all is reflected, and nothing bends.
  bool is_solid() const { return lets_through() && !thin && ior > 0; }
  /// Facets of an index of 1 bend nothing and blur nothing. (A half vector of a refraction that does not bend is rounding.)
  bool is_clear() const { return is_smooth() || (is_solid() && std::abs(ior - 1) < 1e-4f); }
  /// In a solid there is total reflection, whatever the outside reflects.
  bool is_shiny() const { return may_be_positive(metallic) || is_coupled() || is_solid(); }
  bool has_facets() const { return is_shiny() || lets_through(); }
  float own_f0() const {
    const float root = (ior - 1) / (ior + 1);
    return root * root;
  }

  static float* copy(const float* from, const ShadingBatch& s) {
    float* const to = s.arena->floats(s.n);
    for_lanes(s.n, [&](int i) { to[i] = from[i]; });
    return to;
  }

  static Lobe& add(LobeType type, const RGBLanes& weight, LobeSet& out) {
    Lobe lobe;
    lobe.type = type, lobe.weight = weight;
    out.add(lobe);
    return out.lobes[out.count - 1];
  }

  /// Scales the share of what is below by what the coat leaves.
  void add_coat(const ShadingBatch& s, float* share, const RGBLanes& mirror, LobeSet& out) const {
    const float* const amount = share_of(clearcoat, s);
    float* const weight = s.arena->floats(s.n);
    for_lanes(s.n, [&](int i) { weight[i] = amount[i] * share[i]; });
    if (is_zero(clearcoatroughness)) {
      for_lanes(s.n, [&](int i) {
        const float f = weight[i] * schlick_reflectance(abs_dot(s.wo[i], s.ns[i]), kCoatF0, 1);
        mirror.set(i, mirror[i] + RGB(f));
        share[i] -= f;
      });
      return;
    }
    Lobe& lobe = add(LobeType::SchlickReflection, grey(weight), out);
    lobe.a = lobe.b = rough_alphas(clearcoatroughness, s);
    lobe.colour1 = grey(filled(s, kCoatF0)), lobe.colour2 = grey(filled(s, 1)), lobe.eta = lobe.colour2.r;
    const float* const alpha = lobe.a;
    if (s.n == 0) return;
    const FacetAlbedo& albedo = facet_albedo();
    for_lanes(s.n, [&](int i) {
      const float z = abs_dot(s.wo[i], s.ns[i]);
      share[i] -= weight[i] * albedo(z, FacetAlbedo::position(alpha[i]), kCoatF0, 1);
    });
  }

  /// The same of the sheen. Where fibres would scatter more than there is, at grazing angles, they scatter all of it.
  void add_sheen(const ShadingBatch& s, float* share, LobeSet& out) const {
    const RGBLanes colour = weights(sheencolor, s), weight = s.arena->rgb(s.n);
    const float* const rough = share_of(sheenroughness, s);
    add(LobeType::CharlieSheen, weight, out).a = rough;
    if (s.n == 0) return;
    const AlbedoTable& albedo = sheen_albedo();
    for_lanes(s.n, [&](int i) {
      const RGB c = colour[i];
      const float scattered = largest(c) * albedo(abs_dot(s.wo[i], s.ns[i]), sheen_position(rough[i]));
      const float scale = scattered > 1 ? share[i] / scattered : share[i];
      weight.set(i, c * scale);
      share[i] *= 1 - min_of(scattered, 1.0f);
    });
  }

  Body make_body(const ShadingBatch& s, const float* share, const float* eta) const {
    const auto floats = [&] { return s.arena->floats(s.n); };
    // What no lobe needs is not asked for, so that textures of it are not read.
    const auto shares = [&](bool asked, const Tex<float>& t) { return asked ? share_of(t, s) : filled(s, 0); };
    Body at{share,
            eta,
            weights(basecolor, s),
            share_of(metallic, s),
            shares(is_body_seen(), transmission),
            s.arena->rgb(s.n),
            s.arena->rgb(s.n),
            floats(),
            floats()};
    const float* const strength = shares(is_body_seen(), specular);
    const RGBLanes tint = is_coupled() ? weights(specularcolor, s) : grey(filled(s, 0));
    const float normal = own_f0();
    for_lanes(s.n, [&](int i) {
      const RGB t = tint[i], c = at.colour[i];
      const float m = at.metal[i], g = strength[i];
      const RGB own{g * min_of(normal * t.x, 1.0f), g * min_of(normal * t.y, 1.0f), g * min_of(normal * t.z, 1.0f)};
      at.f0.set(i, {lerp(m, own.x, c.x), lerp(m, own.y, c.y), lerp(m, own.z, c.z)});
      at.f90.set(i, RGB(lerp(m, g, 1)));
      at.own0[i] = largest(own), at.own90[i] = g;
    });
    if (has_facets() && !is_smooth()) set_facets(s, at);
    return at;
  }

  /// The extension stretches facets along a direction up to an alpha of 1, and leaves the other one's.
  void set_facets(const ShadingBatch& s, Body& at) const {
    at.a = at.b = rough_alphas(roughness, s);
    if (is_zero(anisotropy)) return;
    const float* const strength = share_of(anisotropy, s);
    const float* const degrees = anisotropyrotation(s);
    at.a = s.arena->floats(s.n), at.turn = s.arena->floats(s.n);
    for_lanes(s.n, [&](int i) {
      at.a[i] = lerp(strength[i] * strength[i], at.b[i], 1);
      // Counter-clockwise as the bitangent is, which may be on either side.
      const float side = dot(cross(s.ns[i], s.dpdu[i]), s.dpdv[i]) < 0 ? -1.0f : 1.0f;
      const float turn = side * degrees[i] / 360;
      at.turn[i] = turn - std::floor(turn);
    });
  }

  static void set_facets(const Body& at, Lobe& lobe) {
    lobe.a = at.a, lobe.b = at.b, lobe.c = at.turn, lobe.eta = at.eta;
  }

  void add_reflection(const ShadingBatch& s, const Body& at, const RGBLanes& mirror, LobeSet& out) const {
    if (!is_smooth()) {
      Lobe& lobe = add(LobeType::SchlickReflection, grey(copy(at.share, s)), out);
      set_facets(at, lobe);
      lobe.colour1 = at.f0, lobe.colour2 = at.f90;
      return;
    }
    for_lanes(s.n, [&](int i) {
      const float z = dot(s.wo[i], s.ns[i]), c = outer_cosine(std::abs(z), z, at.eta[i]), f90 = at.f90.r[i];
      const RGB before = mirror[i], f0 = at.f0[i];
      mirror.set(i, {before.x + at.share[i] * schlick_reflectance(c, f0.x, f90),
                     before.y + at.share[i] * schlick_reflectance(c, f0.y, f90),
                     before.z + at.share[i] * schlick_reflectance(c, f0.z, f90)});
    });
  }

  /// The diffuse part of the body, reached through the facets and left through them. Inside of a solid there is none:
  /// what is not let out is absorbed.
  void add_diffuse(const ShadingBatch& s, const Body& at, LobeSet& out) const {
    const RGBLanes weight = s.arena->rgb(s.n);
    float* const position = s.arena->floats(s.n);
    Lobe& lobe = add(LobeType::CoupledDiffuse, weight, out);
    lobe.a = position, lobe.c = at.own0, lobe.d = at.own90;
    if (s.n == 0) return;
    // Without facets nothing depends on how smooth they are.
    const bool solid = is_solid(), smooth = !at.b;
    const FacetAlbedo& albedo = facet_albedo();
    for_lanes(s.n, [&](int i) {
      const float z = dot(s.wo[i], s.ns[i]), all = at.share[i] * (1 - at.metal[i]) * (1 - at.through[i]);
      const RGB c = at.colour[i];
      weight.set(i, c * (solid && z < 0 ? 0.0f : all));
    });
    for_lanes(s.n, [&](int i) {
      // Of stretched facets those across reflect most at grazing angles: less is let in, and never too much.
      position[i] = FacetAlbedo::position(smooth ? 0.0f : at.b[i]);
      const float z = abs_dot(s.wo[i], s.ns[i]), f0 = at.own0[i], f90 = at.own90[i];
      const float leaves = max_of(1 - albedo(z, position[i], f0, f90), 0.0f);
      // Facets that reflect nearly all let in hardly more than what others of them would reflect in turn.
      const float mean = max_of(1 - albedo.mean(position[i], f0, f90), 0.05f);
      weight.set(i, weight[i] * (leaves / mean));
    });
  }

  void add_transmission(const ShadingBatch& s, const Body& at, LobeSet& out) const {
    const RGBLanes weight = s.arena->rgb(s.n);
    for_lanes(s.n, [&](int i) {
      const RGB c = at.colour[i];
      weight.set(i, c * (at.share[i] * (1 - at.metal[i]) * at.through[i]));
    });
    if (!is_clear()) {
      Lobe& lobe = add(is_solid() ? LobeType::SchlickTransmission : LobeType::SchlickPassage, weight, out);
      set_facets(at, lobe);
      lobe.colour1 = grey(at.own0), lobe.colour2 = grey(at.own90);
      return;
    }
    Lobe& lobe = add(LobeType::SpecularTransmission, weight, out);
    lobe.fresnel = FresnelType::One, lobe.eta = at.eta;
    for_lanes(s.n, [&](int i) {
      const float z = dot(s.wo[i], s.ns[i]), c = outer_cosine(std::abs(z), z, at.eta[i]);
      weight.set(i, weight[i] * (1 - schlick_reflectance(c, at.own0[i], at.own90[i])));
    });
  }
};

const Register<MetallicRoughness> metallicroughness{
    "metallicroughness",
    "The material of glTF models: metal or not, rough or not, with coat, sheen and transmission.",
    param(&MetallicRoughness::basecolor, "basecolor", RGB(1.0f), Unit::None,
          "Colour of the body: what a metal reflects, and what other bodies scatter or let through."),
    param(&MetallicRoughness::metallic, "metallic", 1.0f, Unit::None, "From a dielectric, 0, to a metal, 1.", kUnit),
    param(&MetallicRoughness::roughness, "roughness", 1.0f, Unit::None,
          "Roughness; the facets' alpha is its square. A constant 0 is perfectly smooth.", kUnit),
    param(&MetallicRoughness::ior, "ior", 1.5f, Unit::None,
          "Index of refraction inside over that outside. 0 stands for one without bound: all is reflected.",
          kNonNegative),
    param(&MetallicRoughness::specular, "specular", 1.0f, Unit::None, "Strength of a dielectric's reflection.", kUnit),
    param(&MetallicRoughness::specularcolor, "specularcolor", RGB(1.0f), Unit::None,
          "Colour of a dielectric's reflection at normal incidence."),
    param(&MetallicRoughness::transmission, "transmission", 0.0f, Unit::None,
          "Share of the light inside a dielectric that passes instead of being scattered.", kUnit),
    param(&MetallicRoughness::thin, "thin", true, Unit::None,
          "What lets light through is a sheet, which does not bend it; otherwise it is the boundary of a solid."),
    param(&MetallicRoughness::clearcoat, "clearcoat", 0.0f, Unit::None, "Strength of a clear coat of index 1.5.",
          kUnit),
    param(&MetallicRoughness::clearcoatroughness, "clearcoatroughness", 0.0f, Unit::None,
          "Roughness of that. A constant 0 is perfectly smooth.", kUnit),
    param(&MetallicRoughness::sheencolor, "sheencolor", RGB(0.0f), Unit::None,
          "Colour of light at grazing angles, as on cloth."),
    param(&MetallicRoughness::sheenroughness, "sheenroughness", 0.0f, Unit::None,
          "How far that reaches towards the normal. Less than 0.07 counts as 0.07.", kUnit),
    param(&MetallicRoughness::anisotropy, "anisotropy", 0.0f, Unit::None,
          "Stretches the facets along the tangent, dpdu, up to an alpha of 1.", kUnit),
    param(&MetallicRoughness::anisotropyrotation, "anisotropyrotation", 0.0f, Unit::Degrees,
          "Angle of that direction, counter-clockwise from the tangent towards the bitangent, dpdv."),
    param(&MetallicRoughness::opacity, "opacity", 1.0f, Unit::None,
          "Share of all this; the rest of a ray passes straight on.", kUnit),
    bumpmap_param(),
    normalmap_param(),
    normalscale_param()};

}  // namespace
}  // namespace whit
