// One worker's state: its scratch memory, the camera samples of its chunk, and the rays waiting at each depth.
#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "core/batch/arena.h"
#include "core/render/ray_queue.h"
#include "core/render/statistics.h"
#include "core/scene/scene.h"

namespace whit {

/// Which sample dimension serves what. Dimensions exist only for live effects; those of a bounce are the integrator's.
struct DimensionLayout {
  int time = -1;         ///< One dimension; -1 when nothing moves.
  int lens = -1;         ///< Two dimensions; -1 for a pinhole.
  int first_bounce = 2;  ///< Of what is drawn at the first surface.
  int per_bounce = 0;    ///< Integrator::dimensions().

  explicit DimensionLayout(const Scene& scene);
  int of_bounce(int depth, int offset) const { return first_bounce + depth * per_bounce + offset; }
};

/// Camera samples that are traced together; index = slot. Each ends as one radiance.
struct SampleChunk {
  int n = 0;
  int32_t *px = nullptr, *py = nullptr;
  uint32_t* index = nullptr;
  float *film_x = nullptr, *film_y = nullptr;
  float* time = nullptr;        ///< In [0,1] over the transform times; null when nothing moves.
  float* ray_weight = nullptr;  ///< Of the camera.
  RGBLanes radiance;
  float** aovs = nullptr;  ///< The arrays of AovPlan::columns; null when nobody asks for AOVs.
  uint8_t* met = nullptr;  ///< Likewise: 1 where the camera ray meets a surface that AOVs ask for.
};

struct AovPlan;

/// Everything a worker thread needs and no other may touch.
class Worker {
 public:
  Worker(const Scene& of, bool time_stages, const AovPlan* planned_aovs = nullptr)
      : scene(of), aovs(planned_aovs), layout(of), timed_(time_stages) {}

  const Scene& scene;
  const AovPlan* const aovs;  ///< Null when nobody asks for AOVs.
  const DimensionLayout layout;
  Arena arena;
  SampleChunk chunk;
  RenderStatistics statistics;

  /// Runs while the worker renders a tile of a render that is timed; null otherwise.
  StageClock* clock() { return clock_ ? &*clock_ : nullptr; }
  void start_clock();
  void stop_clock();

  struct Cursor {
    int depth, next;
  };
  std::vector<Cursor> cursors;  ///< Of trace_chunk().

  /// Rays waiting for their depth. The reference is good until the depth is left.
  RayQueue& level(int depth);
  /// Says that no rays of a depth are left, so that their memory can be another's: a path may have a million depths.
  void leave(int depth);

 private:
  const bool timed_;
  std::optional<StageClock> clock_;
  std::deque<RayQueue> queues_;    ///< A deque: references stay good while it grows.
  std::vector<RayQueue*> levels_;  ///< By depth; null for those that were left, or not yet come to.
  std::vector<RayQueue*> unused_;  ///< Of depths that were left. Rays of the camera, which may carry more, keep theirs.
};

}  // namespace whit
