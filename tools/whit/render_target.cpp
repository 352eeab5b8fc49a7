#include "tools/whit/render_target.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "core/accuracy/report_words.h"
#include "core/accuracy/target_json.h"
#include "core/session/overrides.h"
#include "tools/whit/json.h"
#include "tools/whit/quantities.h"
#include "tools/whit/stop_signals.h"
#include "tools/whit/terminal.h"
#include "tools/whit/text_file.h"

namespace whit {
namespace {

/// "0.94 % [0.81 %, 1.00 %]".
std::string claim_text(const ErrorClaim& claim) {
  return fmt::format("{} [{}, {}]", percent_text(claim.value), percent_text(claim.low), percent_text(claim.high));
}

/// What the claim leaves out.
std::string doubts_text(const Doubts& doubts) {
  if (doubts.count == 0) return {};
  const double share = static_cast<double>(doubts.count) / static_cast<double>(doubts.pixels.size());
  std::string where;
  for (const Vec2i& p : doubts.densest) where += fmt::format("{}{},{}", where.empty() ? "" : "; ", p.x, p.y);
  return fmt::format(
      "\n{} pixels ({}) are not trusted and left out of it: beside much brighter ones, or much quieter than those "
      "around\n"
      "them; most around {}.",
      doubts.count, percent_text(share), where);
}

TargetGoal goal_of(const TargetFlags& flags) {
  return {flags.error.empty() ? 0 : share_of(flags.error), share_of(flags.confidence)};
}

}  // namespace

void use_extending_samplers(const RenderSettings& settings, ParsedFile& file) {
  for (SceneDescription& world : file.worlds) {
    const std::string name = use_extending_sampler(world);
    if (!name.empty() && !settings.quiet)
      say(fmt::format("sampled by sobol: samples of {} cannot go on beyond their number", name));
  }
}

TargetOutcome render_to_target(const RenderSettings& settings, BuiltWorld& world, RenderOptions options,
                               std::chrono::steady_clock::time_point started,
                               const std::function<double(const RenderResult&)>& write, HandOut* others) {
  using Clock = std::chrono::steady_clock;
  const TargetFlags& flags = settings.target;
  TargetRequest request;
  const TargetGoal goal = goal_of(flags);
  request.error = goal.error, request.confidence = goal.confidence;
  request.max_samples = static_cast<uint32_t>(flags.max_samples);
  if (!flags.time_limit.empty()) {
    const std::chrono::duration<double> limit(duration_of(flags.time_limit));
    request.deadline = started + std::chrono::duration_cast<Clock::duration>(limit);
    request.first_picture = write;
  }
  if (others) {
    request.render_pass = [others](FilmRender& film, const TargetState& state, const auto& share) {
      return others->render_pass(film, state, share);
    };
  }
  std::optional<Progress> progress;
  if (!settings.quiet) progress.emplace("rendering");
  request.progress = [&](const TargetState& state) {
    const std::string error =
        std::isfinite(state.claim.value) ? fmt::format(", error {}", percent_text(state.claim.value)) : "";
    if (progress) progress->update(state.share, "rendering" + error);
    return !StopSignals::come();
  };
  return render_to_target(world, std::move(options), request, settings.seed);
}

int report_target(const RenderSettings& settings, const TargetOutcome& o, double seconds) {
  const bool has_target = !settings.target.error.empty();
  if (!settings.quiet) {
    say(fmt::format("{}: {}, nRMSE, {} sure; {:.1f} samples per pixel.{}", target_end_text(o, has_target),
                    std::isinf(o.claim.value) ? "error unknown" : "error " + claim_text(o.claim),
                    settings.target.confidence, o.rendered.result.samples_per_pixel, doubts_text(o.doubts)));
  }
  if (const std::string& file = settings.target.json; !file.empty()) {
    if (const std::string problem = write_text(file, to_text(target_json(o, goal_of(settings.target), seconds)) + '\n');
        !problem.empty()) {
      say("whit: " + problem);
      return kFileError;
    }
  }
  const bool reached = o.end == TargetEnd::Met || (!has_target && o.whole);
  return reached ? kDone : kLimit;
}

}  // namespace whit
