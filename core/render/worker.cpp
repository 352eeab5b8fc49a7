#include "core/render/worker.h"

#include "core/render/aov_plan.h"

namespace whit {

DimensionLayout::DimensionLayout(const Scene& scene) {
  int next = 2;
  // What is on for a test draws numbers that others have, for none of these may change.
  if (scene.plan.live(Effect::MotionBlur)) time = scene.plan.needed.has(Effect::MotionBlur) ? next++ : 0;
  if (scene.plan.live(Effect::DepthOfField)) lens = scene.plan.needed.has(Effect::DepthOfField) ? next : 0;
  if (scene.plan.needed.has(Effect::DepthOfField)) next += 2;
  first_bounce = next;
  per_bounce = scene.integrator().dimensions(scene.light_dimensions);
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

RayQueue& Worker::level(int depth) {
  const auto number = static_cast<size_t>(depth);
  if (number >= levels_.size()) levels_.resize(number + 1, nullptr);
  RayQueue*& queue = levels_[number];
  if (queue) return *queue;
  if (depth > 0 && !unused_.empty()) {
    queue = unused_.back();
    unused_.pop_back();
    queue->start(depth);
    return *queue;
  }
  const Integrator& integrator = scene.integrator();
  CarriedByRays carried;
  carried.differentials = scene.plan.needs_differentials() && (depth == 0 || integrator.keeps_differentials());
  carried.time = scene.plan.live(Effect::MotionBlur);
  carried.densities = integrator.keeps_densities();
  carried.eta2 = integrator.keeps_densities() && scene.plan.live(Effect::Refraction);
  carried.via = aovs && aovs->parts;
  queue = &queues_.emplace_back(depth, carried);
  return *queue;
}

void Worker::leave(int depth) {
  RayQueue*& queue = levels_[static_cast<size_t>(depth)];
  queue->start(depth);
  if (depth == 0) return;
  unused_.push_back(queue);
  queue = nullptr;
}

}  // namespace whit
