// A scene whose statements have become plugins with their parameters bound and checked: cheap, nothing read yet.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <vector>

#include "core/plugin/camera.h"
#include "core/plugin/film.h"
#include "core/plugin/filter.h"
#include "core/plugin/integrator.h"
#include "core/plugin/light.h"
#include "core/plugin/material.h"
#include "core/plugin/sampler.h"
#include "core/plugin/shape.h"
#include "parser/scene_description.h"

namespace whit {

struct PluginInfo;

/// What samples and integrates a world: the plugin of its statement, the default where the file has none, or the one
/// that stands in where nobody has registered the one that is named.
const PluginInfo& sampler_in_force(const SceneDescription& world);
const PluginInfo& integrator_in_force(const SceneDescription& world);

/// A texture that a parameter names.
struct TextureUse {
  std::string parameter;
  int texture = 0;  ///< Index into SceneDescription::textures.
};

/// A plugin made by a statement, and what it refers to: the textures that it asks for, and named materials (indices
/// into BoundScene::materials).
template <class T>
struct Bound {
  std::shared_ptr<T> plugin;  ///< Null when the statement is unusable (reported).
  SourcePos where;
  std::vector<TextureUse> textures;
  std::vector<int> materials;
  bool replaced = false;  ///< It is not the plugin that the statement names, which nobody has.
};

/// What was said of a statement. Whether it matters is known when the scene is planned: core/scene/problems.h.
struct Problem {
  enum class Of : uint8_t { Options, Texture, Material, Light, AreaLight, Shape, Transform };
  Diagnostic diagnostic;
  Of of = Of::Options;
  size_t index = 0;     ///< Of the statement among those of its kind.
  bool unread = false;  ///< It is of a parameter that the plugin does not ask for.
};

struct BoundScene {
  const SceneDescription* description = nullptr;
  Bound<Camera> camera;
  Bound<Film> film;
  Bound<Filter> filter;
  Bound<Sampler> sampler;
  Bound<Integrator> integrator;
  std::vector<Bound<Plugin>> textures;  ///< Texture<float> or Texture<RGB>, by TextureDescription::spectrum.
  std::vector<Bound<Material>> materials;
  std::vector<Bound<Light>> lights;
  std::vector<Bound<AreaLight>> area_lights;
  std::vector<Bound<Shape>> shapes;
  /// Index into materials of each shape; beyond the description's for shapes that override parameters.
  std::vector<int> shape_material;
  /// What a shape radiates; null for nothing, be it black.
  const AreaLight* emission_of(const ShapeDescription& shape) const;
  std::vector<Problem> problems;         ///< Found while binding.
  std::deque<ParameterList> own_params;  ///< Lists made while binding, kept for the plugins that refer to them.
};

/// The place of the i-th value of a parameter; from parser/lexer.h.
using ValuePosition = std::function<SourcePos(const Parameter&, size_t)>;

/// Makes and binds the plugins of every statement, live or not, so that every mistake is found. Problems go
/// to `diagnostics`; with errors, the plugins concerned are null and the rest is usable.
/// `description` must outlive the result (large lists stay in it). Without textures, parameters keep their defaults
/// where they name one that is not constant.
BoundScene bind_scene(const SceneDescription& description, const ValuePosition& value_position,
                      Diagnostics& diagnostics, bool with_textures = true);

}  // namespace whit
