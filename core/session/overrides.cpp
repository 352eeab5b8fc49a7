#include "core/session/overrides.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "core/plugin/registry.h"
#include "core/plugin/sampler.h"

namespace whit {
namespace {

/// What goes into a parameter of the integrator: a number, or a word that is not empty.
struct Knob {
  const char *flag, *parameter;
  std::optional<double> number;
  std::string word{};
};

std::vector<Knob> knobs_of(const Overrides& o) {
  return {{"--maxdepth", "maxdepth", o.max_depth},
          {"--rrthreshold", "rrthreshold", o.rr_threshold},
          {"--lights", "strategy", {}, o.lights}};
}

/// "" or that a flag's value is none of the names there are.
std::string unknown_name(const char* flag, const char* what, const std::string& name,
                         const std::vector<std::string>& names) {
  const std::string hint = did_you_mean(name, names);
  return fmt::format("{}: there is no {} \"{}\"; {}", flag, what, name,
                     hint.empty() ? fmt::format("there are {}", fmt::join(names, ", ")) : hint);
}

std::string unknown_plugin(const char* flag, const char* category, const std::string& name) {
  if (name.empty() || find_plugin(category, name)) return {};
  return unknown_name(flag, category, name, plugin_names(category));
}

/// The choices of a texture's parameter "filter"; none for textures that have none.
const std::vector<std::string>& filters_of(const PluginInfo* texture) {
  static const std::vector<std::string> none;
  const ParamSpec* filter = texture ? texture->find_param("filter") : nullptr;
  return filter ? filter->choices : none;
}

bool has(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Gives a statement a parameter in the place of all of that name.
template <class T>
void set_parameter(Entity& statement, const std::string& name, ParamType type, T value) {
  std::erase_if(statement.params, [&](const Parameter& p) { return p.name == name; });
  Parameter& added = statement.params.emplace_back();
  added.type = type, added.name = name;
  added.where = added.values_at = statement.where;
  added.values = std::vector<T>{std::move(value)};
}

void set_number(Entity& statement, const ParamSpec& spec, double value) {
  const ParamType type = spec.accepts.front();
  if (type == ParamType::Integer) set_parameter(statement, spec.name, type, static_cast<int32_t>(value));
  else set_parameter(statement, spec.name, type, value);
}

/// Puts another plugin in force, with those of the statement's parameters that it knows.
void use_plugin(Entity& statement, const PluginInfo& plugin) {
  statement.plugin = plugin.name;
  std::erase_if(statement.params, [&](const Parameter& p) { return plugin.find_param(p.name) == nullptr; });
}

/// How many samples per pixel a world's own sampler takes; none when its statement is wrong, which planning tells.
std::optional<int> declared_samples(const SceneDescription& world) {
  const PluginInfo& info = sampler_in_force(world);
  const std::unique_ptr<Plugin> plugin = info.make();
  Diagnostics said;
  BindContext context;
  context.diagnostics = &said;
  context.statement = world.sampler.where, context.statement_name = info.name;
  if (bind_parameters(info, *plugin, world.sampler.params, context)) plugin->check(said, world.sampler.where);
  if (said.has_errors()) return {};
  return dynamic_cast<const Sampler&>(*plugin).samples_per_pixel();
}

/// Tells a sampler's statement how many samples to take: as a number, or as the grid of so many cells that is nearest to
/// a square.
void set_samples(Entity& statement, const PluginInfo& plugin, int samples) {
  if (const ParamSpec* number = plugin.find_param("pixelsamples")) return set_number(statement, *number, samples);
  const ParamSpec *across = plugin.find_param("xsamples"), *down = plugin.find_param("ysamples");
  if (!across || !down) return;
  int columns = static_cast<int>(std::sqrt(static_cast<double>(samples)));
  while (samples % columns != 0) --columns;
  // A prime that is more than a side may be.
  const int rows = static_cast<int>(std::min<double>(samples / columns, down->range.max));
  set_number(statement, *across, columns);
  set_number(statement, *down, rows);
}

void use_sampler(SceneDescription& world, const std::string& name) {
  const PluginInfo& wanted = *find_plugin("sampler", name);
  if (find_plugin("sampler", world.sampler.plugin) == &wanted) return;
  const std::optional<int> samples = declared_samples(world);
  if (!samples) return;
  use_plugin(world.sampler, wanted);
  const std::unique_ptr<Plugin> plugin = wanted.make();
  const int most = dynamic_cast<Sampler&>(*plugin).set_samples_per_pixel(std::numeric_limits<int>::max());
  set_samples(world.sampler, wanted, std::min(*samples, most));
}

void use_integrator(SceneDescription& world, const std::string& name) {
  const PluginInfo& wanted = *find_plugin("integrator", name);
  if (find_plugin("integrator", world.integrator.plugin) != &wanted) use_plugin(world.integrator, wanted);
}

/// "" or why the integrator in force does not take a value.
std::string turn(SceneDescription& world, const Knob& knob) {
  const PluginInfo& integrator = integrator_in_force(world);
  const ParamSpec* spec = integrator.find_param(knob.parameter);
  if (!spec) {
    std::vector<std::string> others;
    for (const PluginInfo* info : list_plugins("integrator"))
      if (info->find_param(knob.parameter)) others.push_back(info->name);
    return fmt::format("{}: integrator \"{}\" has no parameter \"{}\"; {} {}", knob.flag, integrator.name,
                       knob.parameter, fmt::join(others, ", "), others.size() == 1 ? "has" : "have");
  }
  if (knob.number && !(*knob.number >= spec->range.min && *knob.number <= spec->range.max))
    return fmt::format("{}: {} must be {}, not {}", knob.flag, knob.parameter, range_text(spec->range), *knob.number);
  Entity& statement = world.integrator;
  // A statement that is not in the file is that of the default.
  if (statement.plugin.empty() && !statement.where.known()) statement.plugin = integrator.name;
  if (knob.number) set_number(statement, *spec, *knob.number);
  else set_parameter(statement, spec->name, ParamType::String, knob.word);
  return {};
}

void filter_textures(SceneDescription& world, const std::string& filter) {
  for (TextureDescription& texture : world.textures) {
    const PluginInfo* plugin = find_plugin(texture.spectrum ? "spectrum texture" : "float texture", texture.plugin);
    if (!has(filters_of(plugin), filter)) continue;
    // pbrt-v3's older way to say the same.
    std::erase_if(texture.params, [](const Parameter& p) { return p.name == "trilinear"; });
    set_parameter(texture, "filter", ParamType::String, filter);
  }
}

/// Samples at fixed places are not what another sampler's tend to.
bool has_fixed_places(const Entity& sampler) {
  for (const Parameter& p : sampler.params) {
    const bool truth = p.type == ParamType::Bool && !p.bools().empty() && p.bools()[0] != 0;
    if ((p.name == "samplepixelcenter" && truth) || (p.name == "jitter" && !truth)) return true;
  }
  return false;
}

}  // namespace

std::string usage_problem(const Overrides& o) {
  std::string problem = unknown_plugin("--integrator", "integrator", o.integrator);
  if (problem.empty()) problem = unknown_plugin("--sampler", "sampler", o.sampler);
  const std::vector<std::string>& filters = filters_of(find_plugin("spectrum texture", "imagemap"));
  if (problem.empty() && !o.texture_filter.empty() && !has(filters, o.texture_filter))
    problem = unknown_name("--texture-filter", "filter", o.texture_filter, filters);
  const std::vector<std::string>& strategies = find_plugin("integrator", "whitted")->find_param("strategy")->choices;
  if (problem.empty() && !o.lights.empty() && !has(strategies, o.lights))
    problem = unknown_name("--lights", "strategy", o.lights, strategies);
  return problem;
}

std::string override_world(SceneDescription& world, const Overrides& o) {
  if (!o.integrator.empty()) use_integrator(world, o.integrator);
  if (!o.sampler.empty()) use_sampler(world, o.sampler);
  if (!o.texture_filter.empty()) filter_textures(world, o.texture_filter);
  for (const Knob& knob : knobs_of(o)) {
    if (!knob.number && knob.word.empty()) continue;
    if (std::string problem = turn(world, knob); !problem.empty()) return problem;
  }
  return {};
}

std::string use_extending_sampler(SceneDescription& world) {
  const PluginInfo& sampler = sampler_in_force(world);
  const std::unique_ptr<Plugin> made = sampler.make();
  if (static_cast<const Sampler&>(*made).extends() || has_fixed_places(world.sampler)) return "";
  Overrides sobol;
  sobol.sampler = "sobol";
  override_world(world, sobol);
  return sampler.name;
}

ScopedOverrides::ScopedOverrides(SceneDescription& world, const Overrides& overrides)
    : world_(world),
      sampler_(world.sampler),
      integrator_(world.integrator),
      textures_(world.textures),
      problem_(override_world(world, overrides)) {}

ScopedOverrides::~ScopedOverrides() {
  world_.sampler = std::move(sampler_), world_.integrator = std::move(integrator_);
  world_.textures = std::move(textures_);
}

std::string override_worlds(ParsedFile& file, const Overrides& overrides) {
  for (SceneDescription& world : file.worlds) {
    if (std::string problem = override_world(world, overrides); !problem.empty()) return problem;
  }
  return {};
}

}  // namespace whit
