// What every plugin has in common: it is bound cheaply, says which effects it calls for, and is prepared
// (files read, tables built) only when the plan keeps it.
#pragma once

#include <vector>

#include "core/base/diagnostics.h"
#include "core/base/render_space.h"
#include "core/plugin/effect.h"

namespace whit {

class TextureStore;

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

  /// The effects the bound parameters call for, but for those of the textures they are, which have their own.
  virtual EffectSet effects() const { return {}; }

  /// The textures of its parameters that it ever evaluates. After binding.
  virtual std::vector<const Plugin*> textures_read() const { return {}; }

  /// Reads files and builds tables. Returns false after reporting an error.
  virtual bool prepare(const PrepareContext&) { return true; }
};

}  // namespace whit
