// A rough metal: Torrance-Sparrow with Trowbridge-Reitz facets that reflect by Fresnel's equations for a complex
// index of refraction. Facets that light leaves only after several reflections are dark, as in all such models.
// Copper's index: Hagemann, Gudat, Kunz, Optical Constants from the Far Infrared to the X-Ray Region, DESY SR-74/7,
// 1974, measured each 0.1 eV and interpolated between.
#include <optional>
#include <vector>

#include "core/base/spectrum.h"
#include "core/plugin/registry.h"
#include "plugins/shared/material_inputs.h"

namespace whit {
namespace {

struct Metal : Material {
  Tex<RGB> eta, k;
  Tex<float> roughness;
  std::optional<Tex<float>> uroughness, vroughness;
  bool remaproughness = true;

  const Tex<float>& along_u() const { return uroughness ? *uroughness : roughness; }
  const Tex<float>& along_v() const { return vroughness ? *vroughness : roughness; }

  void lobes(const ShadingBatch& s, LobeSet& out) const override {
    Lobe lobe;
    lobe.type = LobeType::MicrofacetReflection;
    lobe.fresnel = FresnelType::Conductor;
    float* const one = filled(s, 1);
    lobe.weight = {one, one, one};
    lobe.colour1 = eta(s), lobe.colour2 = k(s);
    set_alphas(lobe, along_u(), along_v(), remaproughness, s);
    out.add(lobe);
  }

  std::vector<Ineffective> ineffective() const override {
    if (!uroughness || !vroughness) return {};
    return {{"roughness", "\"uroughness\" and \"vroughness\" go before it"}};
  }
};

/// n and k of copper at photon energies of 1.45 eV, 1.50 eV and so on to 3.45 eV: all visible light.
struct Index {
  double n, k;
};
constexpr double kFirstEnergy = 1.45, kEnergyStep = 0.05;
constexpr Index kCopper[] = {
    {0.280000, 5.485625}, {0.260000, 5.260000}, {0.254188, 5.034125}, {0.250000, 4.817000}, {0.236500, 4.619563},
    {0.223000, 4.430000}, {0.216250, 4.239563}, {0.213000, 4.050000}, {0.209250, 3.863125}, {0.214000, 3.670000},
    {0.230813, 3.458187}, {0.272000, 3.240000}, {0.351250, 3.010750}, {0.468000, 2.809000}, {0.645875, 2.678062},
    {0.826000, 2.599000}, {0.950375, 2.576500}, {1.040000, 2.583000}, {1.092437, 2.595562}, {1.120000, 2.605000},
    {1.131562, 2.589625}, {1.135000, 2.564000}, {1.142812, 2.535875}, {1.150000, 2.504000}, {1.155312, 2.469187},
    {1.160000, 2.433000}, {1.165312, 2.397625}, {1.170000, 2.362000}, {1.172812, 2.326000}, {1.175000, 2.289000},
    {1.178125, 2.249938}, {1.180000, 2.210000}, {1.177500, 2.160063}, {1.175000, 2.130000}, {1.174375, 2.177188},
    {1.180000, 2.210000}, {1.200000, 2.121562}, {1.225000, 2.015000}, {1.249062, 1.972438}, {1.270000, 1.950000},
    {1.281563, 1.931688}};

/// The colour of copper's n or k.
RGB copper(double Index::*part) {
  constexpr double kPlanckTimesLight = 1239.84178;  // eV nm
  std::vector<double> samples;
  for (size_t i = 0; i < std::size(kCopper); ++i) {
    samples.push_back(kPlanckTimesLight / (kFirstEnergy + kEnergyStep * static_cast<double>(i)));
    samples.push_back(kCopper[i].*part);
  }
  return rgb_from_samples(samples);
}

const Register<Metal> metal{
    "metal",
    "A rough metal.",
    param(&Metal::eta, "eta", copper(&Index::n), Unit::None, "Index of refraction; copper's unless given."),
    param(&Metal::k, "k", copper(&Index::k), Unit::None, "Absorption, the imaginary index; copper's unless given."),
    param(&Metal::roughness, "roughness", 0.01f, Unit::None, "Roughness in both directions; see remaproughness.",
          kRoughness),
    param(&Metal::uroughness, "uroughness", Unit::None, "Roughness along u, instead of roughness.", kRoughness),
    param(&Metal::vroughness, "vroughness", Unit::None, "Roughness along v, instead of roughness.", kRoughness),
    param(&Metal::remaproughness, "remaproughness", true, Unit::None,
          "Roughness is in 0..1 and mapped to the microfacets' alpha; otherwise it is alpha."),
    bumpmap_param()};

}  // namespace
}  // namespace whit
