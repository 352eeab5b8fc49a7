#include "tools/whit/render_target.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "core/accuracy/report_words.h"
#include "core/plugin/registry.h"
#include "core/plugin/sampler.h"
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

const char* end_text(const TargetOutcome& o, bool has_target) {
  switch (o.end) {
    case TargetEnd::Met: return "target met";
    case TargetEnd::Time: return has_target ? "time limit, target not met" : "time limit";
    case TargetEnd::Samples: return has_target ? "not met with --max-samples" : "--max-samples";
    case TargetEnd::Stopped: return "stopped";
  }
  return "";
}

/// Numbers that are not finite are written as null.
Json json_of(const RenderSettings& settings, const TargetOutcome& o, double seconds) {
  Json::Object j{
      {"target", settings.target.error.empty() ? Json() : Json(share_of(settings.target.error))},
      {"confidence", share_of(settings.target.confidence)},
      {"achieved", Json::Object{{"value", o.claim.value}, {"lower95", o.claim.low}, {"upper95", o.claim.high}}},
      {"met", o.end == TargetEnd::Met},
      {"end", end_text(o, !settings.target.error.empty())},
      {"samples_mean", o.rendered.result.samples_per_pixel},
      {"untrusted_pixels", o.doubts.count},
      {"seconds", seconds}};
  if (o.doubts.count > 0) {
    const Box2i& w = o.doubts.where;
    j.emplace_back("untrusted_window", Json::Array{w.min.x, w.min.y, w.max.x + 1, w.max.y + 1});
  }
  return j;
}

/// Samples at fixed places are not what another sampler's tend to.
bool has_fixed_places(const Entity& sampler) {
  for (const Parameter& p : sampler.params) {
    const bool truth = p.type == ParamType::Bool && !p.bools().empty() && p.bools()[0] != 0;
    if ((p.name == "samplepixelcenter" && truth) || (p.name == "jitter" && !truth)) return true;
  }
  return false;
}

}  // namespace

void use_extending_samplers(const RenderSettings& settings, ParsedFile& file) {
  for (SceneDescription& world : file.worlds) {
    const std::string name = sampler_in_force(world).name;
    const std::unique_ptr<Plugin> made = sampler_in_force(world).make();
    if (static_cast<const Sampler&>(*made).extends() || has_fixed_places(world.sampler)) continue;
    Overrides sobol;
    sobol.sampler = "sobol";
    override_world(world, sobol);
    if (!settings.quiet) say(fmt::format("sampled by sobol: samples of {} cannot go on beyond their number", name));
  }
}

TargetOutcome render_to_target(const RenderSettings& settings, BuiltWorld& world, RenderOptions options,
                               std::chrono::steady_clock::time_point started,
                               const std::function<double(const RenderResult&)>& write) {
  using Clock = std::chrono::steady_clock;
  const TargetFlags& flags = settings.target;
  TargetRequest request;
  request.error = flags.error.empty() ? 0 : share_of(flags.error);
  request.confidence = share_of(flags.confidence);
  request.max_samples = static_cast<uint32_t>(flags.max_samples);
  if (!flags.time_limit.empty()) {
    const std::chrono::duration<double> limit(duration_of(flags.time_limit));
    request.deadline = started + std::chrono::duration_cast<Clock::duration>(limit);
    request.first_picture = write;
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
    say(fmt::format("{}: {}, nRMSE, {} sure; {:.1f} samples per pixel.{}", end_text(o, has_target),
                    std::isinf(o.claim.value) ? "error unknown" : "error " + claim_text(o.claim),
                    settings.target.confidence, o.rendered.result.samples_per_pixel, doubts_text(o.doubts)));
  }
  if (const std::string& file = settings.target.json; !file.empty()) {
    if (const std::string problem = write_text(file, to_text(json_of(settings, o, seconds)) + '\n'); !problem.empty()) {
      say("whit: " + problem);
      return kFileError;
    }
  }
  const bool reached = o.end == TargetEnd::Met || (!has_target && o.whole);
  return reached ? kDone : kLimit;
}

}  // namespace whit
