// The closed set of scattering lobes. A material says which lobes its surface has and with which parameters;
// the renderer evaluates lobe by lobe over the batch (core/lobe/eval.h).
#pragma once

#include <cstdint>
#include <memory>

#include "core/base/effect.h"
#include "core/batch/arena.h"
#include "core/batch/lanes.h"
#include "core/batch/shading.h"

namespace whit {

struct FourierTable;

enum class LobeType : uint8_t {
  LambertReflection,       ///< weight / pi
  LambertTransmission,     ///< weight / pi, other side
  OrenNayar,               ///< param a, b: the A and B of Oren and Nayar 1994
  MicrofacetReflection,    ///< Torrance-Sparrow, Trowbridge-Reitz; a, b: alpha along dpdu, dpdv
  MicrofacetTransmission,  ///< Walter et al. 2007; a, b: alpha; eta
  FresnelBlend,            ///< Diffuse under a glossy coat, Ashikhmin-Shirley; colour1, colour2: Rd, Rs; a, b: alpha
  DisneyDiffuse,           ///< Burley 2015, see disney.cpp
  DisneyFakeSubsurface,    ///< a: roughness
  DisneyRetro,             ///< a: roughness
  DisneySheen,
  DisneyClearcoat,     ///< a: alpha of the coat
  DisneyReflection,    ///< As MicrofacetReflection; colour1: Schlick's R0, c: metallic, eta: of the dielectric part
  DisneyTransmission,  ///< As MicrofacetTransmission
  Hair,     ///< A fibre along dpdu, both sides; colour1: absorption; a: offset, b, c: widths, d: tilt, see hair.h
  Fourier,  ///< A tabulated BSDF, both sides
  SpecularReflection,    ///< Delta, mirror direction
  SpecularTransmission,  ///< Delta, refracted direction; radiance scaled by (eta_i/eta_t)^2
};

/// How a lobe's reflectance depends on the angle.
enum class FresnelType : uint8_t {
  One,         ///< Reflects everything at every angle (mirror).
  Dielectric,  ///< Exact unpolarised Fresnel; `eta` is the index inside over the index outside.
  Conductor,   ///< Exact unpolarised Fresnel of a metal; colour1 + i colour2 is the relative index. Microfacets only.
};

constexpr bool is_specular(LobeType t) {
  return t == LobeType::SpecularReflection || t == LobeType::SpecularTransmission;
}
constexpr bool is_transmission(LobeType t) {
  return t == LobeType::LambertTransmission || t == LobeType::MicrofacetTransmission ||
         t == LobeType::DisneyTransmission || t == LobeType::SpecularTransmission;
}

/// The effect that a lobe is part of; sheens are diffuse and coats glossy, as in pbrt-v3.
constexpr Effect effect_of(LobeType t) {
  switch (t) {
    case LobeType::SpecularReflection: return Effect::Reflection;
    case LobeType::SpecularTransmission: return Effect::Refraction;
    case LobeType::LambertReflection:
    case LobeType::LambertTransmission:
    case LobeType::OrenNayar:
    case LobeType::DisneyDiffuse:
    case LobeType::DisneyFakeSubsurface:
    case LobeType::DisneyRetro:
    case LobeType::DisneySheen: return Effect::Diffuse;
    default: return Effect::Glossy;
  }
}

/// One lobe over n points. A lane with a black weight does not have the lobe.
struct Lobe {
  LobeType type = LobeType::LambertReflection;
  FresnelType fresnel = FresnelType::One;
  RGBLanes weight;                      ///< Reflectance or transmittance scale, >= 0.
  const float* a = nullptr;             ///< First shape parameter, see LobeType.
  const float* b = nullptr;             ///< Second shape parameter.
  const float* c = nullptr;             ///< Third.
  const float* d = nullptr;             ///< Fourth.
  const float* eta = nullptr;           ///< Relative index of refraction, inside over outside.
  RGBLanes colour1, colour2;            ///< What the weight does not say, see LobeType and FresnelType.
  const FourierTable* table = nullptr;  ///< Of the Fourier lobe.
};

/// The lobes of one run of points of one material: any number, in memory of an arena. Copies share it.
class LobeSet {
 public:
  explicit LobeSet(Arena& arena) : arena_(&arena) {}

  void add(const Lobe& lobe) {
    if (count == capacity_) grow();
    lobes[count++] = lobe;
  }

  /// Drops the lobes of other effects.
  void keep(const EffectSet& effects) {
    int kept = 0;
    for (int i = 0; i < count; ++i) {
      if (effects.has(effect_of(lobes[i].type))) lobes[kept++] = lobes[i];
    }
    count = kept;
  }

  int count = 0;
  Lobe* lobes = nullptr;       ///< Moves when a lobe is added.
  const float* eta = nullptr;  ///< The BSDF's relative index for ray differentials; null means 1.

 private:
  /// Mixes of mixes have no limit, but nearly all surfaces have few lobes.
  void grow() {
    capacity_ = capacity_ == 0 ? 4 : 2 * capacity_;
    Lobe* const larger = arena_->alloc<Lobe>(capacity_);
    std::uninitialized_copy_n(lobes, count, larger);
    std::uninitialized_default_construct_n(larger + count, capacity_ - count);
    lobes = larger;
  }

  Arena* arena_;
  int capacity_ = 0;
};

}  // namespace whit
