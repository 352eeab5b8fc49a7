// `whit explain`: the effect plan of a scene, in words or as JSON.

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tools/whit/command_line.h"
#include "tools/whit/load.h"
#include "tools/whit/terminal.h"

namespace whit {
namespace {

/// The live effects with what called for them, the first few places each.
nlohmann::json describe_effects(const EffectPlan& plan, const Sources& sources) {
  constexpr size_t kShown = 3;
  nlohmann::json effects = nlohmann::json::array();
  for (unsigned e = 0; e < static_cast<unsigned>(Effect::kCount); ++e) {
    const auto effect = static_cast<Effect>(e);
    nlohmann::json causes = nlohmann::json::array();
    size_t count = 0;
    for (const EffectCause& cause : plan.causes) {
      if (cause.effect != effect) continue;
      if (count++ < kShown) causes.push_back({{"what", cause.what}, {"where", sources.location(cause.where)}});
    }
    effects.push_back(
        {{"effect", effect_name(effect)}, {"on", plan.live(effect)}, {"causes", causes}, {"count", count}});
  }
  return effects;
}

/// Statements that the picture does not need: (kind, name or plugin, place).
nlohmann::json describe_left_out(const PlannedScene& p, const Sources& sources) {
  const SceneDescription& d = *p.bound.description;
  nlohmann::json out = nlohmann::json::array();
  const auto add = [&](const char* kind, const std::string& name, SourcePos where) {
    out.push_back({{"kind", kind}, {"name", name}, {"where", sources.location(where)}});
  };
  for (size_t i = 0; i < d.textures.size(); ++i) {
    if (!p.plan.texture_live[i]) add("texture", d.textures[i].name, d.textures[i].where);
  }
  for (size_t i = 1; i < d.materials.size(); ++i) {
    if (!p.plan.material_live[i])
      add("material", d.materials[i].name.empty() ? d.materials[i].plugin : d.materials[i].name, d.materials[i].where);
  }
  for (size_t i = 0; i < d.lights.size(); ++i) {
    if (!p.plan.light_live[i]) add("light", d.lights[i].plugin, d.lights[i].where);
  }
  for (size_t i = 0; i < d.objects.size(); ++i) {
    if (!p.plan.object_live[i]) add("object", d.objects[i].name, d.objects[i].where);
  }
  return out;
}

void print_plan(const nlohmann::json& world) {
  for (const auto& e : world["effects"]) {
    std::string because;
    for (const auto& c : e["causes"]) {
      because += fmt::format("{}{} at {}", because.empty() ? "" : "; ", c["what"].get<std::string>(),
                             c["where"].get<std::string>());
    }
    const size_t more = e["count"].get<size_t>() - e["causes"].size();
    if (more > 0) because += fmt::format("; {} more", more);
    const char* state = e["on"].get<bool>() ? "on " : "off";
    fmt::print("{:<18} {}{}{}\n", e["effect"].get<std::string>(), state, because.empty() ? "" : "  ", because);
  }
  fmt::print("{:<18} {}\n", "ray differentials", world["differentials"].get<bool>() ? "carried" : "none");
  for (const auto& l : world["left_out"]) {
    fmt::print("left out: {} \"{}\" at {}\n", l["kind"].get<std::string>(), l["name"].get<std::string>(),
               l["where"].get<std::string>());
  }
  for (const auto& i : world["ignored"]) fmt::print("not simulated: {}\n", i.get<std::string>());
}

}  // namespace

int explain_command(const Arguments& args) {
  std::string path;
  bool as_json = false;
  CLI::App app("Shows the effect plan of a scene: what is simulated, what called for it, and what is left out.",
               "whit explain");
  app.add_option("scene", path, "Scene file; standard input without");
  app.add_flag("--json", as_json, "Print the plan as JSON");
  int code = kDone;
  if (!parse_arguments(app, args, code)) return code;
  Sources sources;
  LoadedFile file = load_file(sources, path);
  Diagnostics all = file.parsed.diagnostics;
  nlohmann::json worlds = nlohmann::json::array();
  for (const SceneDescription& world : file.parsed.scenes) {
    const PlannedScene p = plan_scene(world, sources, all);
    worlds.push_back({{"effects", describe_effects(p.plan, sources)},
                      {"differentials", p.plan.needs_differentials},
                      {"left_out", describe_left_out(p, sources)},
                      {"ignored", p.plan.ignored}});
  }
  print_diagnostics(sources, all);
  if (all.has_errors()) return exit_code(all);
  if (as_json) {
    fmt::print("{}\n", nlohmann::json{{"worlds", worlds}}.dump(1));
  } else {
    for (const auto& world : worlds) print_plan(world);
  }
  return kDone;
}

}  // namespace whit
