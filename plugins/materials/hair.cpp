// Hair and fur: a rough dielectric cylinder with an absorbing inside and tilted scales, made for curves. Chiang et
// al., A Practical and Controllable Hair and Fur Model for Production Path Tracing, 2016, and Pharr, The
// Implementation of a Hair Scattering Model, 2016; see core/lobe/hair.h. Light between hairs is not simulated.
#include "core/lobe/hair.h"

#include <optional>
#include <string>

#include "core/base/fastmath.h"
#include "core/plugin/registry.h"
#include "plugins/shared/material_inputs.h"

namespace whit {
namespace {

/// Absorption per unit concentration of the two pigments of hair. d'Eon et al. 2011.
const RGB kEumelanin(0.419f, 0.697f, 1.37f), kPheomelanin(0.187f, 0.4f, 1.05f);
/// Brown: the eumelanin of hair that nothing is said about.
constexpr float kDefaultEumelanin = 1.3f;

/// The narrowest roughness: at 0 the distributions are not functions.
constexpr float kMinBeta = 1e-3f;

struct Hair : Material {
  std::optional<Tex<RGB>> sigma_a, color;
  std::optional<Tex<float>> eumelanin, pheomelanin;
  Tex<float> eta, beta_m, beta_n, alpha;

  void check(Diagnostics& diagnostics, SourcePos statement) override {
    const char* const used = sigma_a ? "sigma_a" : color ? "color" : nullptr;
    if (!used) return;
    const auto ignored = [&](const char* name) {
      diagnostics.warning(statement, std::string("hair's \"") + name + "\" is ignored",
                          std::string("its \"") + used + "\" already gives the colour");
    };
    if (sigma_a && color) ignored("color");
    if (eumelanin) ignored("eumelanin");
    if (pheomelanin) ignored("pheomelanin");
  }

  void lobes(const ShadingBatch& s, LobeSet& out) const override {
    float *const longitudinal = beta_m(s), *const azimuthal = beta_n(s), *const tilt = alpha(s);
    float* const offset = s.arena->floats(s.n);
    Lobe lobe;
    lobe.type = LobeType::Hair;
    lobe.colour1 = absorption(s, azimuthal);
    for_lanes(s.n, [&](int i) {
      offset[i] = clamp_to(2 * s.v[i] - 1, -1.0f, 1.0f);
      longitudinal[i] = hair_variance(clamp_to(longitudinal[i], kMinBeta, 1.0f));
      azimuthal[i] = hair_azimuthal_scale(clamp_to(azimuthal[i], kMinBeta, 1.0f));
      tilt[i] *= kPi / 180;
    });
    float* const one = filled(s, 1);
    lobe.weight = {one, one, one};
    lobe.a = offset, lobe.b = longitudinal, lobe.c = azimuthal, lobe.d = tilt;
    lobe.eta = out.eta = indices(eta, s);
    out.add(lobe);
  }

 private:
  RGBLanes absorption(const ShadingBatch& s, const float* azimuthal_roughness) const {
    if (sigma_a) return weights(*sigma_a, s);
    return color ? absorption_of_colour(s, azimuthal_roughness) : absorption_of_pigments(s);
  }

  /// The absorption that makes a mass of hair look as given: Chiang et al. 2016, equation 9.
  RGBLanes absorption_of_colour(const ShadingBatch& s, const float* beta) const {
    const RGBLanes c = weights(*color, s);
    for_lanes(s.n, [&](int i) {
      const float b = beta[i];
      const float fit = 5.969f + b * (-0.215f + b * (2.532f + b * (-10.73f + b * (5.574f + b * 0.245f))));
      // Black would absorb infinitely; this much is black.
      const auto absorbed = [fit](float x) {
        const float root = log_of(max_of(x, 1e-30f)) / fit;
        return root * root;
      };
      c.set(i, {absorbed(c.r[i]), absorbed(c.g[i]), absorbed(c.b[i])});
    });
    return c;
  }

  RGBLanes absorption_of_pigments(const ShadingBatch& s) const {
    const bool none = !eumelanin && !pheomelanin;
    const float* const eu = eumelanin ? (*eumelanin)(s) : filled(s, none ? kDefaultEumelanin : 0.0f);
    const float* const pheo = pheomelanin ? (*pheomelanin)(s) : filled(s, 0);
    const RGBLanes out = s.arena->rgb(s.n);
    for_lanes(s.n, [&](int i) {
      const float e = max_of(eu[i], 0.0f), p = max_of(pheo[i], 0.0f);
      out.set(i, {e * kEumelanin.x + p * kPheomelanin.x, e * kEumelanin.y + p * kPheomelanin.y,
                  e * kEumelanin.z + p * kPheomelanin.z});
    });
    return out;
  }
};

const Register<Hair> hair{
    "hair",
    "Hair and fur, for curves; by default brown.",
    param(&Hair::sigma_a, "sigma_a", Unit::None, "Absorption inside, per radius; goes before all other colours."),
    param(&Hair::color, "color", Unit::None, "The colour of a mass of hair; goes before the pigments."),
    param(&Hair::eumelanin, "eumelanin", Unit::None,
          "Concentration of the dark pigment, from 0 to 8 in human hair; 1.3 when no colour is given."),
    param(&Hair::pheomelanin, "pheomelanin", Unit::None, "Concentration of the reddish pigment."),
    param(&Hair::eta, "eta", 1.55f, Unit::None, "Index of refraction inside over that outside.", kPositive),
    param(&Hair::beta_m, "beta_m", 0.3f, Unit::None, "Roughness along the hair.", kUnit),
    param(&Hair::beta_n, "beta_n", 0.3f, Unit::None, "Roughness around the hair.", kUnit),
    param(&Hair::alpha, "alpha", 2.0f, Unit::Degrees, "Tilt of the scales."),
    bumpmap_param()};

}  // namespace
}  // namespace whit
