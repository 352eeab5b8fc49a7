// `whit render`: parse, plan, build, render, write; each step says what went wrong before the next begins.

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <optional>
#include <set>

#include "core/accel/accel.h"
#include "core/render/debug_sample.h"
#include "parser/format.h"
#include "tools/whit/command_line.h"
#include "tools/whit/display_server.h"
#include "tools/whit/effect_flags.h"
#include "tools/whit/load.h"
#include "tools/whit/output.h"
#include "tools/whit/terminal.h"

namespace whit {
namespace {

struct Settings {
  std::vector<std::string> scenes;
  OutputRequest output;
  std::vector<double> crop;
  std::vector<int> pixel;
  std::string debug_pixel;
  EffectFlags effects;
  int threads = 0, spp = 0;
  uint32_t seed = 0;
  double texture_memory = 1024;
  bool quick = false, quiet = false, strict = false, keep_going = false, stats = false, verbose = false;
  bool cat = false, toply = false;
  int verbosity = 0, min_log_level = 0;
  std::string display_server, log_dir, traversal = "robust", half_or_float = "half";
  std::string command_line;
};

/// pbrt takes the crop window as four arguments; commas and '=' serve too.
Arguments split_lists(const Arguments& args) {
  Arguments out;
  for (const std::string& arg : args) {
    const auto is_list = [](const std::string& flag) { return flag == "--cropwindow" || flag == "--pixel"; };
    const size_t equals = arg.find('=');
    std::string rest = arg;
    if (equals != std::string::npos && is_list(arg.substr(0, equals))) {
      out.push_back(arg.substr(0, equals));
      rest = arg.substr(equals + 1);
    }
    const bool list = !out.empty() && is_list(out.back());
    for (size_t comma; list && (comma = rest.find(',')) != std::string::npos; rest = rest.substr(comma + 1)) {
      out.push_back(rest.substr(0, comma));
    }
    out.push_back(rest);
  }
  return out;
}

void declare(CLI::App& app, Settings& s) {
  app.add_option("scenes", s.scenes, "Scene files; standard input without any");
  app.add_option("--outfile,-o", s.output.outfile, "Picture file: .exr .pfm (linear) .png .jpg .tga .tiff (display)");
  app.add_option("--display", s.output.display, "Display picture beside a linear one; 'none' for none (default: .png)");
  app.add_option("--nthreads", s.threads, "Threads; 0 is one per core")->check(CLI::Range(0, 4096));
  app.add_option("--cropwindow", s.crop, "Part of the picture: x0 x1 y0 y1 in [0,1]")
      ->expected(4)
      ->allow_extra_args(false);
  app.add_option("--spp", s.spp, "Samples per pixel, instead of the scene's")->check(CLI::Range(1, 1 << 30));
  app.add_option("--seed", s.seed, "Seed of the random numbers");
  app.add_option("--pixel", s.pixel, "Render one pixel: x,y")->expected(2)->allow_extra_args(false);
  app.add_option("--debug-pixel", s.debug_pixel, "Say how a pixel comes about, without a picture: x,y or x,y,sample");
  add_effect_flags(app, s.effects);
  app.add_flag("--plan-check", s.effects.plan_check,
               "Run every stage, called for or not, for the same picture: a test");
  app.add_option("--view", s.output.view, "Display view: sRGB, 'ACES SDR', exposure=E, or one of the config's");
  app.add_option("--ocio", s.output.ocio, "OpenColorIO config, instead of $OCIO and the built-in one");
  app.add_option("--exposure", s.output.exposure, "Stops by which the display picture is brightened");
  app.add_option("--type", s.half_or_float, "Numbers of an .exr: half or float")
      ->check(CLI::IsMember({"half", "float"}));
  app.add_option("--traversal", s.traversal, "robust (watertight) or fast")->check(CLI::IsMember({"robust", "fast"}));
  app.add_option("--texture-memory", s.texture_memory, "MiB of decoded textures at most")->check(CLI::Range(1.0, 1e9));
  app.add_flag("--quick", s.quick, "A quarter of the resolution each way, one sample per pixel");
  app.add_flag("--quiet", s.quiet, "No progress and no summary; problems are still reported");
  app.add_flag("--strict", s.strict, "Warnings are errors");
  app.add_flag("--keep-going", s.keep_going, "Render what is usable despite errors");
  app.add_flag("--stats", s.stats, "More figures at the end");
  app.add_flag("--cat", s.cat, "Print the scene in normal form instead of rendering");
  app.add_flag("--toply", s.toply, "The same, with large meshes written to PLY files");
  app.add_option("--display-server", s.display_server, "Show the picture while it is made: host:port of a tev viewer");
  app.add_option("--logdir", s.log_dir, "Folder for a log file of the messages");
  app.add_option("--minloglevel", s.min_log_level, "2 and above: errors only");
  app.add_option("--v", s.verbosity, "Verbosity: 1 and above says each step");
  app.add_flag("--verbose", s.verbose, "The same as --v 1");
}

/// The two or three whole numbers of "x,y,sample"; none when the text is anything else.
std::vector<int> numbers_of(const std::string& text) {
  std::vector<int> numbers;
  const char *at = text.data(), *end = at + text.size();
  for (int number = 0;; ++at) {
    const auto [next, error] = std::from_chars(at, end, number);
    if (error != std::errc()) return {};
    numbers.push_back(number);
    at = next;
    if (at == end) break;
    if (*at != ',' || numbers.size() == 3) return {};
  }
  return numbers;
}

/// A flag whose values make no sense is wrong usage.
std::string usage_problem(const Settings& s) {
  if (!s.crop.empty() && !(s.crop[0] < s.crop[1] && s.crop[2] < s.crop[3] && s.crop[0] >= 0 && s.crop[1] <= 1 &&
                           s.crop[2] >= 0 && s.crop[3] <= 1)) {
    return "--cropwindow needs x0 < x1 and y0 < y1 within [0,1]";
  }
  if (!s.output.outfile.empty() && s.scenes.size() > 1) {
    return "--outfile with several scenes would write them over each other";
  }
  if (!s.debug_pixel.empty() && numbers_of(s.debug_pixel).size() < 2) {
    return "--debug-pixel needs x,y or x,y,sample, like 320,240,7";
  }
  return usage_problem(s.effects);
}

/// Files that must be there before the first scene is rendered; "" or the first problem.
std::string file_problem(const Settings& s) {
  for (const std::string& scene : s.scenes) {
    std::error_code error;
    if (scene != "-" && !std::filesystem::exists(scene, error))
      return fmt::format("cannot open \"{}\": no such file", scene);
  }
  if (!s.log_dir.empty() && !std::filesystem::is_directory(s.log_dir)) {
    return fmt::format("--logdir: there is no folder \"{}\"", s.log_dir);
  }
  return {};
}

double since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

struct Times {
  double parse = 0, plan = 0, build = 0, render = 0, write = 0;
};

/// One scene file on its way to pictures.
class RenderJob {
 public:
  RenderJob(const Settings& settings, std::string path) : settings_(settings), path_(std::move(path)) {}

