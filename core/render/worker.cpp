#include "core/render/worker.h"

namespace whit {

DimensionLayout::DimensionLayout(const Scene& scene) {
  int next = 2;
  if (scene.plan.needs_time) time = next++;
  if (scene.plan.needs_lens) lens = next, next += 2;
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
  while (levels_.size() <= static_cast<size_t>(depth)) levels_.emplace_back(scene.plan.needs_differentials);
  return levels_[static_cast<size_t>(depth)];
}

}  // namespace whit
