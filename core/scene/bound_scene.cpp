#include "core/scene/bound_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "core/plugin/registry.h"

namespace whit {
namespace {

/// What to do with a statement whose plugin name is not known.
struct Unknown {
  Severity severity = Severity::Warning;
  const char* fallback = nullptr;  ///< The plugin to use instead, or null to leave the statement out.
  const char* consequence = "";    ///< Said in the remedy.
};

class Binder {
 public:
  Binder(const SceneDescription& description, const ValuePosition& value_position, Diagnostics& diagnostics,
         bool with_textures)
      : description_(description),
        value_position_(value_position),
        diagnostics_(diagnostics),
        with_textures_(with_textures) {
    scene_.description = &description;
  }

  BoundScene run() {
    bind_textures();
    bind_materials();
    bind_options();
    for (const auto& light : description_.lights) {
      scene_.lights.push_back(
          bind_entity<Light>(light, "light", {Severity::Warning, nullptr, "the light is left out"}));
      if (auto& l = scene_.lights.back().plugin) l->light_to_world = transform(light.transform).start;
    }
    for (const auto& light : description_.area_lights) {
      scene_.area_lights.push_back(
          bind_entity<AreaLight>(light, "area light", {Severity::Warning, nullptr, "the emission is left out"}));
    }
    for (const auto& shape : description_.shapes) bind_shape(shape);
    return std::move(scene_);
  }

 private:
  TransformPair transform(int i) const { return description_.transforms[static_cast<size_t>(i)]; }

  BindContext context(const Entity& entity, const std::string& name, std::vector<TextureUse>* used_textures) {
    BindContext ctx;
    ctx.diagnostics = &diagnostics_;
    ctx.statement = entity.where;
    ctx.statement_name = name;
    ctx.folder = description_.folder;
    ctx.value_position = value_position_;
    // What a texture is made of is its own business, also where nobody is to use it.
    ctx.with_textures = with_textures_ || binding_textures_;
    ctx.float_texture = [this, used_textures](int i, const std::string& parameter) {
      if (used_textures) used_textures->push_back({parameter, i});
      return std::dynamic_pointer_cast<Texture<float>>(scene_.textures[static_cast<size_t>(i)].plugin);
    };
    ctx.spectrum_texture = [this, used_textures](int i, const std::string& parameter) {
      if (used_textures) used_textures->push_back({parameter, i});
      return std::dynamic_pointer_cast<Texture<RGB>>(scene_.textures[static_cast<size_t>(i)].plugin);
    };
    return ctx;
  }

  const PluginInfo* find(const Entity& entity, const std::string& category, const Unknown& unknown) {
    if (const PluginInfo* info = find_plugin(category, entity.plugin)) return info;
    std::string remedy = entity.plugin == "ptex"
                             ? "it needs the Ptex library, of which Debian 12 has no package; bake the "
                               "texture to a picture and use \"imagemap\""
                             : did_you_mean(entity.plugin, plugin_names(category));
    if (unknown.severity == Severity::Warning) {
      if (!remedy.empty()) remedy += ' ';
      remedy += unknown.consequence;
    }
    diagnostics_.add({unknown.severity, ErrorClass::Scene, entity.plugin_at,
                      fmt::format("unknown {} \"{}\"", category, entity.plugin), remedy});
    return unknown.fallback ? find_plugin(category, unknown.fallback) : nullptr;
  }

  /// Binds one statement; `params` may differ from the entity's own (shape overrides), and must live as long as
  /// the scene: lists stay in it.
  template <class T, class Statement>
  Bound<T> bind_as(const Statement& entity, const PluginInfo& info, const ParameterList& params,
                   const std::vector<const PluginInfo*>& also_known = {}) {
    Bound<T> bound;
    bound.where = entity.where;
    std::shared_ptr<Plugin> plugin(info.make());
    BindContext ctx = context(entity, info.name, &bound.textures);
    if constexpr (std::is_same_v<Statement, MaterialDescription>) {
      ctx.named_material = [this, &entity, &bound](const std::string& name) {
        return named_material(entity, name, &bound.materials);
      };
    }
    const bool good = bind_parameters(info, *plugin, params, ctx, also_known);
    const size_t before = diagnostics_.all().size();
    if (good) plugin->check(diagnostics_, entity.where);
    const bool checked =
        std::none_of(diagnostics_.all().begin() + static_cast<ptrdiff_t>(before), diagnostics_.all().end(),
                     [](const Diagnostic& d) { return d.severity == Severity::Error; });
    if (!good || !checked) return bound;
    // Of these it is known what they ask for.
    if (info.category == Material::kCategory || binding_textures_) keep_what_is_read(*plugin, bound.textures);
    bound.plugin = std::dynamic_pointer_cast<T>(plugin);
    return bound;
  }

