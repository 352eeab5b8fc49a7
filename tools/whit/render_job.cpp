// The steps of `whit render`: parse, plan, build, render, write; each says what went wrong before the next begins.

#include "tools/whit/render_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <new>
#include <optional>
#include <set>
#include <string>
#include <tuple>

#include "core/base/file_names.h"
#include "core/plugin/memory_limit.h"
#include "core/render/debug_sample.h"
#include "core/render/film_render.h"
#include "core/scene/problems.h"
#include "core/session/checkpoint.h"
#include "core/session/denoised.h"
#include "core/session/files.h"
#include "core/session/memory.h"
#include "core/session/parts.h"
#include "core/session/pass_file.h"
#include "tools/whit/display_server.h"
#include "tools/whit/load.h"
#include "tools/whit/quantities.h"
#include "tools/whit/render_report.h"
#include "tools/whit/render_target.h"
#include "tools/whit/stop_signals.h"
#include "tools/whit/terminal.h"
#include "tools/whit/version.h"

namespace whit {
namespace {

/// One scene file on its way to pictures.
class RenderJob {
 public:
  /// `step` says what is being done, for whoever needs to know when it fails.
  RenderJob(const RenderSettings& settings, std::string path, const BeforeScene& before, RenderStats& stats,
            const char*& step)
      : settings_(settings),
        path_(std::move(path)),
        stats_(stats),
        step_(step),
        file_(read_scene(path_, read_options(settings.model))),
        parsed_memory_(static_cast<double>(resident_memory())) {
    times_.program = before.program, times_.flags = before.flags;
  }

  int run() {
    const std::string problem = override_worlds(file_, settings_.effects.overrides);
    if (problem.empty() && settings_.target.any()) use_extending_samplers(settings_, file_);
    times_.parse = file_.elapsed;
    // A file with mistakes is reported whole: also what planning would have said of it.
    reported_whole_ = file_.said.has_errors();
    if (int code = report(reported_whole_ ? all_problems(file_) : file_.said); code != kDone) return code;
    if (file_.worlds.empty()) return kSceneError;
    if (!settings_.quiet) {
      for (const std::string& note : file_.notes) say("whit: " + note);
    }
    if (!problem.empty()) {
      say("whit: " + problem);
      return kUsage;
    }
    if (settings_.checkpoint.any() && file_.worlds.size() > 1) {
      say(fmt::format("whit: a checkpoint is of one picture, and {} makes {}", path_, file_.worlds.size()));
      return kUsage;
    }
    stats_.expect(file_.worlds.size());
    int worst = kDone;
    for (const SceneDescription& world : file_.worlds) {
      const int code = picture_of(world);
      if (code != kDone && code != kLimit) return code;
      worst = std::max(worst, code);
      if (StopSignals::come()) break;
      times_ = {}, world_started_ = {};
    }
    return worst;
  }

 private:
  /// Prints diagnostics; the exit code when they stop the render.
  int report(const Diagnostics& found) {
    const Diagnostics d = settings_.strict ? strict(found) : found;
    const Diagnostics news = not_said_yet(d);
    print_diagnostics(sources_, news, settings_.min_log_level >= 2);
    log(news);
    if (!d.has_errors()) return kDone;
    if (!settings_.keep_going) return exit_code(d);
    for (const Diagnostic& one : news.all()) {
      if (one.severity == Severity::Error) passed_.push_back(one);
    }
    if (news.has_errors()) say("going on with what is usable (--keep-going)");
    return kDone;
  }

  /// Going past an error, a later step meets it again, and so does another world of the same file.
  Diagnostics not_said_yet(const Diagnostics& d) {
    Diagnostics news;
    for (const Diagnostic& one : d.all()) {
      if (!one.where.known() || said_.emplace(one.where.file, one.where.offset, one.message).second) news.add(one);
    }
    return news;
  }

  /// Says what there is to say of the files to be written, and the first error. Without a place in the scene they are of
  /// the command line or of the disk, and end the render in any case.
  int report_output(const Diagnostics& said) const {
    for (const Diagnostic& d : said.all()) {
      if (d.severity == Severity::Warning) say("whit: warning: " + d.message);
    }
    for (const Diagnostic& d : said.all()) {
      if (d.severity != Severity::Error) continue;
      Diagnostics first;
      first.add(d);
      if (d.where.known()) {
        print_diagnostics(sources_, first);
        log(first);
      } else {
        say("whit: " + d.message);
      }
      return exit_code(first);
    }
    return kDone;
  }

