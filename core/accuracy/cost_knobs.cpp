#include "core/accuracy/cost_knobs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "core/plugin/registry.h"

namespace whit {
namespace {

/// A number that a statement gives to a parameter of its plugin, or the plugin's default; none where it has no such
/// parameter.
std::optional<double> number_of(const Entity& entity, const PluginInfo& plugin, const char* name) {
  const ParamSpec* spec = plugin.find_param(name);
  if (!spec) return {};
  for (const Parameter& p : entity.params) {
    if (p.name != name) continue;
    if (!p.numbers().empty()) return p.numbers().front();
    if (!p.integers().empty()) return static_cast<double>(p.integers().front());
  }
  return std::strtod(spec->default_text.c_str(), nullptr);
}

/// Adds one that the flag makes; what it overrides is the caller's to say.
CostAlternative& add(std::vector<CostAlternative>& to, std::string knob, std::string from, std::string value,
                     const char* flag) {
  CostAlternative& out = to.emplace_back();
  out.variant.knob = std::move(knob);
  out.variant.flags = fmt::format("{} {}", flag, value);
  out.variant.value = std::move(value);
  out.from = std::move(from);
  return out;
}

void add_samplers(const SceneDescription& world, bool all, std::vector<CostAlternative>& to) {
  const std::string own = sampler_in_force(world).name;
  for (const std::string& name : all ? plugin_names("sampler") : std::vector<std::string>{"sobol", "random"}) {
    if (name == own) continue;
    CostAlternative& other = add(to, "sampler", own, name, "--sampler");
    other.variant.overrides.sampler = name, other.same_limit = true;
  }
}

/// Depths around the scene's own: two smaller ones, for what they save, and a greater one, for what the scene's cuts off.
void add_depths(const SceneDescription& world, const EffectPlan& plan, std::vector<CostAlternative>& to) {
  if ((plan.needed & EffectSet{Effect::Reflection, Effect::Refraction, Effect::Indirect}).empty()) return;
  const std::optional<double> own = number_of(world.integrator, integrator_in_force(world), "maxdepth");
  if (!own) return;
  constexpr int kDepths[] = {1, 2, 3, 5, 8, 12, 20, 32, 50, 100};
  const auto from = std::lower_bound(std::begin(kDepths), std::end(kDepths), static_cast<int>(*own));
  std::vector<int> depths;
  for (auto d = from; d != std::begin(kDepths) && from - d < 2;) depths.push_back(*--d);
  const auto above = std::upper_bound(std::begin(kDepths), std::end(kDepths), static_cast<int>(*own));
  if (above != std::end(kDepths) && *own <= 32) depths.push_back(*above);
  for (int depth : depths) {
    add(to, "maxdepth", fmt::format("{:.0f}", *own), std::to_string(depth), "--maxdepth").variant.overrides.max_depth =
        depth;
  }
}

/// How the image textures that the picture needs are filtered: one word where all are alike, else "the scene's".
std::string own_texture_filter(const SceneDescription& world, const EffectPlan& plan) {
  std::string own;
  for (size_t i = 0; i < world.textures.size(); ++i) {
    const TextureDescription& texture = world.textures[i];
    if (texture.plugin != "imagemap" || !plan.texture_live[i]) continue;
    std::string filter = "ewa";
    bool trilinear = false;
    for (const Parameter& p : texture.params) {
      if (p.name == "filter" && !p.strings().empty()) filter = p.strings().front();
      if (p.name == "trilinear" && !p.bools().empty()) trilinear = p.bools().front() != 0;
    }
    if (trilinear && filter == "ewa") filter = "trilinear";
    if (!own.empty() && own != filter) return "the scene's";
    own = filter;
  }
  return own;
}

void add_texture_filters(const SceneDescription& world, const EffectPlan& plan, std::vector<CostAlternative>& to) {
  const std::string own = own_texture_filter(world, plan);
  if (own.empty()) return;
  for (const char* filter : {"point", "trilinear", "ewa"}) {
    if (own == filter) continue;
    add(to, "texture filter", own, filter, "--texture-filter").variant.overrides.texture_filter = filter;
  }
}

void add_integrators(const SceneDescription& world, std::vector<CostAlternative>& to) {
  const std::string own = integrator_in_force(world).name;
  if (own != "path") return;
  for (const char* name : {"whitted", "directlighting"})
    add(to, "integrator", own, name, "--integrator").variant.overrides.integrator = name;
}

/// Of many lights, all or some; of few, both are the same.
void add_lights(const SceneDescription& world, const Scene& scene, std::vector<CostAlternative>& to) {
  const PluginInfo& integrator = integrator_in_force(world);
  if (scene.lights.size() <= static_cast<size_t>(kLightsOfTree) || !integrator.find_param("strategy")) return;
  const bool some = scene.chosen_lights > 0;
  const char *const own = some ? (scene.chosen_lights > 1 ? "tree" : "one") : "all", *const other =
                                                                                         some ? "all" : "tree";
  CostAlternative& added = add(to, "lights", own, other, "--lights");
  added.variant.overrides.lights = other, added.same_limit = true;
}

/// Roulette begins at the fifth bounce.
void add_roulette(const SceneDescription& world, const EffectPlan& plan, std::vector<CostAlternative>& to) {
  const PluginInfo& integrator = integrator_in_force(world);
  const std::optional<double> own = number_of(world.integrator, integrator, "rrthreshold");
  const std::optional<double> depth = number_of(world.integrator, integrator, "maxdepth");
  if (!own || !depth || *depth <= 4 || !plan.needed.has(Effect::Indirect)) return;
  for (double threshold : {0.0, 1.0}) {
    if (*own == threshold) continue;
    CostAlternative& other =
        add(to, "roulette", fmt::format("{:g}", *own), fmt::format("{:g}", threshold), "--rrthreshold");
    other.variant.overrides.rr_threshold = threshold, other.same_limit = true;
  }
}

/// Where there is a denoiser.
void add_denoiser(std::vector<CostAlternative>& to) {
  std::shared_ptr<const Denoiser> denoiser = load_denoiser().denoiser;
  if (!denoiser) return;
  CostVariant& variant = add(to, "denoise", "none", "(biased)", "").variant;
  variant.flags = "--denoise", variant.denoiser = std::move(denoiser);
}

}  // namespace

std::vector<CostAlternative> knobs_of(const SceneDescription& world, const Scene& scene, bool all_samplers) {
  const EffectPlan& plan = scene.plan;
  std::vector<CostAlternative> out;
  add_lights(world, scene, out);
  add_samplers(world, all_samplers, out);
  add_depths(world, plan, out);
  add_texture_filters(world, plan, out);
  add_integrators(world, out);
  add_roulette(world, plan, out);
  add(out, "traversal", "robust", "fast", "--traversal").variant.robust = false;
  add_denoiser(out);
  return out;
}

std::vector<CostAlternative> effects_of(const EffectPlan& plan) {
  std::vector<CostAlternative> out;
  for_effects(plan.needed, [&](Effect e) { add(out, "effect", "", effect_name(e), "--without").variant.off = {e}; });
  return out;
}

}  // namespace whit
