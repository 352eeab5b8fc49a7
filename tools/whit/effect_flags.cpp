#include "tools/whit/effect_flags.h"

#include <fmt/format.h>

#include "core/plugin/registry.h"

namespace whit {

void add_effect_flags(CommandLine& command, EffectFlags& flags) {
  command.flags.push_back(
      {"--integrator", &flags.integrator, "Instead of the scene's: whitted, path ... ('whit help integrator')"});
  command.flags.push_back(
      {"--without", &flags.without, "Effects to leave out, as in reflection,shadows ('whit help effects')"});
  command.flags.push_back(
      {"--only", &flags.only, "Effects to keep of those that the scene calls for", {.excludes = "--without"}});
}

std::string usage_problem(const EffectFlags& flags) {
  for (const auto& [flag, names] : {std::pair("--without", flags.without), std::pair("--only", flags.only)}) {
    std::string unknown;
    if (!names || !parse_effects(*names, unknown).empty()) continue;
    const std::string hint = did_you_mean(unknown, effect_names());
    return fmt::format("{}: there is no effect \"{}\"; {}", flag, unknown,
                       hint.empty() ? fmt::format("there are {}", fmt::join(effect_names(), ", ")) : hint);
  }
  if (!flags.integrator.empty() && !find_plugin("integrator", flags.integrator)) {
    const std::vector<std::string> names = plugin_names("integrator");
    const std::string hint = did_you_mean(flags.integrator, names);
    return fmt::format("--integrator: there is no integrator \"{}\"; {}", flags.integrator,
                       hint.empty() ? fmt::format("there are {}", fmt::join(names, ", ")) : hint);
  }
  return {};
}

void choose_integrator(const EffectFlags& flags, ParsedFile& file) {
  if (!flags.integrator.empty()) use_integrator(file, flags.integrator);
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
