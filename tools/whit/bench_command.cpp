// `whit bench`: how fast, and how near to what casting the rays alone would take.

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "tools/whit/bench_ingestion.h"
#include "tools/whit/bench_measure.h"
#include "tools/whit/bench_report.h"
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

/// Writes the built-in scenes that are wanted as NAME.pbrt, for other programs to render.
template <class Wanted>
int write_scenes(const std::string& folder, const Wanted& wanted) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  for (const BenchScene& scene : bench_scenes()) {
    if (!wanted(scene.name)) continue;
    const std::string path = folder + "/" + scene.name + ".pbrt";
    std::ofstream out(path);
    if (out) out << scene.text(folder);
    out.close();
    if (!out) {
      say(fmt::format("whit bench: cannot write {}", path));
      return kFileError;
    }
    fmt::print("{}\n", path);
  }
  return kDone;
}

}  // namespace

int bench_command(const Arguments& args) {
  std::vector<std::string> files, only;
  std::string write_to;
  bool as_json = false;
  BenchSettings settings;
  IngestionSettings reading;
  std::vector<std::string> names{"ingestion"};
  for (const BenchScene& scene : bench_scenes()) names.push_back(scene.name);
  const CommandLine command{
      "whit bench",
      "Measures the speed of reading, and of rendering built-in scenes and any given.",
      {{"scenes", &files, "Scene files to measure too"},
       {"--only",
        &only,
        "Measure these alone: built-in scenes, or 'ingestion', the reading",
        {.choices = names, .delimiter = ','}},
       {"--text-mb", &reading.text_megabytes, "Megabytes of scene text to read", {.least = 1, .most = 1e5}},
       {"--runs", &settings.runs, "Counted runs of each measurement", {.least = 1, .most = 100}},
       {"--write", &write_to, "Write the built-in scenes into this folder instead, as NAME.pbrt", {.files = "/"}},
       {"--json", &as_json, "Print the figures as JSON"}}};
  int code = kDone;
  if (!parse_arguments(command, args, code)) return code;
  const auto wanted = [&](const std::string& name) {
    return only.empty() || std::find(only.begin(), only.end(), name) != only.end();
  };
  if (!write_to.empty()) return write_scenes(write_to, wanted);
  Json::Array rows;
  Json::Object report;
  const auto add = [&](const std::string& name, const ParsedFile& file) {
    Diagnostics d = file.said;
    for (const SceneDescription& world : file.worlds) {
      if (d.has_errors()) break;
      const std::optional<SceneFigures> figures = measure_scene(name, file, world, settings, d);
      if (!figures) break;
      if (!as_json && rows.empty()) print_heading(settings.runs);
      if (!as_json) print_row(*figures);
      rows.push_back(to_json(*figures));
    }
    print_diagnostics(*file.sources, d);
    if (d.has_errors()) code = exit_code(d);
  };
  const TemporaryFolder folder;
  if (wanted("ingestion")) {
    reading.runs = settings.runs;
    const Ingestion ingestion = measure_ingestion(folder.path(), reading);
    report.emplace_back("ingestion", to_json(ingestion));
    if (!as_json) print_ingestion(ingestion);
  }
  for (const BenchScene& scene : bench_scenes()) {
    if (wanted(scene.name)) add(scene.name, read_scene_text(scene.name, scene.text(folder.path())));
  }
  for (const std::string& path : files) add(path, read_scene(path));
  report.emplace_back("scenes", rows);
  if (as_json) fmt::print("{}\n", to_text(report));
  return code;
}

}  // namespace whit