  /// Says what a limit forbids, which --keep-going does not go past.
  int report_limit(const Diagnostics& said) const {
    print_diagnostics(sources_, said);
    log(said);
    return exit_code(said);
  }

  void log(const Diagnostics& d) const {
    if (settings_.log_dir.empty()) return;
    std::ofstream out(settings_.log_dir + "/whit.log", std::ios::app);
    for (const Diagnostic& one : d.all()) out << sources_.render_diagnostic(one, false);
  }

  int picture_of(const SceneDescription& world) {
    step_ = "planning the scene";
    PlannedWorld planned = plan_world(world, sources_, plan_options(settings_.effects));
    // What is wrong explains what is surprising.
    if (!planned.said.has_errors()) planned.said.append(find_surprises(world, planned.plan));
    if (reported_whole_) planned.said = {};  // All of it has been said.
    times_.plan = planned.elapsed;
    unread_.clear();
    for (const UnreadFile& file : world.unread_files) unread_.insert(file.path);
    if (int code = report(planned.said); code != kDone) return code;
    if (!planned.bound.film.plugin) return kSceneError;

    const Stopwatch planning_output;
    OutputPlan output = plan_output(output_request(world), planned.bound.film);
    if (settings_.denoiser && !output.said.has_errors()) {
      render_guides(output);
      if (denoises()) denoised_ = plan_denoised(output_request(world), output, planned.bound.film);
      output.said.append(denoised_.said);
    }
    times_.output = planning_output.elapsed();
    if (int code = report_output(output.said); code != kDone) return code;
    for (const std::string& name : {output.main_file, output.display_file}) {
      if (name.empty() || written_.insert(name).second) continue;
      say(fmt::format("whit: warning: {} is written again by a later world of the same file", name));
    }
    const Stopwatch estimating;
    MemoryPlan memory = plan_memory(planned, memory_request(*planned.bound.film.plugin, output));
    memory_estimate_ = memory.total();
    fit_textures(memory, memory_limit());
    times_.plan += estimating.elapsed();
    if (int code = report_limit(memory_problem(memory, memory_limit())); code != kDone) return code;
    step_ = "building the scene";
    BuiltWorld built = build_world(std::move(planned), build_options(), static_cast<size_t>(memory.texture_cap()));
    times_.build = built.elapsed;
    if (int code = report(built.said); code != kDone) return code;
    if (!built.scene) return kSceneError;
    return settings_.debug_pixel.empty() ? trace_and_write(built, output) : explain_pixel(built);
  }

  /// What happens to the sample asked for; to the first that is no number, or else the brightest, when none is.
  int explain_pixel(const BuiltWorld& built) {
    const Scene& scene = *built.scene;
    const std::vector<int> asked = numbers_of(settings_.debug_pixel);
    const Vec2i pixel(asked[0], asked[1]), size = scene.camera().film.resolution;
    const int last = scene.samples_per_pixel - 1;
    if (pixel.x < 0 || pixel.y < 0 || pixel.x >= size.x || pixel.y >= size.y ||
        (asked.size() == 3 && (asked[2] < 0 || asked[2] > last))) {
      say(fmt::format("whit: --debug-pixel: there are pixels 0,0 to {},{} with samples 0 to {}", size.x - 1, size.y - 1,
                      last));
      return kUsage;
    }
    const uint32_t sample = asked.size() == 3 ? static_cast<uint32_t>(asked[2]) : odd_sample(scene, pixel);
    const std::string account = debug_sample(scene, pixel, sample, [this](SourcePos where) { return place(where); });
    if (const int code = report(built.textures->errors()); code != kDone) return code;
    fmt::print("{}", account);
    return kDone;
  }

  /// "scene.pbrt:12:3" for a statement.
  std::string place(SourcePos where) const {
    const SourcePlace p = sources_.place(where);
    return fmt::format("{}:{}:{}", sources_.name(where.file), p.line, p.column);
  }

