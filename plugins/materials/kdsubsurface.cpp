// A dielectric boundary over a medium given by its diffuse reflectance and mean free path instead of its scattering
// coefficients (Jensen and Buhler, A Rapid Hierarchical Rendering Technique for Translucent Materials, 2002). Only the
// boundary is simulated: the integrator follows no light inside, so the medium's parameters change nothing.
#include "core/plugin/registry.h"
#include "plugins/shared/dielectric_surface.h"
#include "plugins/shared/material_inputs.h"

namespace whit {
namespace {

struct KdSubsurface : DielectricSurface {
  Tex<RGB> Kd, mfp;
  float eta = 0, scale = 0, g = 0;

  bool scatters_below() const override { return true; }

  void lobes(const ShadingBatch& s, LobeSet& out) const override {
    if (!is_nothing()) add_surface(s, filled(s, eta), out);
  }
};

const Register<KdSubsurface> kdsubsurface{
    "kdsubsurface",
    "A dielectric boundary over a medium of a given colour; the boundary alone is simulated.",
    param(&KdSubsurface::Kr, "Kr", RGB(1.0f), Unit::None, "Scale of the reflection."),
    param(&KdSubsurface::Kt, "Kt", RGB(1.0f), Unit::None, "Scale of the transmission."),
    param(&KdSubsurface::uroughness, "uroughness", 0.0f, Unit::None, "Roughness along u; 0 in both is smooth.",
          kRoughness),
    param(&KdSubsurface::vroughness, "vroughness", 0.0f, Unit::None, "Roughness along v.", kRoughness),
    param(&KdSubsurface::eta, "eta", 1.33f, Unit::None, "Index of refraction inside over that outside.", kPositive),
    param(&KdSubsurface::remaproughness, "remaproughness", true, Unit::None,
          "Roughness is in 0..1 and mapped to the microfacets' alpha; otherwise it is alpha."),
    param(&KdSubsurface::Kd, "Kd", RGB(0.5f), Unit::None, "Diffuse reflectance of the medium; not simulated."),
    param(&KdSubsurface::mfp, "mfp", RGB(1.0f), Unit::Length, "Mean free path in the medium; not simulated."),
    param(&KdSubsurface::scale, "scale", 1.0f, Unit::None, "Factor of the mean free path; not simulated."),
    param(&KdSubsurface::g, "g", 0.0f, Unit::None, "Asymmetry of the scattering; not simulated."),
    bumpmap_param()};

}  // namespace
}  // namespace whit
