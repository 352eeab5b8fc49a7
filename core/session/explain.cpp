#include "core/session/explain.h"

#include "core/image/write.h"
#include "core/plugin/memory_limit.h"
#include "core/scene/left_out.h"
#include "core/session/memory.h"

namespace whit {
namespace {

Json describe_use(Effect e, const EffectPlan& plan, const Sources& sources) {
  const EffectUse& use = plan.use(e);
  Json::Object j{{"effect", effect_name(e)}, {"on", plan.needed.has(e)}, {"doc", effect_info(e).doc}};
  if (use.count > 0) j.emplace_back("called_for_by", use.count);
  Json::Array causes;
  for (const EffectCause& cause : use.causes) {
    causes.push_back(Json::Object{{"what", cause.what}, {"where", sources.location(cause.where)}});
  }
  if (!causes.empty()) j.emplace_back("causes", causes);
  if (!plan.needed.has(e)) {
    j.emplace_back("why_off", use.count > 0 ? use.why_off : "nothing calls for it");
    return j;
  }
  const EffectInfo& info = effect_info(e);
  j.emplace_back("stages", info.stages);
  if (*info.dimensions) j.emplace_back("dimensions", info.dimensions);
  if (info.ray_bytes > 0) j.emplace_back("bytes_per_ray", info.ray_bytes);
  if (info.point_bytes > 0) j.emplace_back("bytes_per_point", info.point_bytes);
  return j;
}

Json describe_left_out(const LeftOut& l, const Sources& sources) {
  Json::Object j{{"kind", l.kind}, {"name", l.name}, {"where", sources.location(l.where)}, {"reason", l.reason}};
  Json::Array files;
  for (const LeftOutFile& f : l.files) files.push_back(Json::Object{{"name", f.name}, {"bytes", f.bytes}});
  if (!files.empty()) j.emplace_back("files", files);
  return j;
}

}  // namespace

MemoryPlan plan_memory_of(const PlannedWorld& world) {
  MemoryRequest request;
  const Film& film = *world.bound.film.plugin;
  const StringList& aovs = film.aovs();
  request.film.aovs.assign(aovs.values.begin(), aovs.values.end());
  request.film.linear = film.file_name().empty() || is_linear_format(film.file_name());
  return plan_memory(world, request);
}

Json::Object plan_json(const PlannedWorld& p, const Sources& sources) {
  Json::Array effects, left_out, not_simulated;
  for_effects(EffectSet::all(), [&](Effect e) { effects.push_back(describe_use(e, p.plan, sources)); });
  for (const LeftOut& l : find_left_out(p.bound, p.plan)) left_out.push_back(describe_left_out(l, sources));
  for (const Ignored& i : p.plan.ignored) {
    not_simulated.push_back(Json::Object{{"what", i.what}, {"where", sources.location(i.where)}});
  }
  return {{"effects", effects}, {"left_out", left_out}, {"not_simulated", not_simulated}};
}

Json::Object memory_json(const PlannedWorld& world, const Sources& sources) {
  const MemoryPlan memory = plan_memory_of(world);
  Json::Object uses, steps;
  for (size_t u = 0; u < kMemoryUses; ++u) {
    const auto use = static_cast<MemoryUse>(u);
    const MemoryPart& largest = memory.largest(use);
    Json::Object of{{"bytes", static_cast<int64_t>(memory.of(use))}};
    if (largest.where.known())
      of.emplace_back("largest", Json::Object{{"what", largest.what}, {"where", sources.location(largest.where)}});
    uses.emplace_back(memory_use_key(use), of);
  }
  for (size_t s = 0; s < kMemorySteps; ++s) {
    const auto step = static_cast<MemoryStep>(s);
    steps.emplace_back(memory_step_key(step), static_cast<int64_t>(memory.total(step)));
  }
  return {{"estimate_bytes", static_cast<int64_t>(memory.total())},
          {"limit_bytes", static_cast<int64_t>(memory_limit())},
          {"step", memory_step_key(memory.step())},
          {"uses", uses},
          {"steps", steps}};
}

}  // namespace whit