  OutputRequest output_request(const SceneDescription& world) const {
    OutputRequest request = settings_.output;
    request.scene_path = path_;
    request.read = files_read(world);
    request.full_float = settings_.half_or_float == "float";
    return request;
  }

  MemoryRequest memory_request(const Film& of, const OutputPlan& output) const {
    MemoryRequest request;
    request.texture_bytes = static_cast<size_t>(settings_.texture_memory * 1024 * 1024);
    FilmNeed& film = request.film;
    film.threads = settings_.threads;
    film.crop_given = find_crop(of.resolution(), film.crop);
    film.quick = settings_.quick;
    film.aovs = output.rendered_aovs();
    film.blocks = settings_.target.any(), film.adaptive = !settings_.target.error.empty();
    film.linear = settings_.output.unwritten || is_linear_format(output.main_file);
    film.display = !film.linear || !output.display_file.empty();
    film.denoise = denoises();
    return request;
  }

  BuildOptions build_options() const {
    BuildOptions o;
    o.samples_per_pixel = settings_.spp;
    o.footprint_samples = settings_.footprint_spp;
    o.seed = settings_.seed;
    o.quick = settings_.quick;
    o.robust_traversal = settings_.traversal == "robust";
    o.keep_going = settings_.keep_going;
    return o;
  }

  int trace_and_write(BuiltWorld& built, const OutputPlan& output) {
    const StopSignals stop;
    step_ = "rendering";
    DisplayServer viewer;
    const Stopwatch connecting;
    RenderOptions options = render_options(built, output.rendered_aovs(), viewer);
    if (int code = open_pass(); code != kDone) return code;
    if (int code = keep_state(*built.scene, options); code != kDone) return code;
    times_.output += connecting.elapsed();
    times_.ready = times_.program + times_.flags + world_started_.elapsed();
    if (pass_) return trace_share(built, std::move(options), output, viewer);
    if (settings_.target.any()) return approach_and_write(built, options, output, viewer);
    if (int code = check_part(*built.scene, options); code != kDone) return code;
    const RenderedWorld rendered = settings_.parts ? join(built, options) : trace(built, options);
    if (int code = write_and_say(built, rendered, output, viewer); code != kDone) return code;
    if (rendered.result.complete) return kDone;
    return settings_.parts ? say_missing(rendered.result) : say_stopped(rendered.result);
  }

  /// Where the flags ask for a share of a pass: it must be one of this render's.
  int open_pass() {
    const std::string& path = settings_.passes.pass;
    if (path.empty()) return kDone;
    pass_ = std::make_unique<PassFile>(path);
    const std::string other = pass_->problem.empty() ? difference(pass_->identity, identity_of_whole()) : "";
    if (!other.empty())
      say(fmt::format("whit: cannot take a share of \"{}\", which is of another render: {}", path, other));
    if (!pass_->problem.empty()) say(fmt::format("whit: cannot take a share of \"{}\": {}", path, pass_->problem));
    return !pass_->problem.empty() ? kFileError : other.empty() ? kDone : kUsage;
  }

  int trace_share(BuiltWorld& built, RenderOptions options, const OutputPlan& output, DisplayServer& viewer) {
    std::optional<Progress> progress;
    if (!settings_.quiet) progress.emplace("rendering");
    options.progress = shown_by(progress);
    const std::optional<RenderedWorld> rendered =
        render_share(built, std::move(options), pass_->pass, *share_of_text(settings_.passes.share), settings_.seed);
    progress.reset();
    if (!rendered) {
      say(fmt::format("whit: cannot take a share of \"{}\": its film is of another kind", settings_.passes.pass));
      return kFileError;
    }
    if (int code = write_and_say(built, *rendered, output, viewer); code != kDone) return code;
    return rendered->result.complete ? kDone : say_stopped(rendered->result);
  }

