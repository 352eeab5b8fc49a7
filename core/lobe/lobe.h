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

/// What a lobe is: lobe_types.inc says what the parameters of each type are, row_of() in core/lobe/table.h all else.
enum class LobeType : uint8_t {
#define LOBE(name) name,
#include "core/lobe/lobe_types.inc"
#undef LOBE
};

/// How a lobe's reflectance depends on the angle.
enum class FresnelType : uint8_t {
  One,         ///< The weight says it all: a mirror, or a boundary that lets everything through.
  Dielectric,  ///< Exact unpolarised Fresnel; `eta` is the index inside over the index outside.
  Conductor,   ///< Exact unpolarised Fresnel of a metal; colour1 + i colour2 is the relative index. Microfacets only.
};

/// Whether the lobe scatters to a single direction, which no given pair of directions meets.
bool is_specular(LobeType type);
/// The effect that a lobe is part of; sheens are diffuse and coats glossy, as in pbrt-v3.
Effect effect_of(LobeType type);

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

/// The tangents of a run's points: with ns, an orthonormal basis. Null when no lobe needs them.
struct LobeFrame {
  Vec3Lanes ss, ts;  ///< Along dpdu (any direction when dpdu is 0), and cross(ns, ss).
};

}  // namespace whit
