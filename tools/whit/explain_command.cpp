// `whit explain`: the effect plan of a scene, in words or as JSON.

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "core/scene/left_out.h"
#include "tools/whit/effect_flags.h"
#include "tools/whit/load.h"
#include "tools/whit/terminal.h"

namespace whit {
namespace {

using Json = nlohmann::ordered_json;

// ---- What there is to say ----

Json describe_use(Effect e, const EffectPlan& plan, const Sources& sources) {
  const EffectUse& use = plan.use(e);
  Json j{{"effect", effect_name(e)}, {"on", plan.needed.has(e)}, {"doc", effect_info(e).doc}};
  if (use.count > 0) j["called_for_by"] = use.count;
  for (const EffectCause& cause : use.causes) {
    j["causes"].push_back({{"what", cause.what}, {"where", sources.location(cause.where)}});
  }
  if (!plan.needed.has(e)) {
    j["why_off"] = use.count > 0 ? use.why_off : "nothing calls for it";
    return j;
  }
  const EffectInfo& info = effect_info(e);
  j["stages"] = info.stages;
  if (*info.dimensions) j["dimensions"] = info.dimensions;
  if (info.ray_bytes > 0) j["bytes_per_ray"] = info.ray_bytes;
  if (info.point_bytes > 0) j["bytes_per_point"] = info.point_bytes;
  return j;
}

Json describe_left_out(const LeftOut& l, const Sources& sources) {
  Json j{{"kind", l.kind}, {"name", l.name}, {"where", sources.location(l.where)}, {"reason", l.reason}};
  for (const LeftOutFile& f : l.files) j["files"].push_back({{"name", f.name}, {"bytes", f.bytes}});
  return j;
}

Json describe(const PlannedScene& p, const Sources& sources) {
  Json world{{"effects", Json::array()}, {"left_out", Json::array()}, {"not_simulated", Json::array()}};
  for_effects(EffectSet::all(), [&](Effect e) { world["effects"].push_back(describe_use(e, p.plan, sources)); });
  for (const LeftOut& l : find_left_out(p.bound, p.plan)) world["left_out"].push_back(describe_left_out(l, sources));
  for (const Ignored& i : p.plan.ignored) {
    world["not_simulated"].push_back({{"what", i.what}, {"where", sources.location(i.where)}});
  }
  return world;
}

// ---- In words ----

std::string text(const Json& j, const char* key) { return j.contains(key) ? j[key].get<std::string>() : std::string(); }

void print_causes(const Json& effect) {
  if (!effect.contains("causes")) return;
  for (const Json& c : effect["causes"]) fmt::print("      for {} at {}\n", text(c, "what"), text(c, "where"));
  const size_t more = effect["called_for_by"].get<size_t>() - effect["causes"].size();
  if (more > 0) fmt::print("      and for {} more\n", more);
}

/// ", 48 bytes a ray, 64 a point"
std::string bytes_carried(const Json& effect) {
  std::string out;
  for (const auto& [key, of] : {std::pair("bytes_per_ray", "ray"), std::pair("bytes_per_point", "point")}) {
    if (!effect.contains(key)) continue;
    out += fmt::format(", {}{} a {}", effect[key].get<int>(), out.empty() ? " bytes" : "", of);
  }
  return out;
}

void print_on(const Json& effects) {
  fmt::print("on\n");
  for (const Json& e : effects) {
    if (!e["on"].get<bool>()) continue;
    fmt::print("  {:<20}{}{}\n", text(e, "effect"), text(e, "stages"), bytes_carried(e));
    if (e.contains("dimensions")) fmt::print("      sample dimensions: {}\n", text(e, "dimensions"));
    print_causes(e);
  }
}

/// Effects that nothing calls for, in lines that are no wider than a page.
void print_uncalled(const Json& effects) {
  constexpr size_t kWidth = 100;
  std::string line = "  nothing calls for";
  const char* before = " ";
  for (const Json& e : effects) {
    if (e["on"].get<bool>() || e.contains("causes")) continue;
    std::string word = before + text(e, "effect");
    if (line.size() + word.size() > kWidth) {
      fmt::print("{},\n", line);
      line = "     ", word = " " + text(e, "effect");
    }
    line += word;
    before = ", ";
  }
  if (*before == ',') fmt::print("{}\n", line);
}

void print_off(const Json& effects) {
  fmt::print("off\n");
  for (const Json& e : effects) {
    if (e["on"].get<bool>() || !e.contains("causes")) continue;
    fmt::print("  {:<20}{}\n", text(e, "effect"), text(e, "why_off"));
    print_causes(e);
  }
  print_uncalled(effects);
}

void print_files(const Json& entry) {
  if (!entry.contains("files")) return;
  constexpr size_t kShown = 3;
  const size_t n = entry["files"].size();
  for (size_t i = 0; i < std::min(n, kShown); ++i) {
    const Json& file = entry["files"][i];
    fmt::print("      not read: {}, {}\n", text(file, "name"), bytes_text(file["bytes"].get<double>()));
  }
  if (n <= kShown) return;
  double bytes = 0;
  for (size_t i = kShown; i < n; ++i) bytes += entry["files"][i]["bytes"].get<double>();
  fmt::print("      and {} more files, {}\n", n - kShown, bytes_text(bytes));
}

/// Each kind's first few.
void print_left_out(const Json& left_out) {
  constexpr int kShown = 10;
  if (!left_out.empty()) fmt::print("left out\n");
  std::map<std::string, int> seen;
  for (const Json& l : left_out) {
    const std::string kind = text(l, "kind");
    if (++seen[kind] > kShown) continue;
    fmt::print("  {} \"{}\" at {}: {}\n", kind, text(l, "name"), text(l, "where"), text(l, "reason"));
    print_files(l);
  }
  for (const auto& [kind, count] : seen) {
    if (count > kShown) fmt::print("  and {} more of kind {} (--json lists all)\n", count - kShown, kind);
  }
}

void print_world(const Json& world) {
  print_on(world["effects"]);
  print_off(world["effects"]);
  print_left_out(world["left_out"]);
  if (!world["not_simulated"].empty()) fmt::print("not simulated\n");
  for (const Json& i : world["not_simulated"]) fmt::print("  {} at {}\n", text(i, "what"), text(i, "where"));
}

}  // namespace

int explain_command(const Arguments& args) {
  std::string path;
  bool as_json = false;
  EffectFlags flags;
  CLI::App app("Shows the effect plan of a scene: what is simulated, what called for it, and what is left out.",
               "whit explain");
  app.add_option("scene", path, "Scene file; standard input without");
  add_effect_flags(app, flags);
  app.add_flag("--json", as_json, "Print the plan as JSON");
  int code = kDone;
  if (!parse_arguments(app, args, code)) return code;
  if (const std::string problem = usage_problem(flags); !problem.empty()) {
    say("whit explain: " + problem);
    return kUsage;
  }
  Sources sources;
  LoadedFile file = load_file(sources, path);
  Diagnostics all = file.parsed.diagnostics;
  std::vector<PlannedScene> planned;
  for (const SceneDescription& world : file.parsed.scenes) {
    planned.push_back(plan_scene(world, sources, all, plan_options(flags)));
  }
  print_diagnostics(sources, all);
  if (all.has_errors()) return exit_code(all);
  Json worlds = Json::array();
  for (const PlannedScene& world : planned) worlds.push_back(describe(world, sources));
  if (as_json) {
    fmt::print("{}\n", Json{{"worlds", worlds}}.dump(1, ' ', false, Json::error_handler_t::replace));
    return kDone;
  }
  for (size_t i = 0; i < worlds.size(); ++i) {
    if (worlds.size() > 1) fmt::print("{}world {} of {}\n", i > 0 ? "\n" : "", i + 1, worlds.size());
    print_world(worlds[i]);
  }
  return kDone;
}

}  // namespace whit