  /// Takes the part of the picture that the flags ask for, which must be one; and parts that are joined must make up all
  /// of it.
  int check_part(const Scene& scene, RenderOptions& options) const {
    const Vec2i size = scene.camera().film.resolution;
    const std::vector<int>& crop = settings_.crop_pixels;
    std::string problem;
    if (!crop.empty() && (crop[1] > size.x || crop[3] > size.y))
      problem = fmt::format("--crop-pixels: the picture has {} x {} pixels", size.x, size.y);
    if (!settings_.sample_range.empty()) {
      options.part = samples_of(settings_.sample_range, static_cast<uint32_t>(scene.samples_per_pixel));
      const SampleRange& range = *options.part;
      if (range.first >= range.last || range.last > range.whole) {
        problem = fmt::format("--sample-range: {} is none of the {} samples of a pixel, which are 0:{}",
                              settings_.sample_range, range.whole, range.whole);
      }
    }
    if (settings_.parts && problem.empty()) problem = identity_problem(*settings_.parts, identity());
    if (settings_.parts && problem.empty()) problem = cover_problem(*settings_.parts, window_of(scene, options));
    if (problem.empty()) return kDone;
    say("whit: " + problem);
    return kUsage;
  }

  static Box2i window_of(const Scene& scene, const RenderOptions& options) {
    double crop[4];
    scene.film().crop_window(crop);
    return crop_pixels(scene.camera().film.resolution, options.crop_given ? options.crop : crop);
  }

  RenderedWorld join(const BuiltWorld& built, const RenderOptions& options) const {
    return join_parts(built, options, *settings_.parts, window_of(*built.scene, options));
  }

  /// Where the flags ask for it, the options' film is kept in a file, and is what was kept before.
  int keep_state(const Scene& scene, RenderOptions& options) {
    const CheckpointFlags& flags = settings_.checkpoint;
    if (!flags.any()) return kDone;
    if (flags.more_samples() > 0 && !scene.sampler().extends()) {
      say("whit: --samples: those of this scene's sampler cannot go on beyond their number, those of sobol and random "
          "can");
      return kUsage;
    }
    checkpoint_ = std::make_unique<Checkpoint>(flags.kept_in(), Checkpoint::Seconds(duration_of(flags.every)),
                                               identity(), command());
    options.keeper = checkpoint_.get(), options.more_samples = flags.more_samples();
    if (flags.resume.empty()) return kDone;
    const Checkpoint::Problem problem = checkpoint_->resume(flags.resume);
    if (problem.trouble == Checkpoint::Trouble::None) return kDone;
    say("whit: " + problem.text);
    return problem.trouble == Checkpoint::Trouble::Different ? kUsage : kFileError;
  }

  RenderIdentity identity_of_whole() const {
    RenderIdentity identity = identity_of(path_, file_);
    for (const auto& [flag, value] : settings_.of_samples) identity.add(flag, value);
    return identity;
  }

  RenderIdentity identity() const {
    return pass_ ? identity_of_share(pass_->identity, pass_->id, *share_of_text(settings_.passes.share))
                 : identity_of_whole();
  }

  RenderCommand command() const { return {std::filesystem::current_path().string(), path_, settings_.picture_words}; }

  /// After a signal: what there is, and how to have the rest.
  int say_stopped(const RenderResult& result) const {
    std::string remedy;
    if (checkpoint_ && checkpoint_->write_problem().empty())
      remedy = fmt::format("; --resume {} goes on", shell_word(checkpoint_->path()));
    say(fmt::format("whit: {}{}", stopped_text(result), remedy));
    return kLimit;
  }

  /// Of parts that were joined before all were there.
  int say_missing(const RenderResult& result) const {
    if (!settings_.quiet) say(fmt::format("whit: {}, the rest is in no part", there_text(result)));
    return kDone;
  }

  static std::string there_text(const RenderResult& result) {
    return fmt::format("{:.3g} % of the samples are there", 100 * result.share);
  }

  static std::string stopped_text(const RenderResult& result) {
    return fmt::format("stopped by {} with {:.3g} % of the samples", StopSignals::name(), 100 * result.share);
  }

