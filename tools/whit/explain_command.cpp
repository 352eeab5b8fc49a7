// `whit explain`: the effect plan of a scene, in words or as JSON.

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "core/plugin/memory_limit.h"
#include "core/scene/left_out.h"
#include "core/session/explain.h"
#include "tools/whit/effect_flags.h"
#include "tools/whit/json.h"
#include "tools/whit/load.h"
#include "tools/whit/model_flags.h"
#include "tools/whit/terminal.h"

namespace whit {
namespace {

// ---- In words ----

void print_causes(const EffectUse& use, const Sources& sources) {
  for (const EffectCause& c : use.causes)
    fmt::print("      for {} at {}\n", printable(c.what), sources.location(c.where));
  const size_t more = use.count - use.causes.size();
  if (more > 0) fmt::print("      and for {} more\n", more);
}

/// ", 48 bytes a ray, 64 a point"
std::string bytes_carried(const EffectInfo& info) {
  std::string out;
  for (const auto& [bytes, of] : {std::pair(info.ray_bytes, "ray"), std::pair(info.point_bytes, "point")}) {
    if (bytes > 0) out += fmt::format(", {}{} a {}", bytes, out.empty() ? " bytes" : "", of);
  }
  return out;
}

void print_on(const EffectPlan& plan, const Sources& sources) {
  fmt::print("on\n");
  for_effects(plan.needed, [&](Effect e) {
    const EffectInfo& info = effect_info(e);
    fmt::print("  {:<20}{}{}\n", info.name, info.stages, bytes_carried(info));
    if (*info.dimensions) fmt::print("      sample dimensions: {}\n", info.dimensions);
    print_causes(plan.use(e), sources);
  });
}

/// Effects that nothing calls for, in lines that are no wider than a page.
void print_uncalled(const EffectSet& uncalled) {
  constexpr size_t kWidth = 100;
  std::string line = "  nothing calls for";
  const char* before = " ";
  for_effects(uncalled, [&](Effect e) {
    std::string word = std::string(before) + effect_name(e);
    if (line.size() + word.size() > kWidth) {
      fmt::print("{},\n", line);
      line = "     ", word = std::string(" ") + effect_name(e);
    }
    line += word;
    before = ", ";
  });
  if (!uncalled.empty()) fmt::print("{}\n", line);
}

void print_off(const EffectPlan& plan, const Sources& sources) {
  fmt::print("off\n");
  for_effects(plan.called_for - plan.needed, [&](Effect e) {
    fmt::print("  {:<20}{}\n", effect_name(e), printable(plan.use(e).why_off));
    print_causes(plan.use(e), sources);
  });
  print_uncalled(EffectSet::all() - plan.called_for);
}

void print_files(const std::vector<LeftOutFile>& files) {
  constexpr size_t kShown = 3;
  double more = 0;
  for (size_t i = 0; i < files.size(); ++i) {
    const auto bytes = static_cast<double>(files[i].bytes);
    if (i < kShown) fmt::print("      not read: {}, {}\n", printable(files[i].name), bytes_text(bytes));
    else more += bytes;
  }
  if (files.size() > kShown) fmt::print("      and {} more files, {}\n", files.size() - kShown, bytes_text(more));
}

/// Each kind's first few.
void print_left_out(const std::vector<LeftOut>& left_out, const Sources& sources) {
  constexpr int kShown = 10;
  if (!left_out.empty()) fmt::print("left out\n");
  std::map<std::string, int> seen;
  for (const LeftOut& l : left_out) {
    if (++seen[l.kind] > kShown) continue;
    fmt::print("  {} \"{}\" at {}: {}\n", l.kind, printable(l.name), sources.location(l.where), printable(l.reason));
    print_files(l.files);
  }
  for (const auto& [kind, count] : seen) {
    if (count > kShown) fmt::print("  and {} more of kind {} (--json lists all)\n", count - kShown, kind);
  }
}

void print_world(const PlannedWorld& world, const Sources& sources) {
  print_on(world.plan, sources);
  print_off(world.plan, sources);
  print_left_out(find_left_out(world.bound, world.plan), sources);
  if (!world.plan.ignored.empty()) fmt::print("not simulated\n");
  for (const Ignored& i : world.plan.ignored) fmt::print("  {} at {}\n", printable(i.what), sources.location(i.where));
}

void print_memory(const PlannedWorld& world, const Sources& sources) {
  const MemoryPlan memory = plan_memory_of(world);
  fmt::print("memory\n");
  for (size_t u = 0; u < kMemoryUses; ++u) {
    const auto use = static_cast<MemoryUse>(u);
    if (memory.of(use) < 1024) continue;
    const MemoryPart& largest = memory.largest(use);
    fmt::print("  {:<24}{:>10}{}\n", memory_use_text(use), bytes_text(memory.of(use)),
               largest.where.known()
                   ? fmt::format("   {} at {}", printable(largest.what), sources.location(largest.where))
                   : "");
  }
  fmt::print("  {:<24}{:>10}   while {}; of {} at most (--max-memory)\n", "in all", bytes_text(memory.total()),
             memory_step_text(memory.step()), bytes_text(static_cast<double>(memory_limit())));
}

void print_json(const std::vector<PlannedWorld>& worlds, const Sources& sources, bool memory) {
  Json::Array described;
  for (const PlannedWorld& world : worlds) {
    described.push_back(memory ? Json::Object{{"memory", memory_json(world, sources)}} : plan_json(world, sources));
  }
  fmt::print("{}\n", to_text(Json::Object{{"worlds", described}}));
}

}  // namespace

int explain_command(const Arguments& args) {
  std::string path;
  bool as_json = false, memory = false;
  EffectFlags flags;
  CommandLine command{"whit explain",
                      "Shows the effect plan of a scene: what is simulated, what called for it, and what is left out.",
                      {{"scene", &path, "Scene file or glTF model; standard input without"}}};
  ModelFlags model;
  add_effect_flags(command, flags);
  add_model_flags(command, model);
  command.flags.push_back({"--json", &as_json, "Print the plan as JSON"});
  command.flags.push_back({"--memory", &memory, "What rendering it is going to take of memory, and what takes it"});
  int code = kDone;
  if (!parse_arguments(command, args, code)) return code;
  if (const std::string problem = usage_problem(flags); !problem.empty()) {
    say("whit explain: " + problem);
    return kUsage;
  }
  if (const std::string problem = usage_problem(model, path); !problem.empty()) {
    say("whit explain: " + problem);
    return kUsage;
  }
  ParsedFile file = read_scene(path, read_options(model));
  if (const std::string problem = override_worlds(file, flags.overrides); !problem.empty()) {
    say("whit explain: " + problem);
    return kUsage;
  }
  const Sources& sources = *file.sources;
  Diagnostics all = file.said;
  std::vector<PlannedWorld> worlds;
  for (const SceneDescription& world : file.worlds) {
    worlds.push_back(plan_world(world, sources, plan_options(flags)));
    all.append(worlds.back().said);
  }
  print_diagnostics(sources, all);
  if (all.has_errors()) return exit_code(all);
  if (as_json) {
    print_json(worlds, sources, memory);
    return kDone;
  }
  for (size_t i = 0; i < worlds.size(); ++i) {
    if (worlds.size() > 1) fmt::print("{}world {} of {}\n", i > 0 ? "\n" : "", i + 1, worlds.size());
    if (memory) print_memory(worlds[i], sources);
    else print_world(worlds[i], sources);
  }
  return kDone;
}

}  // namespace whit
