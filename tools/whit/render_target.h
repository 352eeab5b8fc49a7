// Rendering to an accuracy or to a time, as `whit render` is asked for it.
#pragma once

#include <functional>

#include "core/accuracy/target.h"
#include "tools/whit/hand_out.h"
#include "tools/whit/render_flags.h"

namespace whit {

/// Gives worlds whose sampler has sets of a number of samples one that goes on, sobol, which has the same limit; but where
/// samples lie at places that were asked for. Says so unless quiet.
void use_extending_samplers(const RenderSettings& settings, ParsedFile& file);

/// Renders as far as the flags say; `started` is when the time limit began to run, `write` writes a picture and returns
/// the seconds that took. `others` take the samples, where it is not null.
TargetOutcome render_to_target(const RenderSettings& settings, BuiltWorld& world, RenderOptions options,
                               std::chrono::steady_clock::time_point started,
                               const std::function<double(const RenderResult&)>& write, HandOut* others);

/// Says what it came to, as text unless quiet and as JSON if asked for. Returns the exit code: kLimit where the target
/// was not met.
int report_target(const RenderSettings& settings, const TargetOutcome& outcome, double seconds);

}  // namespace whit
