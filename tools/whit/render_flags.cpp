#include "tools/whit/render_flags.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <type_traits>
#include <variant>

#include "core/render/aovs.h"
#include "core/session/checkpoint.h"
#include "core/session/pass_file.h"
#include "tools/whit/command_line.h"
#include "tools/whit/quantities.h"
#include "tools/whit/terminal.h"
#include "tools/whit/text_file.h"

namespace whit {
namespace {

/// pbrt takes the crop window as four arguments; commas and '=' serve too.
Arguments split_lists(const Arguments& args) {
  Arguments out;
  for (const std::string& arg : args) {
    const auto is_list = [](const std::string& flag) {
      return flag == "--cropwindow" || flag == "--crop-pixels" || flag == "--pixel";
    };
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

/// Takes the file of `--stats FILE.json` and `--stats=FILE.json` out of the arguments. A word behind a bare --stats is its
/// file only where it looks like one, since it may be a scene as well.
std::string take_stats_file(Arguments& args, std::string& file) {
  const auto names_file = [](std::string_view word) { return word == "-" || word.ends_with(".json"); };
  for (auto at = args.begin(); at != args.end() && *at != "--";) {
    const bool joined = at->starts_with("--stats=");
    if (!joined && !(*at == "--stats" && at + 1 != args.end() && names_file(at[1]))) {
      ++at;
      continue;
    }
    file = joined ? at->substr(at->find('=') + 1) : at[1];
    if (!names_file(file)) return fmt::format("--stats: \"{}\" is neither a name that ends in .json nor -", file);
    at = args.erase(at, at + (joined ? 1 : 2));
  }
  return {};
}

/// Flags that a picture does not depend on: where it goes, what is said of it, how many threads make it, whether it was
/// stopped in between.
const std::vector<std::string> kBesideWithValue{
    "--outfile",     "-o",     "--display",    "--nthreads", "--json",   "--display-server", "--logdir",
    "--minloglevel", "--v",    "--checkpoint", "--every",    "--resume", "--allow",          "--max-memory",
    "--hand-out",    "--pass", "--share"};
const std::vector<std::string> kBeside{"--quiet", "--stats", "--verbose", "--sandbox"};
/// Of the others, those that samples do not depend on: how they become a picture, how many are added, and how long that
/// may take.
const std::vector<std::string> kAfterSamples{"scenes",     "--samples", "--time-limit",     "--view",  "--ocio",
                                             "--exposure", "--type",    "--texture-memory", "--strict"};

/// The command's words without them, so that equal pictures are equal files. --denoise makes another file; yet samples
/// depend on it, whose surfaces are kept for it.
Arguments picture_words(const Arguments& args) {
  const std::vector<std::string>&with_value = kBesideWithValue, &alone = kBeside;
  const auto is_in = [](const std::vector<std::string>& names, const std::string& word) {
    return std::find(names.begin(), names.end(), word.substr(0, word.find('='))) != names.end();
  };
  Arguments words;
  for (size_t i = 0; i < args.size(); ++i) {
    if (is_in(with_value, args[i])) i += args[i].find('=') == std::string::npos;
    else if (!is_in(alone, args[i]) && args[i] != "--denoise") words.push_back(args[i]);
  }
  return words;
}

std::string text_of(const FlagTarget& target) {
  const auto text = [](const auto& value) {
    using T = std::decay_t<decltype(value)>;
    if constexpr (requires { value.has_value(); }) return value ? fmt::format("{}", *value) : std::string();
    else if constexpr (std::is_same_v<T, std::string>) return value;
    else if constexpr (requires { value.begin(); }) return fmt::format("{}", fmt::join(value, ","));
    else return value == T() ? std::string() : fmt::format("{}", value);
  };
  return std::visit([&](const auto* at) { return text(*at); }, target);
}

std::vector<std::pair<std::string, std::string>> flags_of_samples(const std::vector<Flag>& flags) {
  std::vector<std::pair<std::string, std::string>> out;
  for (const Flag& flag : flags) {
    const std::string names = flag.names, name = names.substr(0, names.find(','));
    const auto is_in = [&](const std::vector<std::string>& list) {
      return std::find(list.begin(), list.end(), name) != list.end();
    };
    if (!is_in(kBesideWithValue) && !is_in(kBeside) && !is_in(kAfterSamples))
      out.emplace_back(name, text_of(flag.target));
  }
  return out;
}

std::vector<std::string> aov_names() {
  std::vector<std::string> names{"none"};
  for (const AovRow& row : all_aovs()) names.emplace_back(row.name);
  return names;
}

constexpr const char* kPictures = "exr pfm png jpg tga tiff";

// The effects' flags stand between these two tables.

std::vector<Flag> flags_of(RenderSettings& s) {
  return {
      {"scenes", &s.scenes, "Scene files or glTF models; standard input without any"},
      {"--outfile,-o",
       &s.output.outfile,
       "Picture file: .exr .pfm (linear) .png .jpg .tga .tiff (display); 'none' for none",
       {.files = kPictures}},
      {"--display",
       &s.output.display,
       "Display picture beside a linear one; 'none' for none (default: .png)",
       {.files = kPictures}},
      {"--aov",
       &s.output.aovs,
       "What an .exr holds beside its colours: names of whit help aovs, or none",
       {.delimiter = ',', .offers = aov_names}},
      {"--denoise", &s.denoise, "Write a second picture, NAME-denoised, by OpenImageDenoise: less noise, and biased"},
      {"--nthreads", &s.threads, "Threads; 0 is one per core", {.least = 0, .most = 4096}},
      {"--cropwindow", &s.crop, "Part of the picture: x0 x1 y0 y1 in [0,1]", {.count = 4}},
      {"--crop-pixels", &s.crop_pixels, "The same in pixels: x0 x1 y0 y1, from x0 to the one before x1", {.count = 4}},
      {"--sample-range", &s.sample_range,
       "Of each pixel's samples those from a to the one before b: a:b. With --checkpoint a part for whit merge"},
      {"--spp", &s.spp, "Samples per pixel, instead of the scene's", {.least = 1, .most = 1 << 30}},
      {"--footprint-spp",
       &s.footprint_spp,
       "Samples that share a pixel's texture filtering (default: the scene's count)",
       {.least = 1, .most = 1 << 30}},
      {"--target-error", &s.target.error, "Render until nRMSE is below: 1%, 0.01"},
      {"--confidence", &s.target.confidence, "How sure to be of that: 95%"},
      {"--time-limit", &s.target.time_limit, "Be done, writing included, after: 30s, 2min, 500ms"},
      {"--max-samples",
       &s.target.max_samples,
       "Samples per pixel at most, of --target-error and --time-limit",
       {.least = 1, .most = 1 << 30}},
      {"--checkpoint",
       &s.checkpoint.file,
       "Keep the render's state in this file, to go on from after a kill, a full disk or a Ctrl-C",
       {.files = ""}},
      {"--every", &s.checkpoint.every, "How often: 30s, 5min"},
      {"--resume",
       &s.checkpoint.resume,
       "Go on from a checkpoint, and keep it up to date: the picture is that of a render without a stop",
       {.files = ""}},
      {"--samples", &s.checkpoint.samples, "With --resume: that many samples per pixel more, +192"},
      {"--hand-out",
       &s.passes.hand_out,
       "Let others render the passes of --target-error: each is a file in this folder and a line of JSON on standard "
       "output, and the parts come as names on standard input (docs/farm.md)",
       {.files = "/"}},
      {"--pass", &s.passes.pass, "Render a share of a pass that --hand-out wrote, into a --checkpoint", {.files = ""}},
      {"--share", &s.passes.share, "Which share of how many --pass is to render: 2/5"},
      {"--json",
       &s.target.json,
       "What --target-error or --time-limit came to, as JSON: a file, or - for stdout",
       {.files = "json"}},
      {"--seed", &s.seed, "Seed of the random numbers"},
      {"--pixel", &s.pixel, "Render one pixel: x,y", {.count = 2}},
      {"--debug-pixel", &s.debug_pixel, "Say how a pixel comes about, without a picture: x,y or x,y,sample"},
  };
}

std::vector<Flag> more_flags_of(RenderSettings& s) {
  return {
      {"--plan-check", &s.effects.plan_check, "Run every stage, called for or not, for the same picture: a test"},
      {"--view", &s.output.view, "Display view: sRGB, 'ACES SDR', exposure=E, or one of the config's"},
      {"--ocio", &s.output.ocio, "OpenColorIO config, instead of $OCIO and the built-in one", {.files = "ocio ocioz"}},
      {"--exposure", &s.output.exposure, "Stops by which the display picture is brightened"},
      {"--type", &s.half_or_float, "Numbers of an .exr: half or float", {.choices = {"half", "float"}}},
      {"--traversal", &s.traversal, "robust (watertight) or fast", {.choices = {"robust", "fast"}}},
      {"--texture-memory",
       &s.texture_memory,
       "MiB of decoded textures at most; what is more goes to a file in $TMPDIR or /var/tmp",
       {.least = 1, .most = 1e9}},
      memory_flag(s.memory),
      {"--quick", &s.quick, "A quarter of the resolution each way, one sample per pixel"},
      {"--quiet", &s.quiet, "No progress and no summary; problems are still reported"},
      {"--strict", &s.strict, "Warnings are errors"},
      {"--keep-going", &s.keep_going, "Render what is usable despite errors"},
      {"--stats", &s.stats, "More figures at the end; --stats FILE.json (or -): figures as JSON there"},
      {"--cat", &s.cat, "Print the scene in normal form instead of rendering"},
      {"--toply", &s.toply, "The same, with large meshes written to PLY files"},
      {"--display-server", &s.display_server, "Show the picture while it is made: host:port of a tev viewer"},
      {"--logdir", &s.log_dir, "Folder for a log file of the messages", {.files = "/"}},
      {"--minloglevel", &s.min_log_level, "2 and above: errors only"},
      {"--v", &s.verbosity, "Verbosity: 1 and above says each step"},
      {"--verbose", &s.verbose, "The same as --v 1"},
  };
}

/// The same of the flags that say how far to render.
std::string usage_problem(const RenderSettings& s, const TargetFlags& t) {
  if (!t.error.empty() && share_of(t.error) == 0)
    return fmt::format("--target-error: \"{}\" is no error above 0; write 1% or 0.01", t.error);
  if (!(share_of(t.confidence) > 0 && share_of(t.confidence) < 1))
    return fmt::format("--confidence: \"{}\" is not between 0 and 100 %; write 95% or 0.95", t.confidence);
  if (!t.time_limit.empty() && duration_of(t.time_limit) == 0)
    return fmt::format("--time-limit: \"{}\" is no time above 0; write 30s, 2min, 500ms or 30", t.time_limit);
  if (!t.json.empty() && !t.any())
    return "--json tells what --target-error or --time-limit came to; --stats has figures";
  if (t.any() && s.spp > 0)
    return "--spp says how many samples to take, --target-error and --time-limit how far to go; --max-samples is a "
           "limit";
  return {};
}

/// The same of the flags that keep states.
std::string usage_problem(const RenderSettings& s, const CheckpointFlags& c) {
  if (!c.samples.empty() && c.more_samples() == 0)
    return fmt::format("--samples: \"{}\" adds nothing; write +192 (--spp says how many a render is to have)",
                       c.samples);
  if (!c.samples.empty() && c.resume.empty())
    return "--samples adds to a render that --resume goes on with; --spp says how many samples to take";
  if (!c.samples.empty() && s.target.any())
    return "--samples says how many more to take, --target-error and --time-limit how far to go";
  if (duration_of(c.every) == 0)
    return fmt::format("--every: \"{}\" is no time above 0; write 30s, 5min or 30", c.every);
  if (c.any() && s.scenes.size() > 1) return "a checkpoint is of one picture, and here are several scenes";
  if (c.any() && !s.debug_pixel.empty()) return "--debug-pixel makes no picture that a checkpoint could be of";
  return {};
}

/// The same of the flags that divide passes.
std::string usage_problem(const RenderSettings& s, const PassFlags& p) {
  if (!p.any()) return {};
  const char* const flag = p.hand_out.empty() ? "--pass" : "--hand-out";
  if (!p.hand_out.empty() && !(p.pass.empty() && p.share.empty()))
    return "--hand-out decides and --pass renders: each is a command of its own";
  if (p.hand_out.empty() && (p.pass.empty() || p.share.empty()))
    return "--pass FILE and --share 2/5 belong together: which pass, and what of it";
  if (s.target.error.empty() || !s.target.time_limit.empty())
    return fmt::format("{} is of a render to a --target-error, without a --time-limit: sums decide and no clock", flag);
  if (s.scenes.size() != 1 || s.scenes.front() == "-") return fmt::format("{} needs one scene, by its name", flag);
  if (!s.debug_pixel.empty() || s.cat || s.toply) return fmt::format("{} is of pictures, and none is made", flag);
  if (!p.hand_out.empty()) {
    if (s.stats_file == "-" || s.target.json == "-")
      return "--hand-out tells of passes on standard output; name files for --stats and --json";
    if (s.sandbox.on) return "--hand-out is told the names of parts later, which --sandbox cannot know";
    return {};
  }
  if (!share_of_text(p.share))
    return fmt::format("--share: \"{}\" is no share; write 2/5 for the second of five", p.share);
  if (!s.checkpoint.any()) return "--pass makes no picture: --checkpoint names the file for what was rendered";
  if (!s.output.outfile.empty() || !s.target.json.empty() || !s.display_server.empty())
    return "--pass makes no picture: --outfile, --json and --display-server belong to --hand-out";
  return {};
}

/// The same of the flags that render a part of a picture.
std::string part_problem(const RenderSettings& s) {
  if (!s.crop.empty() && !(s.crop[0] < s.crop[1] && s.crop[2] < s.crop[3] && s.crop[0] >= 0 && s.crop[1] <= 1 &&
                           s.crop[2] >= 0 && s.crop[3] <= 1)) {
    return "--cropwindow needs x0 < x1 and y0 < y1 within [0,1]";
  }
  const std::vector<int>& c = s.crop_pixels;
  if (!c.empty() && !(c[0] >= 0 && c[0] < c[1] && c[2] >= 0 && c[2] < c[3]))
    return "--crop-pixels needs 0 <= x0 < x1 and 0 <= y0 < y1";
  if (!s.crop.empty() + !c.empty() + !s.pixel.empty() > 1)
    return "--cropwindow, --crop-pixels and --pixel each say which pixels to render: one of them will do";
  if (s.sample_range.empty()) return {};
  if (!samples_of(s.sample_range, 1)) {
    return fmt::format("--sample-range: \"{}\" is no range; write 0:64 for samples 0 to 63, or 64: for the rest",
                       s.sample_range);
  }
  if (s.target.any()) return "--sample-range says which samples to take, --target-error and --time-limit how far to go";
  if (!s.checkpoint.samples.empty()) return "--samples adds to a whole picture, --sample-range takes a part of one";
  if (!s.debug_pixel.empty()) return "--debug-pixel makes no picture that --sample-range could be of";
  return {};
}

/// A flag whose values make no sense is wrong usage.
std::string usage_problem(const RenderSettings& s) {
  if (std::string problem = part_problem(s); !problem.empty()) return problem;
  if (!s.output.outfile.empty() && s.scenes.size() > 1) {
    return "--outfile with several scenes would write them over each other";
  }
  if (s.output.unwritten && s.passes.pass.empty() && !s.checkpoint.any() && s.display_server.empty() &&
      s.stats_file.empty() && s.target.json.empty())
    return "--outfile none: nothing would come of it; name a --checkpoint, a --display-server or --stats FILE.json";
  if (std::string problem = usage_problem(s.memory); !problem.empty()) return problem;
  if (!s.debug_pixel.empty() && numbers_of(s.debug_pixel).size() < 2) {
    return "--debug-pixel needs x,y or x,y,sample, like 320,240,7";
  }
  if (!s.stats_file.empty() && (!s.debug_pixel.empty() || s.cat || s.toply)) {
    return "--stats FILE.json is of pictures, and none is made";
  }
  if (s.denoise && (!s.debug_pixel.empty() || s.cat || s.toply)) return "--denoise is of pictures, and none is made";
  if (s.denoise && !s.target.time_limit.empty())
    return "--time-limit: how long --denoise takes at the end is not known before; leave one of them out";
  if (std::string problem = usage_problem(s, s.target); !problem.empty()) return problem;
  if (std::string problem = usage_problem(s, s.checkpoint); !problem.empty()) return problem;
  if (std::string problem = usage_problem(s, s.passes); !problem.empty()) return problem;
  for (const std::string& scene : s.scenes) {
    if (std::string problem = usage_problem(s.model, scene); !problem.empty()) return problem;
  }
  if (s.sandbox.on && !s.display_server.empty())
    return "--display-server is called over the network, which --sandbox forbids";
  if (std::string problem = usage_problem(s.sandbox); !problem.empty()) return problem;
  return usage_problem(s.effects);
}

/// Files that must be there before the first scene is rendered; "" or the first problem.
std::string file_problem(const RenderSettings& s) {
  for (const std::string& scene : s.scenes) {
    std::error_code error;
    if (scene != "-" && !std::filesystem::exists(scene, error))
      return fmt::format("cannot open \"{}\": no such file", scene);
  }
  if (!s.log_dir.empty() && !std::filesystem::is_directory(s.log_dir)) {
    return fmt::format("--logdir: there is no folder \"{}\"", s.log_dir);
  }
  for (const std::string& file : {s.stats_file, s.target.json}) {
    if (std::string problem = text_file_problem(file); !problem.empty()) return problem;
  }
  if (s.checkpoint.any() && s.checkpoint.kept_in() != s.checkpoint.resume)
    return Checkpoint::reason_against(s.checkpoint.kept_in());
  return {};
}

}  // namespace

uint32_t CheckpointFlags::more_samples() const {
  uint32_t n = 0;
  const char* const end = samples.data() + samples.size();
  if (samples.size() < 2 || samples[0] != '+') return 0;
  const auto [stop, error] = std::from_chars(samples.data() + 1, end, n);
  constexpr uint32_t kMost = 1u << 30;  // as --spp
  return error == std::errc() && stop == end && n <= kMost ? n : 0;
}

std::optional<SampleRange> samples_of(const std::string& text, uint32_t whole) {
  const size_t colon = text.find(':');
  if (colon == std::string::npos || text.size() < 2) return {};
  SampleRange range{0, whole, whole};
  const auto read = [&](size_t first, size_t end, uint32_t& number) {
    if (first == end) return true;
    const auto [stop, error] = std::from_chars(text.data() + first, text.data() + end, number);
    return error == std::errc() && stop == text.data() + end;
  };
  if (!read(0, colon, range.first) || !read(colon + 1, text.size(), range.last)) return {};
  return range;
}

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

bool read_render_flags(const Arguments& args, RenderSettings& settings, int& code) {
  CommandLine command{"whit", "Renders pbrt-v3 scene files and glTF models.", flags_of(settings)};
  add_effect_flags(command, settings.effects);
  add_model_flags(command, settings.model);
  for (const Flag& flag : more_flags_of(settings)) command.flags.push_back(flag);
  add_sandbox_flags(command, settings.sandbox);
  Arguments words = split_lists(args);
  std::string problem = take_stats_file(words, settings.stats_file);
  if (problem.empty() && !parse_arguments(command, words, code)) return false;
  for (const std::string& a : args) settings.command_line += (settings.command_line.empty() ? "whit " : " ") + a;
  settings.picture_words = picture_words(words);
  settings.picture_command = fmt::format("whit {}", fmt::join(settings.picture_words, " "));
  settings.of_samples = flags_of_samples(command.flags);
  if (!settings.passes.pass.empty()) settings.output.unwritten = true;
  if (settings.output.outfile == "none") settings.output.outfile.clear(), settings.output.unwritten = true;
  if (problem.empty()) problem = usage_problem(settings);
  code = kUsage;
  if (settings.scenes.empty()) settings.scenes.push_back("-");
  if (problem.empty()) problem = file_problem(settings), code = kFileError;
  if (problem.empty()) return true;
  say("whit: " + problem);
  return false;
}

}  // namespace whit
