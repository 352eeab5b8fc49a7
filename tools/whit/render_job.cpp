// The steps of `whit render`: parse, plan, build, render, write; each says what went wrong before the next begins.

#include "tools/whit/render_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <optional>
#include <set>

#include "core/render/debug_sample.h"
#include "core/scene/problems.h"
#include "tools/whit/display_server.h"
#include "tools/whit/load.h"
#include "tools/whit/render_report.h"
#include "tools/whit/terminal.h"
#include "tools/whit/version.h"

namespace whit {
namespace {

double since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// One scene file on its way to pictures.
class RenderJob {
 public:
  RenderJob(const RenderSettings& settings, std::string path) : settings_(settings), path_(std::move(path)) {}

  int run() {
    LoadedFile file = load_file(sources_, path_);
    times_.parse = file.parse_seconds;
    parsed_memory_ = resident_memory();
    // A file with mistakes is reported whole: also what planning would have said of it.
    reported_whole_ = file.parsed.diagnostics.has_errors();
    const Diagnostics found = reported_whole_ ? all_problems(file, sources_) : file.parsed.diagnostics;
    if (int code = report(found); code != kDone) return code;
    if (file.parsed.scenes.empty()) return kSceneError;
    int worst = kDone;
    for (const SceneDescription& world : file.parsed.scenes) {
      const int code = render_world(world);
      if (code != kDone && code != kLimit) return code;
      worst = std::max(worst, code);
      times_ = {};
    }
    return worst;
  }

 private:
  /// Prints diagnostics; the exit code when they stop the render.
  int report(const Diagnostics& found) {
    const Diagnostics d = settings_.strict ? strict(found) : found;
    print_diagnostics(sources_, d, settings_.min_log_level >= 2);
    log(d);
    if (!d.has_errors()) return kDone;
    if (!settings_.keep_going) return exit_code(d);
    for (const Diagnostic& one : d.all()) {
      if (one.severity == Severity::Error) passed_.push_back(one);
    }
    say("going on with what is usable (--keep-going)");
    return kDone;
  }

  int refuse(const OutputProblem& problem) const {
    if (problem.diagnostic.where.known()) {
      Diagnostics d;
      d.add(problem.diagnostic);
      print_diagnostics(sources_, d);
      log(d);
    } else {
      say("whit: " + problem.diagnostic.message);
    }
    return problem.exit_code;
  }

  void log(const Diagnostics& d) const {
    if (settings_.log_dir.empty()) return;
    std::ofstream out(settings_.log_dir + "/whit.log", std::ios::app);
    for (const Diagnostic& one : d.all()) out << sources_.render_diagnostic(one, false);
  }

  int render_world(const SceneDescription& world) {
    Diagnostics diagnostics;
    PlannedScene planned = plan_scene(world, sources_, diagnostics, plan_options(settings_.effects));
    // What is wrong explains what is surprising.
    if (!diagnostics.has_errors()) diagnostics.append(find_surprises(world, planned.plan));
    if (reported_whole_) diagnostics = {};  // All of it has been said.
    times_.plan = planned.seconds;
    unread_.clear();
    for (const UnreadFile& file : world.unread_files) unread_.insert(file.path);
    if (int code = report(diagnostics); code != kDone) return code;
    if (!planned.bound.film.plugin) return kSceneError;

    OutputPlan output;
    if (const auto problem = plan_output(output_request(), planned.bound.film, output)) return refuse(*problem);
    for (const std::string& name : {output.main_file, output.display_file}) {
      if (name.empty() || written_.insert(name).second) continue;
      say(fmt::format("whit: warning: {} is written again by a later world of the same file", name));
    }
    const auto start = std::chrono::steady_clock::now();
    Diagnostics building;
    TextureStore textures;
    textures.set_memory_limit(static_cast<size_t>(settings_.texture_memory * 1024 * 1024));
    const std::unique_ptr<Scene> scene =
        build_scene(std::move(planned.bound), std::move(planned.plan), build_options(), textures, building);
    times_.build = since(start);
    if (int code = report(building); code != kDone) return code;
    if (!scene) return kSceneError;
    if (!settings_.debug_pixel.empty()) return explain_pixel(*scene, textures);
    return trace_and_write(*scene, output, textures);
  }

  /// What happens to the sample asked for; to the first that is no number, or else the brightest, when none is.
  int explain_pixel(const Scene& scene, const TextureStore& textures) {
    const std::vector<int> asked = numbers_of(settings_.debug_pixel);
    const Vec2i pixel(asked[0], asked[1]), size = scene.camera().film.resolution;
    const int last = scene.samples_per_pixel - 1;
    if (pixel.x < 0 || pixel.y < 0 || pixel.x >= size.x || pixel.y >= size.y ||
        (asked.size() == 3 && (asked[2] < 0 || asked[2] > last))) {
      say(fmt::format("whit: --debug-pixel: there are pixels 0,0 to {},{} with samples 0 to {}", size.x - 1, size.y - 1,
                      last));
      return kUsage;
    }
    const auto place = [this](SourcePos where) {
      const SourcePlace p = sources_.place(where);
      return fmt::format("{}:{}:{}", sources_.name(where.file), p.line, p.column);
    };
    const uint32_t sample = asked.size() == 3 ? static_cast<uint32_t>(asked[2]) : odd_sample(scene, pixel);
    const std::string account = debug_sample(scene, pixel, sample, place);
    if (const int code = report(textures.errors()); code != kDone) return code;
    fmt::print("{}", account);
    return kDone;
  }

