#include "core/scene/bound_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "core/plugin/registry.h"

namespace whit {
namespace {

constexpr const char *kDefaultSampler = "sobol", *kStandInSampler = "halton";
constexpr const char *kDefaultIntegrator = "whitted", *kStandInIntegrator = "whitted";
/// Those of pbrt-v3 that we do not have, and what is nearest to them.
constexpr std::array<const char*, 4> kPbrtIntegrators = {"volpath", "bdpt", "mlt", "sppm"};
constexpr const char* kNearestIntegrator = "path";

bool is_pbrt_integrator(const std::string& name) {
  return std::find(kPbrtIntegrators.begin(), kPbrtIntegrators.end(), name) != kPbrtIntegrators.end();
}

/// Whether the file has such a statement: one that names "" names a plugin that nobody has.
bool is_given(const Entity& entity) { return !entity.plugin.empty() || entity.where.known(); }

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
    // There may be many, and a vector that grows takes three times as much for a moment.
    scene_.textures.reserve(description_.textures.size());
    scene_.materials.reserve(description_.materials.size());
    scene_.shapes.reserve(description_.shapes.size());
    scene_.shape_material.reserve(description_.shapes.size());
    bind_textures();
    bind_materials();
    bind_options();
    for (const auto& light : description_.lights) {
      begin(Problem::Of::Light, scene_.lights.size());
      scene_.lights.push_back(
          bind_entity<Light>(light, "light", {Severity::Warning, nullptr, "the light is left out"}));
      auto& l = scene_.lights.back().plugin;
      if (l) l->light_to_world = transform(light.transform).start;
      if (description_.is_singular(light.transform)) l.reset();
    }
    for (const auto& light : description_.area_lights) {
      begin(Problem::Of::AreaLight, scene_.area_lights.size());
      scene_.area_lights.push_back(
          bind_entity<AreaLight>(light, "area light", {Severity::Warning, nullptr, "the emission is left out"}));
    }
    for (const auto& shape : description_.shapes) {
      begin(Problem::Of::Shape, scene_.shapes.size());
      bind_shape(shape);
      if (description_.is_singular(shape.transform)) scene_.shapes.back().plugin.reset();
    }
    for (size_t i = 0; i < description_.singular.size(); ++i) {
      begin(Problem::Of::Transform, i);
      const auto& [statement, where] = description_.singular[i];
      report({Severity::Error, ErrorClass::Scene, where, statement + " makes a matrix that cannot be inverted",
              "nothing may be scaled to zero or infinity"});
    }
    for (const Problem& p : scene_.problems) diagnostics_.add(p.diagnostic);
    return std::move(scene_);
  }

 private:
  TransformPair transform(int i) const { return description_.transforms[static_cast<size_t>(i)]; }

  /// What is said from here on is of that statement.
  void begin(Problem::Of of, size_t index) { of_ = of, index_ = index; }
  void report(Diagnostic diagnostic, bool unread = false) {
    scene_.problems.push_back({std::move(diagnostic), of_, index_, unread});
  }

  BindContext context(const Entity& entity, const std::string& name, std::vector<TextureUse>* used_textures) {
    BindContext ctx;
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
    ctx.texture_hint = [this](const std::string& texture) {
      const auto found = description_.unknown_textures.find(texture);
      return found == description_.unknown_textures.end() ? Remedy() : found->second;
    };
    ctx.spectrum_texture = [this, used_textures](int i, const std::string& parameter) {
      if (used_textures) used_textures->push_back({parameter, i});
      return std::dynamic_pointer_cast<Texture<RGB>>(scene_.textures[static_cast<size_t>(i)].plugin);
    };
    return ctx;
  }

