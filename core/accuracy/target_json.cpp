#include "core/accuracy/target_json.h"

namespace whit {

const char* target_end_text(const TargetOutcome& o, bool has_target) {
  switch (o.end) {
    case TargetEnd::Met: return "target met";
    case TargetEnd::Time: return has_target ? "time limit, target not met" : "time limit";
    case TargetEnd::Samples: return has_target ? "not met with --max-samples" : "--max-samples";
    case TargetEnd::Stopped: return "stopped";
    case TargetEnd::Failed: return "failed";
  }
  return "";
}

Json::Object target_json(const TargetOutcome& o, const TargetGoal& goal, double seconds) {
  Json::Object j{
      {"target", goal.error == 0 ? Json() : Json(goal.error)},
      {"confidence", goal.confidence},
      {"achieved", Json::Object{{"value", o.claim.value}, {"lower95", o.claim.low}, {"upper95", o.claim.high}}},
      {"met", o.end == TargetEnd::Met},
      {"end", target_end_text(o, goal.error > 0)},
      {"samples_mean", o.rendered.result.samples_per_pixel},
      {"untrusted_pixels", o.doubts.count},
      {"seconds", seconds}};
  if (o.doubts.count > 0) {
    const Box2i& w = o.doubts.where;
    j.emplace_back("untrusted_window", Json::Array{w.min.x, w.min.y, w.max.x + 1, w.max.y + 1});
  }
  return j;
}

}  // namespace whit
