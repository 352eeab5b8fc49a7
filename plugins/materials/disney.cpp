// Disney's BSDF: one set of parameters from plastic and cloth to metal and thin leaves. Burley, Physically Based
// Shading at Disney, 2012, and Extending the Disney BRDF to a BSDF with Integrated Subsurface Scattering, 2015, with
// the choices of pbrt-v3. Where scatterdistance is not black only the boundary is simulated, no light inside.
#include <algorithm>
#include <cmath>

#include "core/base/fastmath.h"
#include "core/lobe/formulas.h"
#include "core/plugin/registry.h"
#include "plugins/shared/material_inputs.h"

namespace whit {
namespace {

/// The parameters at the points of a batch that several lobes need.
struct Shared {
  RGBLanes colour, tint;  ///< tint: the colour at luminance 1; white for black.
  float *metallic, *eta, *roughness, *spectrans;
  float* diffuse;    ///< The share of the diffuse family.
  float* difftrans;  ///< The share of diffuse light that goes through; null unless the surface is thin.
  float* aspect;     ///< Of the facets' alphas, 1 when isotropic.
};

struct Disney : Material {
  Tex<RGB> color, scatterdistance;
  Tex<float> metallic, eta, roughness, speculartint, anisotropic, sheen, sheentint, clearcoat, clearcoatgloss;
  Tex<float> spectrans, flatness, difftrans;
  bool thin = false;

  bool scatters_below() const override {
    return !thin && !(scatterdistance.is_constant() && is_black(scatterdistance.value()));
  }

  void lobes(const ShadingBatch& s, LobeSet& out) const override {
    const Shared at = shared(s);
    if (may_be_diffuse() && !all_zero(at.diffuse, s.n)) add_diffuse(s, at, out);
    add_specular(s, at, out);
    if (may_be_positive(clearcoat)) add_clearcoat(s, out);
    if (may_be_positive(spectrans)) add_transmission(s, at, out);
    if (thin) add(LobeType::LambertTransmission, scaled(s, at.colour, at.difftrans), out);
  }

  std::vector<Ineffective> ineffective() const override {
    std::vector<Ineffective> all;
    if (!may_be_diffuse()) {
      constexpr const char* why = "\"metallic\" or \"spectrans\" is 1, so nothing is diffuse";
      for (const char* name : {"sheen", "sheentint", "scatterdistance", "flatness"}) all.push_back({name, why});
    } else {
      if (!may_be_positive(sheen)) all.push_back({"sheentint", "there is no \"sheen\"", "sheen"});
      if (thin) all.push_back({"scatterdistance", "the surface is \"thin\""});
      else all.push_back({"flatness", "the surface is not \"thin\"", "thin"});
    }
    if (!may_be_positive(clearcoat)) all.push_back({"clearcoatgloss", "there is no \"clearcoat\"", "clearcoat"});
    if (!thin) all.push_back({"difftrans", "the surface is not \"thin\"", "thin"});
    if (metallic.is_constant() && metallic.value() == 1)
      all.push_back({"speculartint", "the surface is all metal: \"metallic\" is 1"});
    return all;
  }

 private:
  static bool may_be_positive(const Tex<float>& t) { return !t.is_constant() || t.value() > 0; }
  /// Of no points nothing is known.
  static bool all_zero(const float* x, int n) {
    return n > 0 && std::all_of(x, x + n, [](float v) { return v == 0; });
  }
  /// Metal scatters nothing diffusely, and neither does what lets everything through.
  bool may_be_diffuse() const {
    const auto takes_all = [](const Tex<float>& share) { return share.is_constant() && share.value() == 1; };
    return !takes_all(metallic) && !takes_all(spectrans);
  }
  bool scatters_inside() const { return !thin && !is_black(scatterdistance); }

  static Lobe& add(LobeType type, const RGBLanes& weight, LobeSet& out) {
    Lobe lobe;
    lobe.type = type, lobe.weight = weight;
    out.add(lobe);
    return out.lobes[out.count - 1];
  }

  /// colour times factor, at least 0.
  static RGBLanes scaled(const ShadingBatch& s, const RGBLanes& colour, const float* factor) {
    const RGBLanes out = s.arena->rgb(s.n);
    for_lanes(s.n, [&](int i) {
      const float f = max_of(factor[i], 0.0f);
      out.set(i, {colour.r[i] * f, colour.g[i] * f, colour.b[i] * f});
    });
    return out;
  }

