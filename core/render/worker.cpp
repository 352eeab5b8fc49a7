#include "core/render/worker.h"

namespace whit {

DimensionLayout::DimensionLayout(const Scene& scene) {
  int next = 2;
  // What is on for a test draws numbers that others have, for none of these may change.
  if (scene.plan.live(Effect::MotionBlur)) time = scene.plan.needed.has(Effect::MotionBlur) ? next++ : 0;
  if (scene.plan.live(Effect::DepthOfField)) lens = scene.plan.needed.has(Effect::DepthOfField) ? next : 0;
  if (scene.plan.needed.has(Effect::DepthOfField)) next += 2;
  first_bounce = next;
  per_bounce = scene.light_dimensions + 2;
}

void Worker::start_clock() {
  if (timed_) clock_.emplace();
}

void Worker::stop_clock() {
  if (!clock_) return;
  clock_->enter(Stage::Film);
  for (size_t s = 0; s < kStages; ++s) statistics.stage_seconds[s] += clock_->seconds[s];
  clock_.reset();
}

RayList& Worker::level(int depth) {
  while (levels_.size() <= static_cast<size_t>(depth)) levels_.emplace_back(scene.plan.needs_differentials());
  return levels_[static_cast<size_t>(depth)];
}

}  // namespace whit
