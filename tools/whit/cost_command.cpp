// `whit cost`: what accuracy costs in time, for the scene at hand.

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <ctime>
#include <fstream>
#include <memory>

#include "core/accuracy/cost.h"
#include "core/accuracy/report.h"
#include "tools/whit/command_line.h"
#include "tools/whit/load.h"
#include "tools/whit/memory_flags.h"
#include "tools/whit/model_flags.h"
#include "tools/whit/quantities.h"
#include "tools/whit/stop_signals.h"
#include "tools/whit/terminal.h"
#include "tools/whit/text_file.h"

namespace whit {
namespace {

constexpr int kColumns = 100;  ///< Of a report where there is no terminal.

struct CostFlags {
  std::string scene, time = "60s", html, json, csv;
  bool quick = false, all_samplers = false;
  int threads = 0;
  uint32_t seed = 0;
  ModelFlags model;
  MemoryFlags memory;
};

/// "" or what is wrong with the flags.
std::string usage_problem(const CostFlags& flags) {
  if (duration_of(flags.time) == 0) {
    return fmt::format("--time: \"{}\" is no time above 0; write 60s, 2min, 1500ms or 60", flags.time);
  }
  if (is_stdout(flags.html) + is_stdout(flags.json) + is_stdout(flags.csv) > 1)
    return "standard output can hold one of --html, --json and --csv";
  return {};
}

/// The first of the files that cannot be written, or "".
std::string file_problem(const CostFlags& flags) {
  for (const std::string& path : {flags.html, flags.json, flags.csv}) {
    if (std::string problem = text_file_problem(path); !problem.empty()) return problem;
  }
  return {};
}

/// How the program was called: a command to paste must call it likewise.
std::string program() {
  std::ifstream command("/proc/self/cmdline");
  std::string name;
  std::getline(command, name, '\0');
  return name.empty() ? "whit" : name;
}

CostStudy study(const CostFlags& flags, ParsedFile& file, CostRequest request) {
  const StopSignals stop;  // Ctrl-C ends the study, which then reports what it has.
  Progress progress("measuring");
  request.seconds = duration_of(flags.time);
  request.quick = flags.quick, request.all_samplers = flags.all_samplers;
  request.threads = flags.threads, request.seed = flags.seed;
  request.scene_path = flags.scene, request.program = program();
  request.progress = [&](double share, const std::string&) {
    progress.update(share);
    return !StopSignals::come();
  };
  return study_cost(file, 0, request);
}

/// Writes the report in all forms asked for; the table goes where it is in nobody's way.
int write_report(const CostFlags& flags, const CostReport& report) {
  int code = kDone;
  const auto write = [&](const std::string& path, const std::string& text) {
    const std::string problem = write_text(path, text);
    if (problem.empty()) return;
    say("whit cost: " + problem);
    code = kFileError;
  };
  if (!flags.json.empty()) write(flags.json, cost_json(report));
  if (!flags.csv.empty()) write(flags.csv, cost_csv(report));
  if (!flags.html.empty()) write(flags.html, cost_html(report));
  const bool taken = is_stdout(flags.html) || is_stdout(flags.json) || is_stdout(flags.csv);
  if (taken) fmt::print(stderr, "{}", cost_text(report, use_colour(), columns_of(STDERR_FILENO, kColumns)));
  else write("-", cost_text(report, use_colour() && isatty(STDOUT_FILENO) != 0, columns_of(STDOUT_FILENO, kColumns)));
  return code;
}

int run(const CostFlags& flags, const CostRequest& begun) {
  ParsedFile file = read_scene(flags.scene, read_options(flags.model));
  if (file.said.has_errors() || file.worlds.empty()) {
    const Diagnostics all = all_problems(file);
    print_diagnostics(*file.sources, all);
    return all.has_errors() ? exit_code(all) : kSceneError;
  }
  print_diagnostics(*file.sources, file.said);
  CostRequest request = begun;
  request.before.cpu = static_cast<double>(std::clock()) / CLOCKS_PER_SEC;  // Since the program was started.
  request.before.wall = file.elapsed.wall;
  const CostStudy result = study(flags, file, request);
  print_diagnostics(*file.sources, result.said);
  if (result.said.has_errors()) return exit_code(result.said);
  const int written = write_report(flags, result.report);
  if (written != kDone) return written;
  if (StopSignals::come()) return kLimit;
  if (!result.report.settings.empty()) return kDone;
  return result.report.complete ? kNo : kLimit;  // Nothing can be told of this picture, or not in this time.
}

}  // namespace

int cost_command(const Arguments& args) {
  const CostRequest begun;  // Its clock runs from here.
  CostFlags flags;
  CommandLine command{
      "whit cost",
      "Measures what accuracy costs in time for a scene, and what its settings bring.",
      {{"scene", &flags.scene, "Scene file; - is standard input", {.required = true}},
       {"--time", &flags.time, "Time for all of it: 60s, 2min, 1500ms"},
       {"--html", &flags.html, "Write the report as one page; - is standard output, for all three", {.files = "html"}},
       {"--json", &flags.json, "Write it for programs", {.files = "json"}},
       {"--csv", &flags.csv, "Write the settings as a table", {.files = "csv"}},
       {"--quick", &flags.quick, "Samples alone: no other settings, no effects"},
       {"--all-samplers", &flags.all_samplers, "Every sampler, not only the scene's, sobol and random"},
       {"--seed", &flags.seed, "Seed of the first of the pictures that are compared"},
       {"--nthreads", &flags.threads, "Threads; 0 is one per core", {.least = 0, .most = 4096}},
       memory_flag(flags.memory)}};
  add_model_flags(command, flags.model, false);
  int code = kDone;
  if (!parse_arguments(command, args, code)) return code;
  std::string problem = usage_problem(flags);
  if (problem.empty()) problem = usage_problem(flags.model, flags.scene);
  if (problem.empty()) problem = usage_problem(flags.memory);
  code = kUsage;
  if (problem.empty()) problem = file_problem(flags), code = kFileError;
  if (!problem.empty()) {
    say("whit cost: " + problem);
    return code;
  }
  set_memory_limit(flags.memory);
  std::unique_ptr<tbb::global_control> threads;
  if (flags.threads > 0) {
    threads = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                    static_cast<size_t>(flags.threads));
  }
  return run(flags, begun);
}

}  // namespace whit
