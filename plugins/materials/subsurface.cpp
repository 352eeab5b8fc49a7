// A dielectric boundary over a medium that scatters light below the surface (Jensen et al., A Practical Model for
// Subsurface Light Transport, 2001). Only the boundary is simulated: the integrator follows no light inside, so the
// medium's parameters are accepted and change nothing.
#include <algorithm>
#include <string>
#include <vector>

#include "core/plugin/registry.h"
#include "plugins/shared/dielectric_surface.h"
#include "plugins/shared/material_inputs.h"

namespace whit {
namespace {

/// The media whose coefficients pbrt-v3 knows by name, so that a misspelt one is found here too.
const std::vector<std::string> kMedia = {"Apple",
                                         "Chicken1",
                                         "Chicken2",
                                         "Cream",
                                         "Ketchup",
                                         "Marble",
                                         "Potato",
                                         "Skimmilk",
                                         "Skin1",
                                         "Skin2",
                                         "Spectralon",
                                         "Wholemilk",
                                         "Lowfat Milk",
                                         "Reduced Milk",
                                         "Regular Milk",
                                         "Espresso",
                                         "Mint Mocha Coffee",
                                         "Lowfat Soy Milk",
                                         "Regular Soy Milk",
                                         "Lowfat Chocolate Milk",
                                         "Regular Chocolate Milk",
                                         "Coke",
                                         "Pepsi",
                                         "Sprite",
                                         "Gatorade",
                                         "Chardonnay",
                                         "White Zinfandel",
                                         "Merlot",
                                         "Budweiser Beer",
                                         "Coors Light Beer",
                                         "Clorox",
                                         "Apple Juice",
                                         "Cranberry Juice",
                                         "Grape Juice",
                                         "Ruby Grapefruit Juice",
                                         "White Grapefruit Juice",
                                         "Shampoo",
                                         "Strawberry Shampoo",
                                         "Head & Shoulders Shampoo",
                                         "Lemon Tea Powder",
                                         "Orange Powder",
                                         "Pink Lemonade Powder",
                                         "Cappuccino Powder",
                                         "Salt Powder",
                                         "Sugar Powder",
                                         "Suisse Mocha Powder",
                                         "Pacific Ocean Surface Water"};

struct Subsurface : DielectricSurface {
  std::string name;
  Tex<RGB> sigma_a, sigma_s;
  float eta = 0, scale = 0, g = 0;

  void check(Diagnostics& diagnostics, SourcePos statement) override {
    if (name.empty() || std::find(kMedia.begin(), kMedia.end(), name) != kMedia.end()) return;
    diagnostics.warning(statement, "no medium is called \"" + name + '"', did_you_mean(name, kMedia));
  }

  bool scatters_below() const override { return true; }

  void lobes(const ShadingBatch& s, LobeSet& out) const override {
    if (!is_nothing()) add_surface(s, filled(s, eta), out);
  }
};

const Register<Subsurface> subsurface{
    "subsurface",
    "A dielectric boundary over a scattering medium; the boundary alone is simulated.",
    param(&Subsurface::Kr, "Kr", RGB(1.0f), Unit::None, "Scale of the reflection."),
    param(&Subsurface::Kt, "Kt", RGB(1.0f), Unit::None, "Scale of the transmission."),
    param(&Subsurface::uroughness, "uroughness", 0.0f, Unit::None, "Roughness along u; 0 in both is smooth.",
          kRoughness),
    param(&Subsurface::vroughness, "vroughness", 0.0f, Unit::None, "Roughness along v.", kRoughness),
    param(&Subsurface::eta, "eta", 1.33f, Unit::None, "Index of refraction inside over that outside.", kPositive),
    param(&Subsurface::remaproughness, "remaproughness", true, Unit::None,
          "Roughness is in 0..1 and mapped to the microfacets' alpha; otherwise it is alpha."),
    param(&Subsurface::name, "name", "", Unit::None, "A medium known by name, such as \"Skin1\"; not simulated."),
    param(&Subsurface::sigma_a, "sigma_a", RGB(0.0011f, 0.0024f, 0.014f), Unit::None,
          "Absorption of the medium per millimetre; not simulated."),
    param(&Subsurface::sigma_s, "sigma_s", RGB(2.55f, 3.21f, 3.77f), Unit::None,
          "Scattering of the medium per millimetre; not simulated."),
    param(&Subsurface::scale, "scale", 1.0f, Unit::None, "Factor of both coefficients; not simulated."),
    param(&Subsurface::g, "g", 0.0f, Unit::None, "Asymmetry of the scattering; not simulated."),
    bumpmap_param()};

}  // namespace
}  // namespace whit
