#include "tools/whit/effect_flags.h"

#include <fmt/format.h>

#include "core/plugin/registry.h"

namespace whit {

namespace {

template <const char* category>
std::vector<std::string> plugins_of() {
  return plugin_names(category);
}
constexpr char kIntegrator[] = "integrator", kSampler[] = "sampler";

}  // namespace

void add_effect_flags(CommandLine& command, EffectFlags& flags) {
  Overrides& o = flags.overrides;
  command.flags.push_back({"--integrator",
                           &o.integrator,
                           "Instead of the scene's: whitted, path ... ('whit help integrator')",
                           {.offers = plugins_of<kIntegrator>}});
  command.flags.push_back({"--sampler",
                           &o.sampler,
                           "Instead of the scene's, with as many samples ('whit help sampler')",
                           {.offers = plugins_of<kSampler>}});
  command.flags.push_back({"--maxdepth", &o.max_depth, "The integrator's maxdepth, instead of the scene's"});
  command.flags.push_back({"--rrthreshold", &o.rr_threshold, "The integrator's rrthreshold, instead of the scene's"});
  command.flags.push_back({"--lights",
                           &o.lights,
                           "At each point 'all' lights are sampled, or some that a 'tree' of them chooses",
                           {.offers = [] {
                             return std::vector<std::string>{"all", "tree"};
                           }}});
  command.flags.push_back(
      {"--texture-filter", &o.texture_filter, "Of all image textures: ewa, trilinear or point", {.offers = [] {
         return std::vector<std::string>{"ewa", "trilinear", "point"};
       }}});
  command.flags.push_back({"--without",
                           &flags.without,
                           "Effects to leave out, as in reflection,shadows ('whit help effects')",
                           {.offers = effect_names, .commas = true}});
  command.flags.push_back({"--only",
                           &flags.only,
                           "Effects to keep of those that the scene calls for",
                           {.excludes = "--without", .offers = effect_names, .commas = true}});
}

std::string usage_problem(const EffectFlags& flags) {
  for (const auto& [flag, names] : {std::pair("--without", flags.without), std::pair("--only", flags.only)}) {
    std::string unknown;
    if (!names || !parse_effects(*names, unknown).empty()) continue;
    const std::string hint = did_you_mean(unknown, effect_names());
    return fmt::format("{}: there is no effect \"{}\"; {}", flag, unknown,
                       hint.empty() ? fmt::format("there are {}", fmt::join(effect_names(), ", ")) : hint);
  }
  return usage_problem(flags.overrides);
}

PlanOptions plan_options(const EffectFlags& flags) {
  std::string none;
  PlanOptions o;
  if (flags.without) o.off = parse_effects(*flags.without, none);
  if (flags.only) o.off = EffectSet::all() - parse_effects(*flags.only, none);
  o.everything_on = flags.plan_check;
  return o;
}

}  // namespace whit