  int run() {
    LoadedFile file = load_file(sources_, path_);
    times_.parse = file.parse_seconds;
    parsed_memory_ = resident_memory();
    // A file with mistakes is reported whole: also what planning would have said of it.
    const bool mistaken = file.parsed.diagnostics.has_errors();
    const Diagnostics found = mistaken ? all_problems(file, sources_) : file.parsed.diagnostics;
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
    say("going on with what is usable (--keep-going)");
    return kDone;
  }

  void log(const Diagnostics& d) const {
    if (settings_.log_dir.empty()) return;
    std::ofstream out(settings_.log_dir + "/whit.log", std::ios::app);
    for (const Diagnostic& one : d.all()) out << sources_.render_diagnostic(one, false);
  }

  int render_world(const SceneDescription& world) {
    Diagnostics diagnostics;
    PlannedScene planned = plan_scene(world, sources_, diagnostics, plan_options(settings_.effects));
    times_.plan = planned.seconds;
    if (world.has_media()) {
      diagnostics.warning(world.world_begin, "participating media are not simulated", "the picture is made without");
    }
    unread_.clear();
    for (const UnreadFile& file : world.unread_files) unread_.insert(file.path);
    if (int code = report(diagnostics); code != kDone) return code;
    if (!planned.bound.film.plugin) return kSceneError;

    OutputPlan output;
    if (std::string problem = plan_output(output_request(), *planned.bound.film.plugin, output); !problem.empty()) {
      say("whit: " + problem);
      const bool view = problem.rfind("unknown view", 0) == 0 || problem.rfind("view ", 0) == 0;
      return view ? kUsage : kFileError;
    }
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
    if (!settings_.quiet) summarise(scene, result, output, textures);
    return kDone;
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
    return {{"Software", fmt::format("whit {}", WHIT_VERSION)},
            {"whit:command", settings_.command_line},
            {"whit:scene", path_},
            {"whit:samplesPerPixel", scene.samples_per_pixel},
            {"whit:seed", static_cast<int>(settings_.seed)},
            {"whit:renderSeconds", static_cast<float>(result.seconds)}};
  }

  static void report_invalid(const RenderStatistics& s) {
    say(fmt::format(
        "whit: warning: {} samples were not valid (NaN, infinite or of negative luminance) and were left out; "
        "the first is sample {} of "
        "pixel {},{} (--debug-pixel {},{},{} tells how it comes about)",
        s.invalid_samples, s.first_invalid_sample, s.first_invalid_pixel.x, s.first_invalid_pixel.y,
        s.first_invalid_pixel.x, s.first_invalid_pixel.y, s.first_invalid_sample));
  }

