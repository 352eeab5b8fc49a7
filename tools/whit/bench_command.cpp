// `whit bench`: how fast, and how near to what casting the rays alone would take.

#include <fmt/format.h>

#include <filesystem>

#include "core/accel/accel.h"
#include "tools/whit/bench_ingestion.h"
#include "tools/whit/bench_measure.h"
#include "tools/whit/bench_scenes.h"
#include "tools/whit/command_line.h"
#include "tools/whit/terminal.h"

namespace whit {
namespace {

/// A folder for the files of built-in scenes, gone at the end.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "whit-bench-XXXXXX").string();
    if (!::mkdtemp(name.data())) throw std::runtime_error(fmt::format("cannot make the folder {}", name));
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

void print_heading(int runs) {
  fmt::print("{}, robust traversal, one thread, medians of {} runs; M = million per second and core\n", accel_version(),
             runs);
  fmt::print("{:<14} {:>8} {:>12} {:>7} {:>6} {:>8} {:>7} {:>9} {:>7} {:>7} {:>9} {:>9}\n", "scene", "Msample",
             "spread", "Mray", "/floor", "scaling", "fast", "missed", "MB/s", "Mtri/s", "triangles", "memory");
}

void print_row(const nlohmann::json& j) {
  const auto millions = [](const nlohmann::json& v) { return v.get<double>() / 1e6; };
  const auto& fast = j["fast_traversal"];
  fmt::print(
      "{:<14} {:>8.2f} {:>5.2f}-{:<6.2f} {:>7.2f} {:>6.2f} {:>8.2f} {:>7.2f} {:>8.2f}% {:>7.0f} {:>7.2f} {:>9} {:>9}\n",
      j["name"].get<std::string>(), millions(j["camera_samples_per_s_per_core"]), millions(j["spread"][0]),
      millions(j["spread"][1]), millions(j["rays_per_s_per_core"]["all"]), j["floor_ratio"].get<double>(),
      j["scaling"].get<double>(), millions(fast["camera_samples_per_s_per_core"]),
      100 * fast["missed_edges"].get<double>(), j["parse_mb_per_s"].get<double>(), j["build_mtris_per_s"].get<double>(),
      count_text(j["triangles"].get<double>()), bytes_text(j["peak_memory_bytes"].get<double>()));
  std::string stages;
  for (const char* name : kStageNames) {
    const double share = j["stages"][name].get<double>();
    if (share >= 0.005) stages += fmt::format("  {} {:.0f} %", name, 100 * share);
  }
  fmt::print("  {}\n", stages);
}

void print_ingestion(const Ingestion& i) {
  const auto line = [](const std::string& what, const Spread& s, const char* unit, int digits) {
    fmt::print("{:<45} {:>8.{}f} {} ({:.{}f}-{:.{}f})\n", what, s.median, digits, unit, s.low, digits, s.high, digits);
  };
  line(fmt::format("scene text, {:.0f} MB of inline meshes", i.text_megabytes), i.text_mb_per_s, "MB/s", 0);
  line(fmt::format("a PLY mesh, binary, {:.0f} MB", i.ply_megabytes), i.ply_mb_per_s, "MB/s", 0);
  line(fmt::format("its {:.2f} M triangles, made traceable", i.triangles / 1e6), i.build_mtris_per_s, "Mtri/s", 2);
}

}  // namespace

int bench_command(const Arguments& args) {
  std::vector<std::string> files, only;
  bool as_json = false;
  BenchSettings settings;
  IngestionSettings reading;
  CLI::App app("Measures the speed of reading, and of rendering built-in scenes and any given.", "whit bench");
  app.add_option("scenes", files, "Scene files to measure too");
  std::vector<std::string> names{"ingestion"};
  for (const BenchScene& scene : bench_scenes()) names.push_back(scene.name);
  app.add_option("--only", only, "Measure these alone: built-in scenes, or 'ingestion', the reading")
      ->delimiter(',')
      ->check(CLI::IsMember(names));
  app.add_option("--text-mb", reading.text_megabytes, "Megabytes of scene text to read")->check(CLI::Range(1.0, 1e5));
  app.add_option("--runs", settings.runs, "Counted runs of each measurement")->check(CLI::Range(1, 100));
  app.add_flag("--json", as_json, "Print the figures as JSON");
  int code = kDone;
  if (!parse_arguments(app, args, code)) return code;
  const auto wanted = [&](const std::string& name) {
    return only.empty() || std::find(only.begin(), only.end(), name) != only.end();
  };
  nlohmann::json rows = nlohmann::json::array(), report;
  const auto add = [&](const std::string& name, Sources& sources, LoadedFile file) {
    Diagnostics& d = file.parsed.diagnostics;
    for (const SceneDescription& world : file.parsed.scenes) {
      if (d.has_errors()) break;
      const nlohmann::json row = measure_scene(name, file, world, sources, settings, d);
      if (row.is_null()) break;
      if (!as_json && rows.empty()) print_heading(settings.runs);
      if (!as_json) print_row(row);
      rows.push_back(row);
    }
    print_diagnostics(sources, d);
    if (d.has_errors()) code = exit_code(d);
  };
  const TemporaryFolder folder;
  if (wanted("ingestion")) {
    reading.runs = settings.runs;
    const Ingestion ingestion = measure_ingestion(folder.path(), reading);
    report["ingestion"] = to_json(ingestion);
    if (!as_json) print_ingestion(ingestion);
  }
  for (const BenchScene& scene : bench_scenes()) {
    if (!wanted(scene.name)) continue;
    Sources sources;
    add(scene.name, sources, load_text(sources, scene.name, scene.text(folder.path())));
  }
  for (const std::string& path : files) {
    Sources sources;
    add(path, sources, load_file(sources, path));
  }
  report["scenes"] = rows;
  if (as_json) fmt::print("{}\n", report.dump(1));
  return code;
}

}  // namespace whit
