// What rendering to an accuracy or to a time came to, for machines.
#pragma once

#include "core/accuracy/target.h"
#include "core/base/json.h"

namespace whit {

/// What was asked for.
struct TargetGoal {
  double error = 0;  ///< nRMSE; 0: as far as the time reaches.
  double confidence = 0.95;
};

/// "target met", "time limit, target not met" ...
const char* target_end_text(const TargetOutcome& outcome, bool has_target);

/// {"target", "confidence", "achieved", "met", "end", "samples_mean", "untrusted_pixels", "seconds", "untrusted_window"};
/// `seconds` is what all of it took. The error may be infinite: not known.
Json::Object target_json(const TargetOutcome& outcome, const TargetGoal& goal, double seconds);

}  // namespace whit
