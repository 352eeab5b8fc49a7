// What can be asked of a scene without having its picture: check, explain, cost.

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <memory>

#include "core/accuracy/report.h"
#include "core/check/check.h"
#include "core/check/names.h"
#include "core/render/aovs.h"
#include "core/session/explain.h"
#include "python/convert.h"
#include "python/kept_scene.h"
#include "python/plan_wish.h"
#include "python/version.h"

namespace whit::python {
namespace {

/// Names that cannot be allowed or asked for are wrong usage.
void refuse_unknown(const char* argument, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    const std::string problem = problem_of_allowing(name);
    if (problem.empty()) continue;
    const std::string hint = did_you_mean(name, names_that_can_be_allowed());
    throw Failure(FailureKind::Usage, fmt::format("{}: {}{}{}", argument, problem, hint.empty() ? "" : "; ", hint));
  }
}

py::list check(const SceneSource& source, const py::dict& model, const std::vector<std::string>& allow,
               const std::vector<std::string>& also) {
  refuse_unknown("allow", allow);
  refuse_unknown("also", also);
  ReadOptions options = read_options(model_wish(model), source);
  options.read_unplaced = true;
  return to_python(wait_for(
      [&](Attention& attention) {
        const ParsedFile file = read_source(source, options);
        CheckOptions wanted;
        wanted.allowed = allow, wanted.asked_for = also;
        wanted.give_up = [&] { return attention.ended(); };
        return said_of(*file.sources, check_file(file, source.name(), wanted));
      },
      py::none()));
}

Json explain_worlds(const SceneSource& source, const ReadOptions& read, const PlanWish& wish, bool memory) {
  const PlanOptions options = plan_options(wish);
  ParsedFile file = read_source(source, read);
  const std::string problem = apply_overrides(wish, file);
  const Sources& sources = *file.sources;
  Diagnostics all = file.said;
  std::vector<PlannedWorld> worlds;
  for (const SceneDescription& world : file.worlds) {
    worlds.push_back(plan_world(world, sources, options));
    all.append(worlds.back().said);
  }
  if (all.has_errors()) throw failure_of(sources, all, said_of(sources, all));
  if (!problem.empty()) throw Failure(FailureKind::Usage, problem);
  Json::Array described;
  for (const PlannedWorld& world : worlds) {
    Json::Object one = plan_json(world, sources);
    if (memory) one.emplace_back("memory", memory_json(world, sources));
    described.emplace_back(std::move(one));
  }
  return Json::Object{{"worlds", std::move(described)}};
}

py::object explain(const SceneSource& source, const py::dict& plan, bool memory) {
  const PlanWish wish = plan_wish(plan);
  const ReadOptions read = read_options(model_wish(plan), source);
  return to_python(wait_for([&](Attention&) { return explain_worlds(source, read, wish, memory); }, py::none()));
}

struct CostTexts {
  std::string json, html;
};

CostTexts study(const SceneSource& source, const ReadOptions& read, CostRequest request, bool page,
                Attention& attention) {
  ParsedFile file = read_source(source, read);
  if (file.said.has_errors() || file.worlds.empty()) {
    const Diagnostics all = all_problems(file);
    if (!all.has_errors()) throw Failure(FailureKind::Scene, source.name() + ": there is no WorldBegin in it");
    throw failure_of(*file.sources, all, said_of(*file.sources, all));
  }
  request.scene_path = source.text ? "-" : source.path;
  request.before = file.elapsed;
  request.progress = [&](double share, const std::string&) { return attention.go_on(share); };
  std::unique_ptr<tbb::global_control> threads;
  if (request.threads > 0) {
    threads = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                    static_cast<size_t>(request.threads));
  }
  const CostStudy result = study_cost(file, 0, request);
  if (result.said.has_errors()) throw failure_of(*file.sources, result.said, said_of(*file.sources, result.said));
  return {cost_json(result.report), page ? cost_html(result.report) : ""};
}

/// The report as JSON, and as a page where that is wanted.
py::tuple cost(const SceneSource& source, const py::dict& options, const py::object& progress) {
  CostRequest request;
  bool page = false;
  take(options, "seconds", request.seconds), take(options, "quick", request.quick);
  take(options, "all_samplers", request.all_samplers), take(options, "threads", request.threads);
  take(options, "seed", request.seed), take(options, "page", page);
  const ReadOptions read = read_options(model_wish(options), source);
  const CostTexts texts =
      wait_for([&](Attention& attention) { return study(source, read, request, page, attention); }, progress);
  return py::make_tuple(text(texts.json), text(texts.html));
}

std::vector<std::string> aov_names() {
  std::vector<std::string> names;
  for (const AovRow& row : all_aovs()) names.emplace_back(row.name);
  return names;
}

}  // namespace

void add_inquiries(py::module_& module) {
  module.def("check", &check);
  module.def("explain", &explain);
  module.def("cost", &cost);
  module.def("aov_names", &aov_names);
  module.def("effect_names", &effect_names);
  module.def("version", &version);
}

}  // namespace whit::python