  const PluginInfo* find(const Entity& entity, const std::string& category, const Unknown& unknown) {
    if (const PluginInfo* info = find_plugin(category, entity.plugin)) return info;
    Remedy remedy = entity.plugin == "ptex"
                        ? Remedy(
                              "it needs the Ptex library, of which Debian 12 has no package; bake the "
                              "texture to a picture and use \"imagemap\"")
                        : suggestion(entity.plugin, plugin_names(category));
    if (unknown.severity == Severity::Warning) {
      if (!remedy.text.empty()) remedy.text += ' ';
      remedy.text += unknown.consequence;
    }
    report({unknown.severity,
            ErrorClass::Scene,
            entity.plugin_at,
            fmt::format("unknown {} \"{}\"", category, entity.plugin),
            remedy.text,
            {},
            false,
            remedy.slip});
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
    if constexpr (std::is_same_v<Statement, TextureDescription>) plugin->attach(entity.picture);
    if constexpr (std::is_same_v<Statement, ShapeDescription>) plugin->attach(entity.mesh);
    BindContext ctx = context(entity, info.name, &bound.textures);
    if constexpr (std::is_same_v<Statement, MaterialDescription>) {
      ctx.named_material = [this, &entity, &bound](const std::string& name, std::shared_ptr<Material>& found) {
        return find_material(entity, name, found, bound.materials);
      };
    }
    Diagnostics said;
    ctx.diagnostics = &said;
    // Of these it is known what they ask for.
    std::vector<MissingParameter> missing;
    if (info.category == Material::kCategory || binding_textures_) ctx.missing = &missing;
    bool good = bind_parameters(info, *plugin, params, ctx, also_known);
    if (good) good = check(*plugin, said, entity.where);
    if (!good) missing.clear();
    if (good && ctx.missing) good = find_what_is_read(*plugin, bound.textures, missing);
    const bool dark = gives_no_light(*plugin);
    for (size_t i = 0; i < said.all().size(); ++i) report(said.all()[i], dark || is_of_any(missing, i));
    if (good) bound.plugin = std::dynamic_pointer_cast<T>(plugin);
    return bound;
  }

  static bool check(Plugin& plugin, Diagnostics& said, SourcePos statement) {
    Diagnostics found;
    plugin.check(found, statement);
    said.append(found);
    return !found.has_errors();
  }

  /// Drops the textures that the plugin does not ask for, and from `missing` what it does ask for. False when there is
  /// such a parameter.
  bool find_what_is_read(const Plugin& plugin, std::vector<TextureUse>& uses,
                         std::vector<MissingParameter>& missing) const {
    if (missing.empty() && uses.empty()) return true;
    const std::vector<const Plugin*> read = plugin.textures_read();
    const auto is_read = [&](const Plugin* p) { return std::find(read.begin(), read.end(), p) != read.end(); };
    const size_t wanted = std::erase_if(missing, [&](const MissingParameter& m) { return is_read(m.stand_in.get()); });
    if (wanted > 0) return false;
    // With textures switched off it is not seen who would ask for them.
    if (!with_textures_ && !binding_textures_) return true;
    std::erase_if(uses, [&](const TextureUse& use) {
      return !is_read(scene_.textures[static_cast<size_t>(use.texture)].plugin.get());
    });
    return true;
  }

  /// Whether the i-th thing that was said is about one of the parameters.
  static bool is_of_any(const std::vector<MissingParameter>& parameters, size_t i) {
    return std::any_of(parameters.begin(), parameters.end(), [i](const MissingParameter& m) {
      return i >= m.first_problem && i < m.first_problem + m.problems;
    });
  }

  /// What is wrong with a light that is black by its other parameters is not seen.
  static bool gives_no_light(const Plugin& plugin) {
    if (const auto* light = dynamic_cast<const Light*>(&plugin)) return light->is_black();
    const auto* emission = dynamic_cast<const AreaLight*>(&plugin);
    return emission && is_black(emission->radiance());
  }

  template <class T, class Statement>
  Bound<T> bind_entity(const Statement& entity, const std::string& category, const Unknown& unknown) {
    const PluginInfo* info = find(entity, category, unknown);
    if (!info) return Bound<T>{nullptr, entity.where, {}, {}, false};
    // A fallback plugin does not know the parameters of the one that was meant.
    static const ParameterList none;
    const bool meant = info == find_plugin(category, entity.plugin);
    return bind_as<T>(entity, *info, meant ? entity.params : none);
  }

