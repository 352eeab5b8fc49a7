// `whit bench`: speed of rendering, as medians of several runs with their spread.

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/accel/accel.h"
#include "core/render/render.h"
#include "tools/whit/bench_scenes.h"
#include "tools/whit/command_line.h"
#include "tools/whit/load.h"
#include "tools/whit/terminal.h"

namespace whit {
namespace {

struct Spread {
  double low = 0, median = 0, high = 0;
};

Spread spread_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return {values.front(), values[values.size() / 2], values.back()};
}

/// One thread, or all: camera samples per second and core over the runs.
Spread samples_per_core(const Scene& scene, int threads, int runs, RenderStatistics& statistics) {
  std::vector<double> rates;
  RenderOptions options;
  options.threads = threads;
  for (int run = 0; run <= runs; ++run) {
    const RenderResult r = render(scene, options);
    statistics = r.statistics;
    // The first run warms caches and is not counted.
    if (run > 0) rates.push_back(static_cast<double>(r.statistics.camera_samples) / r.seconds / r.threads);
  }
  return spread_of(rates);
}

nlohmann::json bench_one(const std::string& name, const SceneDescription& world, const Sources& sources, int runs,
                         double parse_seconds, uint64_t bytes, Diagnostics& diagnostics) {
  PlannedScene planned = plan_scene(world, sources, diagnostics);
  TextureStore textures;
  const std::unique_ptr<Scene> scene =
      build_scene(std::move(planned.bound), std::move(planned.plan), {}, textures, diagnostics);
  if (!scene || diagnostics.has_errors()) return {};
  RenderStatistics s;
  const Spread all = samples_per_core(*scene, 0, runs, s), one = samples_per_core(*scene, 1, runs, s);
  const int cores = tbb::this_task_arena::max_concurrency();
  const double rays_per_sample =
      static_cast<double>(s.rays()) / static_cast<double>(std::max<int64_t>(1, s.camera_samples));
  return {{"name", name},
          {"camera_samples_per_s_per_core", one.median},
          {"spread", {one.low, one.high}},
          {"rays_per_s_per_core", one.median * rays_per_sample},
          {"threads", cores},
          {"scaling", all.median * cores / one.median},
          {"parse_mb_per_s", static_cast<double>(bytes) / 1e6 / std::max(1e-9, parse_seconds)},
          {"triangles", scene->triangle_count()},
          {"invalid_samples", s.invalid_samples},
          {"peak_memory_bytes", peak_memory()}};
}

void print_row(const nlohmann::json& j) {
  fmt::print("{:<20} {:>9.2f} {:>7.2f}-{:<7.2f} {:>9.2f} {:>8.2f} {:>9} {:>9}\n", j["name"].get<std::string>(),
             j["camera_samples_per_s_per_core"].get<double>() / 1e6, j["spread"][0].get<double>() / 1e6,
             j["spread"][1].get<double>() / 1e6, j["rays_per_s_per_core"].get<double>() / 1e6,
             j["scaling"].get<double>(), count_text(j["triangles"].get<double>()),
             bytes_text(j["peak_memory_bytes"].get<double>()));
}

}  // namespace

int bench_command(const Arguments& args) {
  std::vector<std::string> files;
  bool as_json = false;
  int runs = 5;
  CLI::App app("Measures rendering speed on built-in scenes, and on any given.", "whit bench");
  app.add_option("scenes", files, "Scene files to measure too");
  app.add_option("--runs", runs, "Counted runs of each measurement")->check(CLI::Range(1, 100));
  app.add_flag("--json", as_json, "Print the figures as JSON");
  int code = kDone;
  if (!parse_arguments(app, args, code)) return code;
  nlohmann::json rows = nlohmann::json::array();
  const auto add = [&](const std::string& name, Sources& sources, LoadedFile file) {
    Diagnostics& d = file.parsed.diagnostics;
    for (const SceneDescription& world : file.parsed.scenes) {
      if (d.has_errors()) break;
      const nlohmann::json row = bench_one(name, world, sources, runs, file.parse_seconds, file.parsed.bytes, d);
      if (row.is_null()) break;
      rows.push_back(row);
      if (!as_json) print_row(row);
    }
    print_diagnostics(sources, d);
    if (d.has_errors()) code = exit_code(d);
  };
  if (!as_json) {
    fmt::print("{}, medians of {} runs on one thread; M = million per second and core\n", accel_version(), runs);
    fmt::print("{:<20} {:>9} {:>15} {:>9} {:>8} {:>9} {:>9}\n", "scene", "M samples", "spread", "M rays", "scaling",
               "triangles", "memory");
  }
  for (const BenchScene& scene : bench_scenes()) {
    Sources sources;
    add(scene.name, sources, load_text(sources, scene.name, scene.text));
  }
  for (const std::string& path : files) {
    Sources sources;
    add(path, sources, load_file(sources, path));
  }
  if (as_json) fmt::print("{}\n", nlohmann::json{{"scenes", rows}}.dump(1));
  return code;
}

}  // namespace whit