  /// To an accuracy, or until time is up.
  int approach_and_write(BuiltWorld& built, const RenderOptions& options, const OutputPlan& output,
                         DisplayServer& viewer) {
    Diagnostics early;
    std::unique_ptr<HandOut> others = hand_out(viewer);
    const auto write = [&](const RenderResult& result) {
      WrittenOutput written = write_output(output, result, metadata(result));
      early = std::move(written.said);
      return written.elapsed.wall;
    };
    const TargetOutcome outcome = render_to_target(settings_, built, options, started_, write, others.get());
    if (others && !others->problem().empty()) {
      say("whit: " + others->problem());
      return others->code();
    }
    if (int code = report_output(early); code != kDone) return code;
    if (int code = write_and_say(built, outcome.rendered, output, viewer); code != kDone) return code;
    if (StopSignals::come()) say_stopped(outcome.rendered.result);
    return report_target(settings_, outcome,
                         std::chrono::duration<double>(std::chrono::steady_clock::now() - started_).count());
  }

  /// Those who render in the place of this machine, where the flags say so.
  std::unique_ptr<HandOut> hand_out(DisplayServer& viewer) const {
    const std::string& folder = settings_.passes.hand_out;
    if (folder.empty()) return nullptr;
    std::function<void(const FilmRender&)> look;
    if (!settings_.display_server.empty()) {
      look = [&viewer](const FilmRender& film) {
        const Picture picture = film.picture();
        viewer.update(picture.window, picture.rgb);
      };
    }
    return std::make_unique<HandOut>(folder, identity_of_whole(), std::move(look));
  }

  int write_and_say(const BuiltWorld& built, const RenderedWorld& rendered, const OutputPlan& output,
                    DisplayServer& viewer) {
    const RenderResult& result = rendered.result;
    viewer.update(result.picture.window, result.picture.rgb);
    times_.render = rendered.elapsed;
    if (int code = report(rendered.said); code != kDone) return code;
    if (checkpoint_ && !checkpoint_->fits()) {
      say(fmt::format("whit: cannot go on from \"{}\": its film is of another kind", settings_.checkpoint.resume));
      return kFileError;
    }
    if (checkpoint_ && settings_.output.unwritten && !checkpoint_->write_problem().empty()) {
      say("whit: " + checkpoint_->write_problem());
      return kFileError;
    }
    if (checkpoint_) warn_of_checkpoint();
    step_ = "writing pictures";
    const WrittenOutput written = write_output(output, result, metadata(result));
    times_.write = written.elapsed;
    if (int code = report_output(written.said); code != kDone) {
      if (checkpoint_ && checkpoint_->write_problem().empty()) {
        say(fmt::format(
            "whit: what was rendered is kept: the same command with --resume {} and another --outfile writes it",
            shell_word(checkpoint_->path())));
      }
      return code;
    }
    if (result.statistics.invalid_samples > 0) report_invalid(result.statistics);
    const RenderOutcome outcome{*built.scene, result,         output,         *built.textures,
                                times_,       unread_.size(), parsed_memory_, memory_estimate_};
    const int code = denoises() && result.complete ? denoise(result) : kDone;
    stats_.add(settings_, path_, outcome);
    if (!settings_.quiet) {
      summarise(outcome, settings_.stats);
      if (!passed_.empty()) name_what_was_passed();
    }
    return code;
  }

  bool denoises() const { return settings_.denoiser && !settings_.output.unwritten; }

  /// The second picture of --denoise.
  int denoise(const RenderResult& result) {
    step_ = "denoising";
    const WrittenOutput written =
        write_denoised(*settings_.denoiser, denoised_, result, metadata(result), settings_.threads);
    if (int code = report_output(written.said); code != kDone) return code;
    if (settings_.quiet) return kDone;
    const std::string display = denoised_.display_file.empty() ? "" : " and " + denoised_.display_file;
    say(fmt::format("denoised: {}{}  [{}, {:.2g} s; biased]", denoised_.main_file, display,
                    settings_.denoiser->describe(), written.elapsed.wall));
    return kDone;
  }

