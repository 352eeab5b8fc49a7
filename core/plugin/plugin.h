// What every plugin has in common: it is bound cheaply, says which effects it calls for, and is read and prepared
// (files read, tables built) only when the plan keeps it.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/base/attachment.h"
#include "core/base/diagnostics.h"
#include "core/base/effect.h"
#include "core/base/mesh_attributes.h"
#include "core/base/render_space.h"
#include "core/base/stopwatch.h"

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
  MeshAttributes attributes;  ///< Of meshes, which are asked for.
  /// What reading pictures takes is added here, or nowhere if null. Lights alone do, which are prepared one by one.
  Elapsed* reading_pictures = nullptr;
};

/// A parameter that says nothing beside the others, as they are bound.
struct Ineffective {
  const char* parameter;
  const char* why;               ///< "both roughnesses are 0, so the surface is smooth".
  const char* unless = nullptr;  ///< Where this one is given too, the author knows.
};

/// Base of all plugins. Life: constructed with defaults, parameters bound, check(), effects(), and, when the
/// plan keeps it, read() and prepare().
class Plugin {
 public:
  virtual ~Plugin() = default;

  /// What its statement has beside parameters, before check(). Only plugins that models bring statements of take it.
  virtual void attach(std::shared_ptr<const Attachment>) {}

  /// Checks that go across parameters ("number of indices is not a multiple of three"); reads no file.
  virtual void check(Diagnostics&, SourcePos /*statement*/) {}

  /// The effects the bound parameters call for, but for those of the textures they are, which have their own.
  virtual EffectSet effects() const { return {}; }

  /// The parameters that would have no effect, were they given: those that are, `whit check` finds. After binding.
  virtual std::vector<Ineffective> ineffective() const { return {}; }

  /// Of a texture: what it asks of meshes, without the textures that it is made of. After binding.
  virtual MeshAttributes attributes_read() const { return {}; }

  /// The textures of its parameters that it ever evaluates. After binding.
  virtual std::vector<const Plugin*> textures_read() const { return {}; }

 protected:
  /// Reads files that decide whether the plugin can be used at all. Returns false after reporting an error.
  virtual bool read(Diagnostics&, SourcePos /*statement*/) { return true; }

  /// Reads other files and builds tables. Returns false after reporting an error.
  virtual bool prepare(const PrepareContext&) { return true; }

 private:
  template <class Pointer>
  friend Pointer after_reading(Pointer, Diagnostics&, SourcePos);
  template <class Pointer>
  friend Pointer prepared(Pointer, const PrepareContext&);
};

/// The plugin after read(), or nothing when that failed (reported): nobody holds a plugin that could not be read.
template <class Pointer>
[[nodiscard]] Pointer after_reading(Pointer plugin, Diagnostics& diagnostics, SourcePos statement) {
  if (plugin && !static_cast<Plugin&>(*plugin).read(diagnostics, statement)) plugin.reset();
  return plugin;
}

/// The plugin after prepare(), or nothing when that failed (reported). There is no other way to prepare a plugin.
template <class Pointer>
[[nodiscard]] Pointer prepared(Pointer plugin, const PrepareContext& context) {
  if (plugin && !static_cast<Plugin&>(*plugin).prepare(context)) plugin.reset();
  return plugin;
}

}  // namespace whit
