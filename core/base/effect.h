// The effects a scene can call for: their names, what each brings into the render, and which of them a build knows.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <vector>

namespace whit {

/// What can be simulated or left alone. A stage exists in the render loop only when an effect needs it.
enum class Effect : uint8_t {
  Diffuse,            ///< Lobes that scatter to all sides: Lambert, Oren-Nayar, the diffuse lobes of Disney's BSDF.
  Glossy,             ///< Rough lobes: microfacets, hair, tables.
  Reflection,         ///< Perfect mirrors: rays spawned in the mirror direction.
  Refraction,         ///< Perfectly smooth transmission: rays spawned in the refracted direction.
  AreaLights,         ///< Surfaces that emit.
  EnvironmentLights,  ///< Lights at infinity that rays see which leave the scene.
  DeltaLights,        ///< Points and directions, which no ray meets by chance.
  Shadows,            ///< Whether something is between a surface and a light.
  Textures,           ///< Parameters that change over a surface.
  TextureFiltering,   ///< Textures averaged over the footprint of a sample.
  Bump,               ///< Normals tilted by bump and normal maps.
  Alpha,              ///< Surfaces cut out by a texture, from sight or from shadows.
  MotionBlur,         ///< Things that move while the shutter is open.
  DepthOfField,       ///< A lens with an area.
  Instancing,         ///< Objects that are placed.
  Interfaces,         ///< Surfaces without a material, which rays pass.
  Indirect,           ///< Light that came by way of other surfaces that scatter: paths.
  kCount
};
inline constexpr unsigned kEffects = static_cast<unsigned>(Effect::kCount);

/// A set of effects.
struct EffectSet {
  uint32_t bits = 0;
  constexpr EffectSet() = default;
  constexpr EffectSet(std::initializer_list<Effect> list) {
    for (Effect e : list) add(e);
  }
  static constexpr EffectSet all() {
    EffectSet s;
    s.bits = (1u << kEffects) - 1;
    return s;
  }
  constexpr void add(Effect e) { bits |= 1u << static_cast<unsigned>(e); }
  constexpr void remove(Effect e) { bits &= ~(1u << static_cast<unsigned>(e)); }
  constexpr bool has(Effect e) const { return ((bits >> static_cast<unsigned>(e)) & 1u) != 0; }
  constexpr bool empty() const { return bits == 0; }
  constexpr EffectSet& operator|=(const EffectSet& o) {
    bits |= o.bits;
    return *this;
  }
  constexpr bool operator==(const EffectSet&) const = default;
};
constexpr EffectSet operator|(EffectSet a, const EffectSet& b) { return a |= b; }
constexpr EffectSet operator-(EffectSet a, const EffectSet& b) {
  a.bits &= ~b.bits;
  return a;
}

constexpr EffectSet operator&(EffectSet a, const EffectSet& b) {
  a.bits &= b.bits;
  return a;
}

/// Calls f(effect) for every effect of a set, in order.
template <class F>
void for_effects(const EffectSet& set, const F& f) {
  for (unsigned e = 0; e < kEffects; ++e) {
    if (set.has(static_cast<Effect>(e))) f(static_cast<Effect>(e));
  }
}

/// Effects whose code this build lacks: CMake's WHIT_COMPILE_OUT. tools/effect-price compares such builds with whole
/// ones, to show that what a scene does not call for costs nothing.
#ifdef WHIT_COMPILED_OUT
inline constexpr EffectSet kCompiledOut = [] {
  using enum Effect;
  return EffectSet{WHIT_COMPILED_OUT};
}();
#else
inline constexpr EffectSet kCompiledOut{};
#endif
constexpr bool compiled_in(Effect e) { return !kCompiledOut.has(e); }
/// Differential rays serve these two, instances the other two.
inline constexpr bool kKnowsDifferentials = compiled_in(Effect::TextureFiltering) || compiled_in(Effect::Bump);
inline constexpr bool kKnowsInstances = compiled_in(Effect::Instancing) || compiled_in(Effect::MotionBlur);

/// What an effect brings into the render, for `whit explain` and the docs.
struct EffectInfo {
  const char* name;             ///< As --without takes it: "depth-of-field".
  const char* doc;              ///< What it is.
  const char* off;              ///< What a picture shows without it.
  const char* stages;           ///< What is done for it: functions or classes of core/render and core/accel.
  const char* dimensions = "";  ///< Sample dimensions it draws; "" for none.
  int ray_bytes = 0;            ///< Carried with every ray from depth to depth.
  int point_bytes = 0;          ///< Computed at every surface point, in the worker's memory.
};
const EffectInfo& effect_info(Effect e);
inline const char* effect_name(Effect e) { return effect_info(e).name; }

/// The effects of a list of names, "bump,motion-blur"; on a name that is none, `unknown` is set to it.
EffectSet parse_effects(const std::string& names, std::string& unknown);
/// All names, for messages.
std::vector<std::string> effect_names();

}  // namespace whit
