// `whit render`: what is asked for, and then a job for each scene file.

#include <tbb/global_control.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <utility>

#include "parser/format.h"
#include "tools/whit/load.h"
#include "tools/whit/render_flags.h"
#include "tools/whit/render_job.h"
#include "tools/whit/terminal.h"

namespace whit {
namespace {

/// Also of what was rendered before something failed.
int write_stats(const RenderStats& stats, const std::string& path) {
  const std::string problem = stats.write(path);
  if (problem.empty()) return kDone;
  say("whit: " + problem);
  return kFileError;
}

/// What the flags name. A picture that no flag names is written to the current folder.
SandboxRequest sandbox_request(const RenderSettings& s) {
  SandboxRequest request;
  for (const std::string& scene : s.scenes) request.read.push_back(folder_to_read(scene));
  request.read.push_back(s.output.ocio);
  if (const char* config = std::getenv("OCIO")) request.read.emplace_back(config);
  request.write = {s.output.outfile.empty() && !s.output.unwritten ? "picture" : s.output.outfile,
                   s.output.display == "none" ? "" : s.output.display,
                   s.stats_file,
                   s.target.json,
                   s.checkpoint.kept_in(),
                   s.log_dir.empty() ? "" : s.log_dir + "/whit.log"};
  request.read.push_back(s.checkpoint.resume);
  request.read.push_back(s.passes.pass);
  return request;
}

/// --cat and --toply.
int print_normal_form(const RenderSettings& s) {
  int code = kDone;
  for (const std::string& path : s.scenes) {
    Sources sources;
    FormatOptions options;
    options.expand_includes = true;
    options.to_ply = s.toply;
    if (path != "-") options.ply_folder = std::filesystem::path(path).parent_path().string();
    Diagnostics d;
    std::optional<std::string> piped;
    if (path != "-") d = format_file(sources, path, std::cout, options);
    else if (piped = read_standard_input(d); piped)
      d = format_text(sources, "<stdin>", std::move(*piped), "", std::cout, options);
    print_diagnostics(sources, d);
    code = std::max(code, exit_code(d));
  }
  return code;
}

}  // namespace

int render_command(const Arguments& args) {
  BeforeScene before{process_age(), {}};
  const Stopwatch reading_flags;
  RenderSettings settings;
  int code = kDone;
  if (!read_render_flags(args, settings, code)) return code;
  if (settings.denoise) {
    // Before the sandbox, which may forbid where it lies.
    DenoiserResult loaded = load_denoiser();
    if (!loaded.denoiser) {
      say("whit: --denoise: " + loaded.error);
      return kUsage;
    }
    settings.denoiser = std::move(loaded.denoiser);
  }
  if (const std::string problem = enter_sandbox(settings.sandbox, sandbox_request(settings)); !problem.empty()) {
    say("whit: " + problem);
    return kFileError;
  }
  if (settings.cat || settings.toply) return print_normal_form(settings);
  before.flags = reading_flags.elapsed();
  return render_scenes(settings, before);
}

int render_scenes(const RenderSettings& settings, BeforeScene before) {
  set_memory_limit(settings.memory);
  std::unique_ptr<tbb::global_control> threads;
  if (settings.threads > 0) {
    threads = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                    static_cast<size_t>(settings.threads));
  }
  RenderStats stats(settings.scenes.size());
  int code = kDone;
  for (const std::string& scene : settings.scenes) {
    if (code = render_file(settings, scene, before, stats); code != kDone) break;
    before = {};
  }
  explain_sandbox(settings.sandbox, code);
  return std::max(code, write_stats(stats, settings.stats_file));
}

}  // namespace whit
