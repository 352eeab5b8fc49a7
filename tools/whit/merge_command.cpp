// `whit merge`: parts that were rendered by themselves, to the picture that they are of.

#include <fmt/format.h>

#include <filesystem>

#include "core/session/parts.h"
#include "tools/whit/command_line.h"
#include "tools/whit/render_flags.h"
#include "tools/whit/render_job.h"
#include "tools/whit/terminal.h"

namespace whit {
namespace {

/// A file that a command named, seen from here; other words as they are.
std::string seen_from_here(const std::string& word, const std::string& folder) {
  std::error_code failed;
  const std::filesystem::path here = std::filesystem::current_path(failed), path = word;
  if (failed || word.empty() || word[0] == '-' || path.is_absolute() || here == folder) return word;
  const std::filesystem::path there = std::filesystem::path(folder) / path;
  return std::filesystem::exists(there, failed) ? there.lexically_proximate(here).string() : word;
}

/// Flags of pictures that are given on to the render's command as they are.
struct OutputWords {
  std::string outfile, display, type, view, stats, display_server;
  int threads = 0;
  bool so_far = false, shown = false, quiet = false;

  Arguments words() const {
    Arguments out;
    for (const auto& [flag, value] : {std::pair{"--outfile", outfile},
                                      {"--display", display},
                                      {"--type", type},
                                      {"--view", view},
                                      {"--stats", stats},
                                      {"--display-server", display_server}}) {
      if (!value.empty()) out.push_back(fmt::format("{}={}", flag, value));
    }
    if (threads > 0) out.push_back(fmt::format("--nthreads={}", threads));
    if (quiet) out.emplace_back("--quiet");
    return out;
  }
};

/// The command that would render the whole picture, with where it is to go.
Arguments command_of_whole(const PartsPlan& plan, const std::string& scene, const OutputWords& output) {
  Arguments words;
  for (const std::string& word : plan.command.words)
    words.push_back(!scene.empty() && word == plan.command.scene ? scene : seen_from_here(word, plan.command.folder));
  for (std::string& word : output.words()) words.push_back(std::move(word));
  return words;
}

}  // namespace

int merge_command(const Arguments& args) {
  BeforeScene before{process_age(), {}};
  const Stopwatch reading_flags;
  std::vector<std::string> paths;
  std::string scene;
  OutputWords output;
  const CommandLine command{
      "whit merge",
      "Joins parts of a picture, which whit render --checkpoint PART made with --sample-range, --crop-pixels or both, "
      "to "
      "the picture of a single render.",
      {{"parts", &paths, "The parts, in any order", {.required = true, .files = ""}},
       {"--outfile,-o", &output.outfile, "Picture file, instead of the scene's", {.files = "exr pfm png jpg tga tiff"}},
       {"--display", &output.display, "Display picture beside a linear one; 'none' for none", {.files = "png jpg"}},
       {"--type", &output.type, "Numbers of an .exr: half or float", {.choices = {"half", "float"}}},
       {"--view", &output.view, "Display view, as of whit render"},
       {"--so-far", &output.so_far,
        "Join what there is: samples and pixels may be missing, and parts need not have ended. A pixel is the mean of "
        "its "
        "samples, and black without any"},
       {"--display-server", &output.display_server, "Show the picture: host:port of a tev viewer"},
       {"--shown", &output.shown,
        "With --display-server: an earlier call has opened it there; this one brings it up to date"},
       {"--scene", &scene, "Where the scene is now, if it is not where the parts found it", {.files = "pbrt gltf glb"}},
       {"--nthreads", &output.threads, "Threads; 0 is one per core", {.least = 0, .most = 4096}},
       {"--stats", &output.stats, "Figures of all parts together as JSON: a file, or - for stdout", {.files = "json"}},
       {"--quiet", &output.quiet, "No summary; problems are still reported"}}};
  int code = kDone;
  if (!parse_arguments(command, args, code)) return code;
  if (output.shown && output.display_server.empty()) {
    say("whit merge: --shown is of the picture that --display-server shows, and none is named");
    return kUsage;
  }
  const PartsPlan plan = plan_parts(paths, output.so_far ? FilmRender::Gaps::Allowed : FilmRender::Gaps::None);
  if (!plan.problem.empty()) {
    say("whit merge: " + plan.problem);
    return plan.unreadable ? kFileError : kUsage;
  }
  RenderSettings settings;
  settings.parts = &plan, settings.shown = output.shown;
  if (!read_render_flags(command_of_whole(plan, scene, output), settings, code)) return code;
  before.flags = reading_flags.elapsed();
  return render_scenes(settings, before);
}

}  // namespace whit