  Shared shared(const ShadingBatch& s) const {
    Shared at{weights(color, s), s.arena->rgb(s.n), metallic(s),          indices(eta, s),
              roughness(s),      spectrans(s),      s.arena->floats(s.n), thin ? difftrans(s) : nullptr,
              anisotropic(s)};
    for_lanes(s.n, [&](int i) {
      const RGB c = at.colour[i];
      const float y = luminance(c), scale = y > 0 ? 1 / y : 0.0f;
      at.tint.set(i, {y > 0 ? c.x * scale : 1.0f, y > 0 ? c.y * scale : 1.0f, y > 0 ? c.z * scale : 1.0f});
      at.diffuse[i] = max_of((1 - at.metallic[i]) * (1 - at.spectrans[i]), 0.0f);
      // Beyond 1 the root would leave the reals.
      at.aspect[i] = std::sqrt(1 - 0.9f * min_of(at.aspect[i], 1.0f));
    });
    if (thin) for_lanes(s.n, [&](int i) { at.difftrans[i] *= 0.5f; });
    return at;
  }

  void add_diffuse(const ShadingBatch& s, const Shared& at, LobeSet& out) const {
    const RGBLanes all = scaled(s, at.colour, at.diffuse);
    if (thin) {
      add_thin_diffuse(s, at, all, out);
    } else if (scatters_inside()) {
      add_boundary(s, at, all, out);
    } else {
      add(LobeType::DisneyDiffuse, all, out);
    }
    add(LobeType::DisneyRetro, all, out).a = at.roughness;
    if (may_be_positive(sheen)) add_sheen(s, at, out);
  }

  /// The reflected share, divided by flatness between the surface and what is below it.
  void add_thin_diffuse(const ShadingBatch& s, const Shared& at, const RGBLanes& all, LobeSet& out) const {
    const float* const flat = flatness(s);
    float *const surface = s.arena->floats(s.n), *const below = s.arena->floats(s.n);
    for_lanes(s.n, [&](int i) {
      surface[i] = (1 - flat[i]) * (1 - at.difftrans[i]);
      below[i] = flat[i] * (1 - at.difftrans[i]);
    });
    add(LobeType::DisneyDiffuse, scaled(s, all, surface), out);
    if (may_be_positive(flatness)) add(LobeType::DisneyFakeSubsurface, scaled(s, all, below), out).a = at.roughness;
  }

  /// Where light scatters inside, the way in takes the place of the diffuse lobe.
  void add_boundary(const ShadingBatch& s, const Shared& at, const RGBLanes& all, LobeSet& out) const {
    const RGBLanes distance = scatterdistance(s), enters = s.arena->rgb(s.n), reflects = s.arena->rgb(s.n);
    for_lanes(s.n, [&](int i) {
      const bool inside = (distance.r[i] != 0) | (distance.g[i] != 0) | (distance.b[i] != 0);
      const float on = (inside & (at.diffuse[i] > 0)) ? 1.0f : 0.0f, off = inside ? 0.0f : 1.0f;
      enters.set(i, {on, on, on});
      reflects.set(i, {all.r[i] * off, all.g[i] * off, all.b[i] * off});
    });
    if (!scatterdistance.is_constant()) add(LobeType::DisneyDiffuse, reflects, out);
    Lobe& in = add(LobeType::SpecularTransmission, enters, out);
    in.fresnel = FresnelType::Dielectric, in.eta = at.eta;
  }

  void add_sheen(const ShadingBatch& s, const Shared& at, LobeSet& out) const {
    const float *const amount = sheen(s), *const tint = sheentint(s);
    const RGBLanes weight = s.arena->rgb(s.n);
    for_lanes(s.n, [&](int i) {
      const float w = max_of(amount[i], 0.0f) * at.diffuse[i];
      weight.set(i, {w * lerp(tint[i], 1, at.tint.r[i]), w * lerp(tint[i], 1, at.tint.g[i]),
                     w * lerp(tint[i], 1, at.tint.b[i])});
    });
    add(LobeType::DisneySheen, clamp0(s.n, weight), out);
  }

  void add_specular(const ShadingBatch& s, const Shared& at, LobeSet& out) const {
    const float* const tint = speculartint(s);
    const RGBLanes r0 = s.arena->rgb(s.n);
    for_lanes(s.n, [&](int i) {
      const float root = (at.eta[i] - 1) / (at.eta[i] + 1), normal = root * root, m = at.metallic[i];
      r0.set(i, {lerp(m, normal * lerp(tint[i], 1, at.tint.r[i]), at.colour.r[i]),
                 lerp(m, normal * lerp(tint[i], 1, at.tint.g[i]), at.colour.g[i]),
                 lerp(m, normal * lerp(tint[i], 1, at.tint.b[i]), at.colour.b[i])});
    });
    Lobe& lobe = add(LobeType::DisneyReflection, white(s), out);
    set_alphas(s, at, at.roughness, lobe);
    lobe.colour1 = r0, lobe.c = at.metallic, lobe.eta = at.eta;
  }

