// The closed set of scattering lobes. A material says which lobes its surface has and with which parameters;
// the renderer evaluates lobe by lobe over the batch (core/batch/lobe_eval.h).
#pragma once

#include <cstdint>

#include "core/batch/lanes.h"
#include "core/batch/shading.h"

namespace whit {

enum class LobeType : uint8_t {
  LambertReflection,       ///< weight / pi
  LambertTransmission,     ///< weight / pi, other side
  OrenNayar,               ///< param a, b: the A and B of Oren and Nayar 1994
  MicrofacetReflection,    ///< Torrance-Sparrow, Trowbridge-Reitz; a, b: alpha along dpdu, dpdv
  MicrofacetTransmission,  ///< Walter et al. 2007; a, b: alpha; eta
  SpecularReflection,      ///< Delta, mirror direction
  SpecularTransmission,    ///< Delta, refracted direction; radiance scaled by (eta_i/eta_t)^2
};

/// How a lobe's reflectance depends on the angle.
enum class FresnelType : uint8_t {
  One,         ///< Reflects everything at every angle (mirror).
  Dielectric,  ///< Exact unpolarised Fresnel; `eta` is the index inside over the index outside.
};

constexpr bool is_specular(LobeType t) {
  return t == LobeType::SpecularReflection || t == LobeType::SpecularTransmission;
}
constexpr bool is_transmission(LobeType t) {
  return t == LobeType::LambertTransmission || t == LobeType::MicrofacetTransmission ||
         t == LobeType::SpecularTransmission;
}

/// One lobe over n points. A lane with a black weight does not have the lobe.
struct Lobe {
  LobeType type = LobeType::LambertReflection;
  FresnelType fresnel = FresnelType::One;
  RGBLanes weight;             ///< Reflectance or transmittance scale, >= 0.
  const float* a = nullptr;    ///< First shape parameter, see LobeType.
  const float* b = nullptr;    ///< Second shape parameter.
  const float* eta = nullptr;  ///< Relative index of refraction, inside over outside.
};

/// The lobes of one run of points of one material.
struct LobeSet {
  static constexpr int kMax = 8;
  int count = 0;
  Lobe lobes[kMax];
  const float* eta = nullptr;  ///< The BSDF's relative index for ray differentials; null means 1.
  void add(const Lobe& lobe) {
    if (count < kMax) lobes[count++] = lobe;
  }
};

}  // namespace whit