  /// An option statement, or the default plugin where the file has none.
  template <class T>
  Bound<T> bind_option(const Entity& entity, const std::string& category, const char* default_plugin,
                       const Unknown& unknown) {
    if (is_given(entity)) return bind_entity<T>(entity, category, unknown);
    Entity implied;
    implied.plugin = default_plugin;
    return bind_entity<T>(implied, category, {Severity::Error, nullptr, ""});
  }

  void bind_options() {
    begin(Problem::Of::Options, 0);
    scene_.camera = bind_option<Camera>(description_.camera, "camera", "perspective", {Severity::Error, nullptr, ""});
    scene_.film = bind_option<Film>(description_.film, "film", "image", {Severity::Error, nullptr, ""});
    scene_.filter = bind_option<Filter>(description_.filter, "filter", "box",
                                        {Severity::Warning, "box", "a box filter is used instead"});
    check_filter_width();
    bind_sampler();
    bind_integrator();
  }

  /// The film keeps sums of tiles of 16 x 16 pixels, each with a border as wide as the filter (core/render/film_buffer.h),
  /// and there are tiles as far around the picture. What that takes grows with the fourth power of the width.
  void check_filter_width() {
    if (!scene_.film.plugin || !scene_.filter.plugin) return;
    constexpr double kTile = 16, kBytes = 32, kMostBytes = 4.0 * (1 << 30), kOrdinary = 8;
    const Vec2i size = scene_.film.plugin->resolution();
    const double x = static_cast<double>(scene_.filter.plugin->x_width);
    const double y = static_cast<double>(scene_.filter.plugin->y_width);
    const double tiles = std::ceil((size.x + 2 * x) / kTile) * std::ceil((size.y + 2 * y) / kTile);
    const double bytes = tiles * (kTile + 2 * x) * (kTile + 2 * y) * kBytes;
    if (std::max(x, y) <= kOrdinary || bytes <= kMostBytes) return;
    const ParameterList& params = description_.filter.params;
    const auto found = std::find_if(params.begin(), params.end(),
                                    [&](const Parameter& p) { return p.name == (x >= y ? "xwidth" : "ywidth"); });
    const SourcePos where = found == params.end() ? description_.filter.where
                            : value_position_     ? value_position_(*found, 0)
                                                  : found->values_at;
    report({Severity::Error, ErrorClass::Scene, where,
            fmt::format("a filter of radius {:g} takes {:.3g} GiB of memory for {} x {} pixels, of 4 at most",
                        std::max(x, y), bytes / (1 << 30), size.x, size.y),
            "filters reach half a pixel to a few pixels"});
    scene_.filter.plugin.reset();
  }

  /// Those of the parameters that another plugin understands as well.
  const ParameterList& keep_only(const ParameterList& params, const std::vector<std::string>& names) {
    ParameterList& kept = scene_.own_params.emplace_back();
    for (const Parameter& p : params) {
      if (std::find(names.begin(), names.end(), p.name) != names.end()) kept.push_back(p);
    }
    return kept;
  }

  /// A sampler we do not have is replaced at the same number of samples.
  void bind_sampler() {
    const Entity& entity = description_.sampler;
    if (!is_given(entity) || find_plugin("sampler", entity.plugin)) {
      scene_.sampler = bind_option<Sampler>(entity, "sampler", kDefaultSampler, {});
      return;
    }
    const std::string remedy = fmt::format("{} is used instead, at the same number of samples", kStandInSampler);
    const PluginInfo* stand_in = find(entity, "sampler", {Severity::Warning, kStandInSampler, remedy.c_str()});
    scene_.sampler = bind_as<Sampler>(entity, *stand_in, keep_only(entity.params, {"pixelsamples"}));
    scene_.sampler.replaced = true;
  }