  void summarise(const Scene& scene, const RenderResult& r, const OutputPlan& output,
                 const TextureStore& textures) const {
    const RenderStatistics& s = r.statistics;
    say(fmt::format("parse {}, plan {}, build {}, render {}, write {} on {} thread{}.", duration_text(times_.parse),
                    duration_text(times_.plan), duration_text(times_.build), duration_text(times_.render),
                    duration_text(times_.write), r.threads, r.threads == 1 ? "" : "s"));
    say(fmt::format("{} rays: {} camera, {} reflection, {} refraction, {} shadow; {:.2f} Mrays/s.",
                    count_text(s.rays()), count_text(s.camera_rays), count_text(s.reflection_rays),
                    count_text(s.refraction_rays), count_text(s.shadow_rays),
                    s.rays() / std::max(1e-9, r.seconds) / 1e6));
    say(fmt::format("{} samples per pixel, {} triangles, peak memory {}, invalid samples {}.", scene.samples_per_pixel,
                    count_text(static_cast<double>(scene.triangle_count())), bytes_text(peak_memory()),
                    s.invalid_samples));
    if (const size_t n = unread_.size(); n > 0)
      say(fmt::format("{} file{} of objects that are never placed {} not read (whit explain lists {}).", n,
                      n == 1 ? "" : "s", n == 1 ? "was" : "were", n == 1 ? "it" : "them"));
    if (settings_.stats) more_statistics(scene, s, textures);
    if (is_linear_format(output.main_file)) {
      say(fmt::format("linear:  {}", output.main_file));
      if (!output.display_file.empty())
        say(fmt::format("display: {}  [{}]", output.display_file, output.display->describe()));
    } else {
      say(fmt::format("display: {}  [{}]", output.main_file, output.display->describe()));
    }
  }

  void more_statistics(const Scene& scene, const RenderStatistics& s, const TextureStore& textures) const {
    const TextureStatistics t = textures.statistics();
    const BuildSeconds& b = scene.build_seconds;
    say(fmt::format(
        "ready to trace after {}: geometry read in {}, textures and materials prepared in {}, geometry moved to "
        "render space in {}, ray tracer built in {}; {} resident after parsing.",
        duration_text(times_.parse + times_.plan + times_.build), duration_text(b.read), duration_text(b.prepare),
        duration_text(b.bake), duration_text(b.accelerate), bytes_text(parsed_memory_)));
    say(fmt::format("{}: geometry {}, {} shapes, {} instances, {} lights sampled per point.", accel_version(),
                    bytes_text(static_cast<double>(scene.geometry_bytes())), scene.shapes.size(),
                    scene.instances.size(), scene.lights.size()));
    say(fmt::format("{} surface points, {} footprints, {} interface crossings.", count_text(s.surface_points),
                    count_text(s.footprints), count_text(s.passing_rays)));
    say(fmt::format("{} time samples, {} lens samples, {} alpha tests, {} texture values.", count_text(s.time_samples),
                    count_text(s.lens_samples), count_text(s.alpha_tests), count_text(s.texture_values)));
    say(fmt::format("{} times a light could reach none of a batch of points, and was skipped.",
                    count_text(s.lights_skipped)));
    say(fmt::format("textures: {} lookups, {} decodes, {} trims, {} evictions, peak {}.", count_text(t.lookups),
                    t.decodes, t.trims, t.evictions, bytes_text(static_cast<double>(t.peak_bytes))));
  }

  const Settings& settings_;
  const std::string path_;
  Sources sources_;
  Times times_;
  double parsed_memory_ = 0;       ///< Resident after parsing, in bytes.
  std::set<std::string> written_;  ///< Pictures of this file's worlds.
  std::set<std::string> unread_;   ///< Files of objects that this world never places.
};

/// --cat and --toply.
int print_normal_form(const Settings& s) {
  int code = kDone;
  for (const std::string& path : s.scenes) {
    Sources sources;
    FormatOptions options;
    options.expand_includes = true;
    options.to_ply = s.toply;
    const Diagnostics d =
        path == "-" ? format_text(sources, "<stdin>", std::string{std::istreambuf_iterator<char>(std::cin), {}}, "",
                                  std::cout, options)
                    : format_file(sources, path, std::cout, options);
    print_diagnostics(sources, d);
    code = std::max(code, exit_code(d));
  }
  return code;
}

}  // namespace

int render_command(const Arguments& args) {
  Settings settings;
  CLI::App app("Renders pbrt-v3 scene files.", "whit");
  declare(app, settings);
  int code = kDone;
  if (!parse_arguments(app, split_lists(args), code)) return code;
  settings.output.exposure_given = app.count("--exposure") > 0;
  for (const std::string& a : args) settings.command_line += (settings.command_line.empty() ? "whit " : " ") + a;
  if (std::string problem = usage_problem(settings); !problem.empty()) {
    say("whit: " + problem);
    return kUsage;
  }
  if (settings.scenes.empty()) settings.scenes.push_back("-");
  if (std::string problem = file_problem(settings); !problem.empty()) {
    say("whit: " + problem);
    return kFileError;
  }
  if (settings.cat || settings.toply) return print_normal_form(settings);
  std::unique_ptr<tbb::global_control> threads;
  if (settings.threads > 0) {
    threads = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                    static_cast<size_t>(settings.threads));
  }
  for (const std::string& scene : settings.scenes) {
    if (int result = RenderJob(settings, scene).run(); result != kDone) return result;
  }
  return code;
}

}  // namespace whit