  static RGBLanes white(const ShadingBatch& s) {
    float* const one = filled(s, 1);
    return {one, one, one};
  }

  void set_alphas(const ShadingBatch& s, const Shared& at, const float* rough, Lobe& lobe) const {
    float* const a = s.arena->floats(s.n);
    float* const b = anisotropic.is_constant() && anisotropic.value() == 0 ? a : s.arena->floats(s.n);
    for_lanes(s.n, [&](int i) {
      const float r2 = rough[i] * rough[i], aspect = at.aspect[i];
      b[i] = max_of(r2 * aspect, kMinAlpha);
      a[i] = max_of(r2 / aspect, kMinAlpha);
    });
    lobe.a = a, lobe.b = b;
  }

  void add_clearcoat(const ShadingBatch& s, LobeSet& out) const {
    const float *const amount = clearcoat(s), *const gloss = clearcoatgloss(s);
    float* const alpha = s.arena->floats(s.n);
    // Kept within (0, 1), where the distribution is defined, whatever a texture gives for the gloss.
    for_lanes(s.n, [&](int i) { alpha[i] = clamp_to(lerp(gloss[i], 0.1f, 0.001f), 1e-3f, 0.999f); });
    add(LobeType::DisneyClearcoat, scaled(s, white(s), amount), out).a = alpha;
  }

  /// The root of the colour, because light passes two boundaries. A thin surface is both at once and scatters less:
  /// its facets follow from the index (Burley 2015, figure 15), with the usual masking.
  void add_transmission(const ShadingBatch& s, const Shared& at, LobeSet& out) const {
    const RGBLanes weight = s.arena->rgb(s.n);
    float* const rough = s.arena->floats(s.n);
    for_lanes(s.n, [&](int i) {
      const float t = max_of(at.spectrans[i], 0.0f);
      weight.set(i, {t * std::sqrt(at.colour.r[i]), t * std::sqrt(at.colour.g[i]), t * std::sqrt(at.colour.b[i])});
      rough[i] = (thin ? 0.65f * at.eta[i] - 0.35f : 1.0f) * at.roughness[i];
    });
    Lobe& lobe = add(thin ? LobeType::MicrofacetTransmission : LobeType::DisneyTransmission, weight, out);
    set_alphas(s, at, rough, lobe);
    lobe.fresnel = FresnelType::Dielectric, lobe.eta = at.eta;
  }
};

const Register<Disney> disney{
    "disney",
    "Disney's BSDF: from plastic and cloth to metal, glass and thin leaves.",
    param(&Disney::color, "color", RGB(0.5f), Unit::None, "Colour of the base, of metal and of what passes through."),
    param(&Disney::metallic, "metallic", 0.0f, Unit::None, "From a dielectric, 0, to a metal, 1."),
    param(&Disney::eta, "eta", 1.5f, Unit::None, "Index of refraction inside over that outside.", kPositive),
    param(&Disney::roughness, "roughness", 0.5f, Unit::None, "Roughness in 0..1; the facets' alpha is its square.",
          kRoughness),
    param(&Disney::speculartint, "speculartint", 0.0f, Unit::None,
          "How much of the base's hue the gloss takes, 0 to 1."),
    param(&Disney::anisotropic, "anisotropic", 0.0f, Unit::None, "Stretches the gloss along u, up to tenfold at 1."),
    param(&Disney::sheen, "sheen", 0.0f, Unit::None, "Strength of light at grazing angles, as on cloth, 0 to 1."),
    param(&Disney::sheentint, "sheentint", 0.5f, Unit::None, "How much of the base's hue the sheen takes, 0 to 1."),
    param(&Disney::clearcoat, "clearcoat", 0.0f, Unit::None, "Strength of a second, clear layer of gloss, 0 to 1."),
    param(&Disney::clearcoatgloss, "clearcoatgloss", 1.0f, Unit::None, "From a satin coat, 0, to a glossy one, 1."),
    param(&Disney::spectrans, "spectrans", 0.0f, Unit::None,
          "Share of the base that transmits like rough glass, 0 to 1."),
    param(&Disney::scatterdistance, "scatterdistance", RGB(0.0f), Unit::Length,
          "How far light scatters below the surface. Unless it is black, only the boundary is simulated."),
    param(&Disney::thin, "thin", false, Unit::None, "The surface is a sheet, not the boundary of a solid."),
    param(&Disney::flatness, "flatness", 0.0f, Unit::None,
          "When thin: how much of the diffuse base looks lit from below, 0 to 1."),
    param(&Disney::difftrans, "difftrans", 1.0f, Unit::None,
          "When thin: from all diffuse light reflected, 0, to all transmitted, 2."),
    bumpmap_param()};

}  // namespace
}  // namespace whit