  /// An integrator that nobody has registered is rendered by the nearest there is, which is said once.
  void bind_integrator() {
    const Entity& entity = description_.integrator;
    if (!is_given(entity) || find_plugin("integrator", entity.plugin)) {
      scene_.integrator = bind_option<Integrator>(entity, "integrator", kDefaultIntegrator, {});
      return;
    }
    const bool known = is_pbrt_integrator(entity.plugin);
    const PluginInfo& stand_in = integrator_in_force(description_);
    Remedy remedy = "the picture is made with " + stand_in.name;
    if (!known) {
      std::vector<std::string> names = plugin_names("integrator");
      names.insert(names.end(), kPbrtIntegrators.begin(), kPbrtIntegrators.end());
      const Remedy hint = suggestion(entity.plugin, names);
      if (!hint.text.empty()) remedy = {remedy.text + '\n' + hint.text, hint.slip};
    }
    report({Severity::Warning,
            ErrorClass::Scene,
            entity.plugin_at,
            fmt::format("integrator \"{}\" {}", entity.plugin, known ? "is not simulated" : "is unknown"),
            remedy.text,
            {},
            false,
            remedy.slip});
    std::vector<std::string> shared{"maxdepth", "pixelbounds"};
    if (known) shared.insert(shared.end(), {"rrthreshold", "lightsamplestrategy"});
    scene_.integrator = bind_as<Integrator>(entity, stand_in, keep_only(entity.params, shared));
    scene_.integrator.replaced = true;
  }

  void bind_textures() {
    binding_textures_ = true;
    for (const auto& t : description_.textures) {
      begin(Problem::Of::Texture, scene_.textures.size());
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
      begin(Problem::Of::Material, scene_.materials.size());
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

  bool find_material(const MaterialDescription& statement, const std::string& name, std::shared_ptr<Material>& found,
                     std::vector<int>& used) const {
    for (const auto& [known, index] : statement.named) {
      if (known != name || static_cast<size_t>(index) >= scene_.materials.size()) continue;
      used.push_back(index);
      found = scene_.materials[static_cast<size_t>(index)].plugin;
      return true;
    }
    return false;
  }

  void bind_shape(const ShapeDescription& shape) {
    scene_.shape_material.push_back(shape.material);
    const PluginInfo* info = find(shape, "shape", {Severity::Warning, nullptr, "the shape is left out"});
    if (!info) {
      scene_.shapes.push_back({nullptr, shape.where, {}, {}, false});
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
    const size_t before = scene_.problems.size();
    auto bound = bind_as<Material>(material, material_info, merged);
    const auto is_old = [&](const Problem& p) {
      const SourcePos at = p.diagnostic.where;
      return at.file != shape.where.file || at.offset < shape.where.offset;
    };
    scene_.problems.erase(
        std::remove_if(scene_.problems.begin() + static_cast<ptrdiff_t>(before), scene_.problems.end(), is_old),
        scene_.problems.end());
    scene_.shape_material.back() = static_cast<int>(scene_.materials.size());
    scene_.materials.push_back(std::move(bound));
  }

  const SceneDescription& description_;
  const ValuePosition& value_position_;
  Diagnostics& diagnostics_;
  const bool with_textures_;
  bool binding_textures_ = false;
  Problem::Of of_ = Problem::Of::Options;
  size_t index_ = 0;
  BoundScene scene_;
};

}  // namespace

const PluginInfo& sampler_in_force(const SceneDescription& world) {
  const std::string& name = world.sampler.plugin;
  if (const PluginInfo* named = find_plugin("sampler", name)) return *named;
  return *find_plugin("sampler", is_given(world.sampler) ? kStandInSampler : kDefaultSampler);
}

const PluginInfo& integrator_in_force(const SceneDescription& world) {
  const std::string& name = world.integrator.plugin;
  if (const PluginInfo* named = find_plugin("integrator", name)) return *named;
  if (is_pbrt_integrator(name)) return *find_plugin("integrator", kNearestIntegrator);
  return *find_plugin("integrator", is_given(world.integrator) ? kStandInIntegrator : kDefaultIntegrator);
}

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
