#include "tools/whit/load.h"

#include <algorithm>
#include <chrono>
#include <iostream>
#include <iterator>

#include "core/scene/problems.h"
#include "parser/lexer.h"

namespace whit {
namespace {

double since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// A build of which effects are compiled out is for measurements, and must not show half of a scene.
void check_build(const EffectPlan& plan, Diagnostics& diagnostics) {
  for_effects(plan.needed & kCompiledOut, [&](Effect e) {
    diagnostics.error(plan.use(e).causes.front().where, std::string("this build lacks ") + effect_name(e),
                      "configure one without WHIT_COMPILE_OUT, or switch it off with --without");
  });
}

}  // namespace

LoadedFile load_text(Sources& sources, const std::string& name, std::string text, const ParseOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  LoadedFile out;
  out.parsed = parse_text(sources, name, std::move(text), "", options);
  out.parse_seconds = since(start);
  return out;
}

LoadedFile load_file(Sources& sources, const std::string& path, const ParseOptions& options) {
  if (path.empty() || path == "-") {
    return load_text(sources, "<stdin>", std::string{std::istreambuf_iterator<char>(std::cin), {}}, options);
  }
  const auto start = std::chrono::steady_clock::now();
  LoadedFile out;
  out.parsed = parse_file(sources, path, options);
  out.parse_seconds = since(start);
  return out;
}

PlannedScene plan_scene(const SceneDescription& description, const Sources& sources, Diagnostics& diagnostics,
                        const PlanOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  PlannedScene out;
  const ValuePosition position = [&sources](const Parameter& p, size_t i) { return value_position(sources, p, i); };
  Diagnostics unweighed;
  out.bound = bind_scene(description, position, unweighed, !options.off.has(Effect::Textures));
  out.plan = plan_effects(out.bound, options);
  diagnostics.append(weigh_problems(out.bound, out.plan));
  check_build(out.plan, diagnostics);
  out.seconds = since(start);
  return out;
}

Diagnostics all_problems(const LoadedFile& file, const Sources& sources,
                         const std::function<Diagnostics(PlannedScene)>& further) {
  Diagnostics all = file.parsed.diagnostics;
  Diagnostics planning, found;
  for (const SceneDescription& world : file.parsed.scenes) {
    PlannedScene planned = plan_scene(world, sources, planning);
    // What is wrong explains what is surprising.
    if (!all.has_errors() && !planning.has_errors()) planning.append(find_surprises(world, planned.plan));
    if (further) found.append(further(std::move(planned)));
  }
  for (const Diagnostic& d : planning.all()) {
    // One place, one message: the parser has said what is wrong there, planning only met the consequence.
    const auto same_place = [&](const Diagnostic& o) {
      return o.where.known() && o.where.file == d.where.file && o.where.offset == d.where.offset;
    };
    if (std::none_of(all.all().begin(), all.all().end(), same_place)) all.add(d);
  }
  all.append(found);
  return all;
}

}  // namespace whit
