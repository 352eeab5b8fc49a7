// The surface lobes of a dielectric boundary, smooth or rough: what glass is, and what covers a scattering inside.
#pragma once

#include <vector>

#include "core/plugin/material.h"

namespace whit {

/// A material whose surface reflects and refracts by Fresnel's equations: delta lobes where both roughnesses are 0,
/// microfacets after Walter et al. (2007) elsewhere. Derived materials declare the parameters.
class DielectricSurface : public Material {
 public:
  Tex<RGB> Kr, Kt;
  Tex<float> uroughness, vroughness;
  bool remaproughness = true;

  std::vector<Ineffective> ineffective() const override;

 protected:
  /// Whether it has no lobes at all.
  bool is_nothing() const;

  /// Adds the lobes; a black Kr or Kt has none. `eta` is the index inside over that outside, at each point of s.
  void add_surface(const ShadingBatch& s, const float* eta, LobeSet& out) const;

 private:
  bool constant_roughness() const { return uroughness.is_constant() && vroughness.is_constant(); }
  bool may_be_smooth() const { return !constant_roughness() || (uroughness.value() == 0 && vroughness.value() == 0); }
  bool may_be_rough() const { return !constant_roughness() || uroughness.value() != 0 || vroughness.value() != 0; }
  bool isotropic() const { return constant_roughness() && uroughness.value() == vroughness.value(); }
  float* rough_points(const ShadingBatch& s) const;
};

}  // namespace whit