  void warn_of_checkpoint() const {
    const std::string problem = checkpoint_->write_problem();
    if (!problem.empty()) say("whit: warning: " + problem);
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

  /// The part of a picture of that size that the flags ask for; false where they do not.
  bool find_crop(Vec2i size, double (&crop)[4]) const {
    if (!settings_.crop.empty()) std::copy(settings_.crop.begin(), settings_.crop.end(), crop);
    std::vector<int> pixels = settings_.crop_pixels;
    if (const std::vector<int>& one = settings_.pixel; !one.empty()) pixels = {one[0], one[0] + 1, one[1], one[1] + 1};
    if (!pixels.empty()) pixel_crop({{pixels[0], pixels[2]}, {pixels[1], pixels[3]}}, size, crop);
    return !settings_.crop.empty() || !pixels.empty();
  }

  RenderOptions render_options(const BuiltWorld& built, const std::vector<std::string>& aovs,
                               DisplayServer& viewer) const {
    RenderOptions options;
    options.aovs = {aovs, [this](SourcePos where) { return place_in_scene(sources_, where, path_); }};
    options.threads = settings_.threads;
    const Vec2i size = built.scene->camera().film.resolution;
    options.crop_given = find_crop(size, options.crop);
    if (!settings_.display_server.empty()) show_in(viewer, size, options);
    return options;
  }

  /// Renders as many samples as the scene or --spp says, with what there is to see of it meanwhile.
  RenderedWorld trace(const BuiltWorld& built, RenderOptions options) const {
    std::optional<Progress> progress;
    if (!settings_.quiet) progress.emplace("rendering");
    options.progress = shown_by(progress);
    return render_world(built, std::move(options));
  }

  /// RenderOptions::progress, seen where somebody looks.
  static std::function<bool(double)> shown_by(std::optional<Progress>& progress) {
    return [&progress](double share) {
      if (progress) progress->update(share);
      return !StopSignals::come();
    };
  }

  /// Previews go to the viewer while it can be reached; the render does not depend on it.
  void show_in(DisplayServer& viewer, Vec2i size, RenderOptions& options) const {
    if (const std::string problem = viewer.connect(settings_.display_server); !problem.empty()) {
      say("whit: warning: " + problem);
      return;
    }
    if (settings_.shown) viewer.go_on(path_);
    else viewer.create(path_, size);
    options.tile_done = [&viewer](const Box2i& window, std::span<const float> rgb) { viewer.update(window, rgb); };
  }

  std::vector<OutputMetadata> metadata(const RenderResult& result) const {
    std::vector<OutputMetadata> all{
        {"Software", fmt::format("whit {}", version())},
        {"whit:command", settings_.picture_command},
        {"whit:scene", path_},
        {"whit:samplesPerPixel", static_cast<int>(std::lround(result.samples_per_pixel))},
        {"whit:seed", std::to_string(settings_.seed)}};  // Text, since an OpenEXR int ends at half of the seeds.
    if (!result.complete && settings_.parts) all.push_back({"whit:incomplete", there_text(result)});
    else if (!result.complete && StopSignals::come()) all.push_back({"whit:incomplete", stopped_text(result)});
    return all;
  }

  const std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
  Stopwatch world_started_;
  const RenderSettings& settings_;
  const std::string path_;
  RenderStats& stats_;
  const char*& step_;
  ParsedFile file_;
  const Sources& sources_ = *file_.sources;
  const double parsed_memory_;  ///< Resident after parsing, in bytes.
  double memory_estimate_ = 0;  ///< Of the world at hand, in bytes.
  StepTimes times_;
  std::unique_ptr<Checkpoint> checkpoint_;
  std::unique_ptr<PassFile> pass_;  ///< Of which a share is to be rendered.
  OutputPlan denoised_;             ///< Of the world at hand, for --denoise.
  std::set<std::string> written_;   ///< Pictures of this file's worlds.
  bool reported_whole_ = false;     ///< What planning finds has been said with what parsing found.
  std::vector<Diagnostic> passed_;  ///< Errors that --keep-going went past.
  std::set<std::tuple<uint32_t, uint64_t, std::string>> said_;  ///< Places and messages.
  std::set<std::string> unread_;                                ///< Files of objects that this world never places.
};

}  // namespace

int render_file(const RenderSettings& settings, const std::string& path, const BeforeScene& before,
                RenderStats& stats) {
  const char* step = "reading the scene";
  try {
    return RenderJob(settings, path, before, stats, step).run();
  } catch (const std::bad_alloc& e) {
    const auto* words = dynamic_cast<const OutOfMemory*>(&e);
    say(fmt::format("whit: {}: not enough memory while {}{}{}", path, step, words ? ": " : "", words ? e.what() : ""));
    return kLimit;
  }
}

}  // namespace whit
