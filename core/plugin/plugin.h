// What every plugin has in common: it is bound cheaply, says which effects it calls for, and is prepared
// (files read, tables built) only when the plan keeps it.
#pragma once

#include <cstdint>
#include <string>

#include "core/base/diagnostics.h"
#include "core/base/render_space.h"

namespace whit {

class TextureStore;

/// The effects a scene can call for. A stage exists in the render loop only when an effect needs it.
enum class Effect : uint8_t {
  AreaLight,
  EnvironmentLight,
  DeltaLight,
  Mirror,
  Refraction,
  Glossy,
  TextureFiltering,
  Bump,
  AlphaMask,
  MotionBlur,
  DepthOfField,
  Instancing,
  Interface,
  kCount
};
const char* effect_name(Effect e);

/// A set of effects.
struct EffectSet {
  uint32_t bits = 0;
  EffectSet() = default;
  EffectSet(std::initializer_list<Effect> list) {
    for (Effect e : list) add(e);
  }
  void add(Effect e) { bits |= 1u << static_cast<unsigned>(e); }
  bool has(Effect e) const { return (bits >> static_cast<unsigned>(e)) & 1u; }
  EffectSet& operator|=(const EffectSet& o) {
    bits |= o.bits;
    return *this;
  }
};

/// What preparing a plugin may use.
struct PrepareContext {
  Diagnostics* diagnostics = nullptr;
  SourcePos statement;  ///< The plugin's statement, for messages.
  TextureStore* textures = nullptr;
  RenderSpace space;
  double scene_radius = 1;  ///< Render space: radius of a sphere around the origin that holds all geometry.
  int samples_per_pixel = 1;
};

/// Base of all plugins. Life: constructed with defaults, parameters bound, check(), effects(), and, when the
/// plan keeps it, prepare().
class Plugin {
 public:
  virtual ~Plugin() = default;

  /// Checks that go across parameters ("number of indices is not a multiple of three"); reads no file.
  virtual void check(Diagnostics&, SourcePos /*statement*/) {}

  /// The effects the bound parameters call for.
  virtual EffectSet effects() const { return {}; }

  /// Reads files and builds tables. Returns false after reporting an error.
  virtual bool prepare(const PrepareContext&) { return true; }
};

}  // namespace whit
