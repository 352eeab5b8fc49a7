#include "core/render/debug_sample.h"

#include <fmt/format.h>

#include <cmath>

#include "core/render/flush_denormals.h"
#include "core/render/trace.h"

namespace whit {

namespace {

/// Traces one sample; it stays in worker.chunk as long as the arena's scope lasts.
void trace_sample(Worker& worker, Vec2i pixel, uint32_t index, const Wrap& wrap = {}) {
  const int32_t x = pixel.x, y = pixel.y;
  generate_camera_rays(worker, 1, &x, &y, &index);
  trace_chunk(worker, wrap);
}

}  // namespace

uint32_t odd_sample(const Scene& scene, Vec2i pixel) {
  const FlushDenormals flush;
  Worker worker(scene, false);
  uint32_t brightest = 0;
  float most = -1;
  for (uint32_t index = 0; index < static_cast<uint32_t>(scene.samples_per_pixel); ++index) {
    const ArenaScope scope(worker.arena);
    trace_sample(worker, pixel, index);
    const RGB sum = worker.chunk.radiance[0];
    if (!is_usable_sample(sum)) return index;
    if (luminance(sum) > most) most = luminance(sum), brightest = index;
  }
  return brightest;
}

std::string debug_sample(const Scene& scene, Vec2i pixel, uint32_t index, const TransportLog::Place& place) {
  const FlushDenormals flush;
  Worker worker(scene, false);
  std::string text;
  const ArenaScope scope(worker.arena);
  trace_sample(worker, pixel, index,
               [&](Tracer& tracer) { return std::make_unique<TransportLog>(tracer, place, text); });
  const SampleChunk& c = worker.chunk;
  const std::string time = c.time ? fmt::format(", time {:.6g} of the transforms' interval", c.time[0]) : "";
  const RGB sum = c.radiance[0];
  return fmt::format("sample {} of pixel {},{}: film position ({:.9g}, {:.9g}), camera weight {:.6g}{}\n", index,
                     pixel.x, pixel.y, c.film_x[0], c.film_y[0], c.ray_weight[0], time) +
         text +
         fmt::format("radiance [{:.9g} {:.9g} {:.9g}], luminance {:.9g}{}\n", sum.x, sum.y, sum.z, luminance(sum),
                     is_usable_sample(sum) ? "" : ": not a valid sample, left out of the picture");
}

}  // namespace whit
