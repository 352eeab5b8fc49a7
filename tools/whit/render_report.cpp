#include "tools/whit/render_report.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/accel/accel.h"
#include "tools/whit/terminal.h"

namespace whit {
namespace {

/// Parts of a start that take no millisecond are not worth a word.
constexpr double kShown = 0.5e-3;

/// "build 257 ms (geometry read in 40 ms, ray tracer built in 163 ms)": what a build took, and which parts of it took long.
std::string build_text(const StepTimes& times, const BuildTimes& build) {
  constexpr double kLong = 0.01, kLargeShare = 0.1;
  std::string parts;
  for (const StartPart& part : build_parts(build)) {
    if (part.elapsed.wall < std::max(kLong, kLargeShare * times.build.wall)) continue;
    parts += fmt::format("{}{} in {}", parts.empty() ? " (" : ", ", part.words, duration_text(part.elapsed.wall));
  }
  return duration_text(times.build.wall) + parts + (parts.empty() ? "" : ")");
}

void more_statistics(const RenderOutcome& outcome) {
  const Scene& scene = outcome.scene;
  const RenderStatistics& s = outcome.result.statistics;
  const StepTimes& times = outcome.times;
  const TextureStatistics t = outcome.textures.statistics();
  std::string parts;
  for (const StartPart& part : start_parts(times, scene.build_times)) {
    if (part.elapsed.wall < kShown && part.elapsed.cpu < kShown) continue;
    parts += fmt::format("{}{} in {} ({})", parts.empty() ? ": " : ", ", part.words, duration_text(part.elapsed.wall),
                         duration_text(part.elapsed.cpu));
  }
  say(fmt::format("ready to trace after {} ({} of processor time){}; {} resident after parsing.",
                  duration_text(times.ready.wall), duration_text(times.ready.cpu), parts,
                  bytes_text(outcome.parsed_memory)));
  say(fmt::format("{}: geometry {}, {} shapes, {} instances, {} of {} lights sampled per point.", accel_version(),
                  bytes_text(static_cast<double>(scene.geometry_bytes())), scene.shapes.size(), scene.instances.size(),
                  scene.chosen_lights > 0 ? static_cast<size_t>(scene.chosen_lights) : scene.lights.size(),
                  scene.lights.size()));
  say(fmt::format("{} surface points, {} footprints, {} interface crossings.", count_text(s.surface_points),
                  count_text(s.footprints), count_text(s.passing_rays)));
  say(fmt::format("{} time samples, {} lens samples, {} alpha tests, {} texture values.", count_text(s.time_samples),
                  count_text(s.lens_samples), count_text(s.alpha_tests), count_text(s.texture_values)));
  say(fmt::format("{} times a light could reach none of a batch of points, and was skipped.",
                  count_text(s.lights_skipped)));
  say(fmt::format(
      "textures: {} lookups, {} decodes of {} files in {} of CPU to {}, {} trims, {} evictions, {} returns, peak {}.",
      count_text(t.lookups), t.decodes, t.files, duration_text(t.decode_seconds),
      bytes_text(static_cast<double>(t.decoded_bytes)), t.trims, t.evictions, t.returns,
      bytes_text(static_cast<double>(t.peak_bytes))));
}

/// Where there are many, that each was sampled, or how few were; integrators that always choose say nothing.
void say_lights(const Scene& scene) {
  constexpr size_t kMany = 100;
  const std::string all = count_text(static_cast<double>(scene.lights.size()));
  if (scene.chosen_lights > 1)
    say(fmt::format("{} of {} lights sampled at each point, as a tree of them chose (--lights tree).",
                    scene.chosen_lights, all));
  else if (scene.chosen_lights == 0 && scene.lights.size() >= kMany)
    say(fmt::format(
        "{} lights, each sampled at every point that it may reach; '--lights tree' samples {} (noisier, much faster).",
        all, kLightsOfTree));
}

}  // namespace

void report_invalid(const RenderStatistics& s) {
  say(fmt::format(
      "whit: warning: {} samples were not valid (NaN, infinite or of negative luminance) and were left out; "
      "the first is sample {} of "
      "pixel {},{} (--debug-pixel {},{},{} tells how it comes about)",
      s.invalid_samples, s.first_invalid_sample, s.first_invalid_pixel.x, s.first_invalid_pixel.y,
      s.first_invalid_pixel.x, s.first_invalid_pixel.y, s.first_invalid_sample));
  if (s.stopped_rays == 0) return;
  say(fmt::format(
      "whit: warning: {} rays did not get ahead at surfaces of material \"none\", and their samples are among "
      "those left out",
      s.stopped_rays));
}

void summarise(const RenderOutcome& outcome, bool with_statistics) {
  const auto& [scene, r, output, textures, times, unread_files, parsed_memory, estimate] = outcome;
  const RenderStatistics& s = r.statistics;
  say(fmt::format("start {}, parse {}, plan {}, build {}, render {}, write {} on {} thread{}.",
                  duration_text(times.program.wall + times.flags.wall + times.output.wall),
                  duration_text(times.parse.wall), duration_text(times.plan.wall), build_text(times, scene.build_times),
                  duration_text(times.render.wall), duration_text(times.write.wall), r.threads,
                  r.threads == 1 ? "" : "s"));
  const auto if_any = [](int64_t rays, const char* what) {
    return rays > 0 ? fmt::format(", {} {}", count_text(rays), what) : std::string();
  };
  say(fmt::format("{} rays: {} camera, {} reflection, {} refraction, {} shadow{}{}{}; {:.2f} Mrays/s.",
                  count_text(s.rays()), count_text(s.camera_rays), count_text(s.reflection_rays),
                  count_text(s.refraction_rays), count_text(s.shadow_rays),
                  s.clear_rays > 0 ? fmt::format(" ({} in the clear)", count_text(s.clear_rays)) : "",
                  if_any(s.indirect_rays, "indirect"), if_any(s.probe_rays, "from lobes to lights"),
                  s.rays() / std::max(1e-9, r.seconds) / 1e6));
  const std::string rounding = scene.sampler().rounding();
  say(fmt::format("{:.5g} samples per pixel{}, {} triangles, peak memory {}, invalid samples {}.", r.samples_per_pixel,
                  rounding.empty() ? "" : " (" + rounding + ")",
                  count_text(static_cast<double>(scene.triangle_count())),
                  bytes_text(static_cast<double>(peak_memory())), s.invalid_samples));
  say_lights(scene);
  if (const size_t n = unread_files; n > 0)
    say(fmt::format("{} file{} of objects that are never placed {} not read (whit explain lists {}).", n,
                    n == 1 ? "" : "s", n == 1 ? "was" : "were", n == 1 ? "it" : "them"));
  if (with_statistics) more_statistics(outcome);
  if (output.main_file.empty()) return;
  if (is_linear_format(output.main_file)) {
    say(fmt::format("linear:  {}", output.main_file));
    if (!output.display_file.empty())
      say(fmt::format("display: {}  [{}]", output.display_file, output.display->describe()));
  } else {
    say(fmt::format("display: {}  [{}]", output.main_file, output.display->describe()));
  }
}

}  // namespace whit