  /// Drops the textures that the plugin does not ask for.
  void keep_what_is_read(const Plugin& plugin, std::vector<TextureUse>& uses) const {
    // With textures switched off it is not seen who would ask for them.
    if (uses.empty() || (!with_textures_ && !binding_textures_)) return;
    const std::vector<const Plugin*> read = plugin.textures_read();
    std::erase_if(uses, [&](const TextureUse& use) {
      const Plugin* texture = scene_.textures[static_cast<size_t>(use.texture)].plugin.get();
      return std::find(read.begin(), read.end(), texture) == read.end();
    });
  }

  template <class T>
  Bound<T> bind_entity(const Entity& entity, const std::string& category, const Unknown& unknown) {
    const PluginInfo* info = find(entity, category, unknown);
    if (!info) return Bound<T>{nullptr, entity.where, {}, {}};
    // A fallback plugin does not know the parameters of the one that was meant.
    static const ParameterList none;
    const bool meant = info == find_plugin(category, entity.plugin);
    return bind_as<T>(entity, *info, meant ? entity.params : none);
  }

  /// An option statement, or the default plugin where the file has none.
  template <class T>
  Bound<T> bind_option(const Entity& entity, const std::string& category, const char* default_plugin,
                       const Unknown& unknown) {
    if (!entity.plugin.empty() || entity.where.known()) return bind_entity<T>(entity, category, unknown);
    Entity implied;
    implied.plugin = default_plugin;
    return bind_entity<T>(implied, category, {Severity::Error, nullptr, ""});
  }

  void bind_options() {
    scene_.camera = bind_option<Camera>(description_.camera, "camera", "perspective", {Severity::Error, nullptr, ""});
    scene_.film = bind_option<Film>(description_.film, "film", "image", {Severity::Error, nullptr, ""});
    scene_.filter = bind_option<Filter>(description_.filter, "filter", "box",
                                        {Severity::Warning, "box", "a box filter is used instead"});
    bind_sampler();
    bind_integrator();
  }

  /// Those of the parameters that another plugin understands as well.
  const ParameterList& keep_only(const ParameterList& params, const std::vector<std::string>& names) {
    ParameterList& kept = scene_.own_params.emplace_back();
    for (const Parameter& p : params) {
      if (std::find(names.begin(), names.end(), p.name) != names.end()) kept.push_back(p);
    }
    return kept;
  }

  /// A sampler we do not have is replaced by halton at the same number of samples.
  void bind_sampler() {
    const Entity& entity = description_.sampler;
    if (entity.plugin.empty() || find_plugin("sampler", entity.plugin)) {
      scene_.sampler = bind_option<Sampler>(entity, "sampler", "sobol", {});
      return;
    }
    const PluginInfo* halton =
        find(entity, "sampler", {Severity::Warning, "halton", "halton is used instead, at the same number of samples"});
    scene_.sampler = bind_as<Sampler>(entity, *halton, keep_only(entity.params, {"pixelsamples"}));
  }

  /// Every integrator of pbrt's is rendered as Whitted's, which is said once; maxdepth is kept.
  void bind_integrator() {
    const Entity& entity = description_.integrator;
    if (entity.plugin.empty() || find_plugin("integrator", entity.plugin)) {
      scene_.integrator = bind_option<Integrator>(entity, "integrator", "whitted", {});
      return;
    }
    static const std::vector<std::string> pbrt = {"directlighting",  "path", "volpath", "bdpt", "mlt", "sppm",
                                                  "ambientocclusion"};
    const bool known = std::find(pbrt.begin(), pbrt.end(), entity.plugin) != pbrt.end();
    diagnostics_.warning(entity.plugin_at,
                         fmt::format("integrator \"{}\" {}", entity.plugin, known ? "is not simulated" : "is unknown"),
                         known ? "the picture is made with whitted: direct light, mirrors and refraction"
                               : "the picture is made with whitted" + did_you_mean(entity.plugin, pbrt));
    scene_.integrator = bind_as<Integrator>(entity, *find_plugin("integrator", "whitted"),
                                            keep_only(entity.params, {"maxdepth", "pixelbounds"}));
  }