  OutputRequest output_request() const {
    OutputRequest request = settings_.output;
    request.scene_path = path_;
    request.full_float = settings_.half_or_float == "float";
    return request;
  }

  BuildOptions build_options() const {
    BuildOptions o;
    o.samples_per_pixel = settings_.spp;
    o.seed = settings_.seed;
    o.quick = settings_.quick;
    o.robust_traversal = settings_.traversal == "robust";
    o.keep_going = settings_.keep_going;
    return o;
  }

  int trace_and_write(const Scene& scene, const OutputPlan& output, const TextureStore& textures) {
    const RenderResult result = trace(scene, textures);
    times_.render = result.seconds;
    if (int code = report(textures.errors()); code != kDone) return code;
    const auto start = std::chrono::steady_clock::now();
    std::vector<std::string> notes;
    const std::string problem = write_output(output, result.picture, metadata(scene, result), notes);
    times_.write = since(start);
    for (const std::string& note : notes) say("whit: warning: " + note);
    if (!problem.empty()) {
      say("whit: " + problem);
      return kFileError;
    }
    if (result.statistics.invalid_samples > 0) report_invalid(result.statistics);
    if (settings_.quiet) return kDone;
    summarise({scene, result, output, textures, times_, unread_.size(), parsed_memory_}, settings_.stats);
    if (!passed_.empty()) name_what_was_passed();
    return kDone;
  }

  /// The end of a summary where --keep-going went past errors.
  void name_what_was_passed() const {
    const Diagnostic& first = passed_.front();
    const size_t n = passed_.size();
    const std::string where =
        first.where.known() ? fmt::format(" ({}:{})", sources_.name(first.where.file), sources_.place(first.where).line)
                            : "";
    say(fmt::format("The picture is not the whole scene: {} passed over, {}{}{}.",
                    n == 1 ? "1 error was" : fmt::format("{} errors were", n),
                    n == 1 ? "" : "the first: ", first.message, where));
  }

  /// Renders; a texture that cannot be read ends it, for there will be no picture.
  RenderResult trace(const Scene& scene, const TextureStore& textures) const {
    RenderOptions options;
    options.threads = settings_.threads;
    const Vec2i size = scene.camera().film.resolution;
    if (!settings_.crop.empty()) {
      options.crop_given = true;
      std::copy(settings_.crop.begin(), settings_.crop.end(), options.crop);
    }
    if (!settings_.pixel.empty()) {
      options.crop_given = true;
      for (int axis = 0; axis < 2; ++axis) {
        const double n = axis == 0 ? size.x : size.y, p = settings_.pixel[static_cast<size_t>(axis)];
        options.crop[2 * axis] = (p - 0.5) / n, options.crop[2 * axis + 1] = (p + 0.5) / n;
      }
    }
    DisplayServer viewer;
    if (!settings_.display_server.empty()) show_in(viewer, size, options);
    const auto finish = [&](RenderResult result) {
      if (options.tile_done) viewer.update(result.picture.window, result.picture.rgb);
      return result;
    };
    std::optional<Progress> progress;
    if (!settings_.quiet) progress.emplace("rendering");
    options.progress = [&](double share) {
      if (progress) progress->update(share);
      return settings_.keep_going || !textures.failed();
    };
    return finish(render(scene, options));
  }

  /// Previews go to the viewer while it can be reached; the render does not depend on it.
  void show_in(DisplayServer& viewer, Vec2i size, RenderOptions& options) const {
    if (const std::string problem = viewer.connect(settings_.display_server); !problem.empty()) {
      say("whit: warning: " + problem);
      return;
    }
    viewer.create(path_, size);
    options.tile_done = [&viewer](const Box2i& window, std::span<const float> rgb) { viewer.update(window, rgb); };
  }

  std::vector<OutputMetadata> metadata(const Scene& scene, const RenderResult& result) const {
    return {{"Software", fmt::format("whit {}", version())},
            {"whit:command", settings_.command_line},
            {"whit:scene", path_},
            {"whit:samplesPerPixel", scene.samples_per_pixel},
            {"whit:seed", static_cast<int>(settings_.seed)},
            {"whit:renderSeconds", static_cast<float>(result.seconds)}};
  }

  const RenderSettings& settings_;
  const std::string path_;
  Sources sources_;
  StepTimes times_;
  double parsed_memory_ = 0;        ///< Resident after parsing, in bytes.
  std::set<std::string> written_;   ///< Pictures of this file's worlds.
  bool reported_whole_ = false;     ///< What planning finds has been said with what parsing found.
  std::vector<Diagnostic> passed_;  ///< Errors that --keep-going went past.
  std::set<std::string> unread_;    ///< Files of objects that this world never places.
};

}  // namespace

int render_file(const RenderSettings& settings, const std::string& path) { return RenderJob(settings, path).run(); }

}  // namespace whit