  void bind_textures() {
    binding_textures_ = true;
    for (const auto& t : description_.textures) {
      scene_.textures.push_back(
          bind_entity<Plugin>(t, t.spectrum ? "spectrum texture" : "float texture", {Severity::Error, nullptr, ""}));
      const auto& plugin = scene_.textures.back().plugin;
      const Mat4d to_world = transform(t.transform).start;
      if (auto f = std::dynamic_pointer_cast<Texture<float>>(plugin)) f->texture_to_world = to_world;
      if (auto s = std::dynamic_pointer_cast<Texture<RGB>>(plugin)) s->texture_to_world = to_world;
    }
    binding_textures_ = false;
  }

  void bind_materials() {
    for (const auto& m : description_.materials) {
      const PluginInfo* info = find(m, "material", {Severity::Warning, "matte", "matte is used instead"});
      const bool meant = info == find_plugin("material", m.plugin);
      scene_.materials.push_back(bind_as<Material>(m, *info, meant ? m.params : known_params(m.params, *info)));
    }
  }

  /// What a plugin understands of the parameters of the one that was meant.
  const ParameterList& known_params(const ParameterList& params, const PluginInfo& info) {
    std::vector<std::string> names;
    for (const ParamSpec& spec : info.params) names.push_back(spec.name);
    return keep_only(params, names);
  }

  std::shared_ptr<Material> named_material(const MaterialDescription& statement, const std::string& name,
                                           std::vector<int>* used) {
    for (const auto& [known, index] : statement.named) {
      if (known == name && static_cast<size_t>(index) < scene_.materials.size()) {
        used->push_back(index);
        return scene_.materials[static_cast<size_t>(index)].plugin;
      }
    }
    return nullptr;
  }

  void bind_shape(const ShapeDescription& shape) {
    scene_.shape_material.push_back(shape.material);
    const PluginInfo* info = find(shape, "shape", {Severity::Warning, nullptr, "the shape is left out"});
    if (!info) {
      scene_.shapes.push_back({nullptr, shape.where, {}, {}});
      return;
    }
    const auto& material = description_.materials[static_cast<size_t>(shape.material)];
    const PluginInfo* material_info = find_plugin("material", material.plugin);
    if (!material_info) material_info = find_plugin("material", "matte");
    scene_.shapes.push_back(bind_as<Shape>(shape, *info, shape.params, {material_info}));
    override_material(shape, *info, material, *material_info);
  }

  /// Parameters of a shape that its material knows (and the shape does not) make a material of its own. As in pbrt
  /// they go before the material's, be these values or textures.
  void override_material(const ShapeDescription& shape, const PluginInfo& shape_info,
                         const MaterialDescription& material, const PluginInfo& material_info) {
    const auto overrides = [&](const Parameter& p) {
      const ParamSpec* spec = material_info.find_param(p.name);
      return spec && std::count(spec->accepts.begin(), spec->accepts.end(), p.type) > 0 &&
             !shape_info.find_param(p.name);
    };
    if (std::none_of(shape.params.begin(), shape.params.end(), overrides)) return;
    ParameterList& merged = scene_.own_params.emplace_back();
    std::copy_if(shape.params.begin(), shape.params.end(), std::back_inserter(merged), overrides);
    std::copy_if(material.params.begin(), material.params.end(), std::back_inserter(merged), [&](const Parameter& p) {
      return std::none_of(shape.params.begin(), shape.params.end(),
                          [&](const Parameter& o) { return o.name == p.name && overrides(o); });
    });
    // The material's own problems have been reported at its statement; only the shape's are news.
    Diagnostics all;
    std::swap(all, diagnostics_);
    auto bound = bind_as<Material>(material, material_info, merged);
    std::swap(all, diagnostics_);
    for (const Diagnostic& d : all.all()) {
      if (d.where.file == shape.where.file && d.where.offset >= shape.where.offset) diagnostics_.add(d);
    }
    scene_.shape_material.back() = static_cast<int>(scene_.materials.size());
    scene_.materials.push_back(std::move(bound));
  }

  const SceneDescription& description_;
  const ValuePosition& value_position_;
  Diagnostics& diagnostics_;
  const bool with_textures_;
  bool binding_textures_ = false;
  BoundScene scene_;
};

}  // namespace

const AreaLight* BoundScene::emission_of(const ShapeDescription& shape) const {
  if (shape.area_light < 0) return nullptr;
  const AreaLight* light = area_lights[static_cast<size_t>(shape.area_light)].plugin.get();
  return light && !is_black(light->radiance()) ? light : nullptr;
}

BoundScene bind_scene(const SceneDescription& description, const ValuePosition& value_position,
                      Diagnostics& diagnostics, bool with_textures) {
  return Binder(description, value_position, diagnostics, with_textures).run();
}

}  // namespace whit
