#include "core/render/debug_sample.h"

#include <fmt/format.h>

#include <cmath>

#include "core/render/flush_denormals.h"
#include "core/render/trace.h"

namespace whit {

uint32_t odd_sample(const Scene& scene, Vec2i pixel) {
  const FlushDenormals flush;
  Worker worker(scene, false);
  uint32_t brightest = 0;
  float most = -1;
  for (uint32_t index = 0; index < static_cast<uint32_t>(scene.samples_per_pixel); ++index) {
    const ArenaScope scope(worker.arena);
    const int32_t x = pixel.x, y = pixel.y;
    generate_camera_rays(worker, 1, &x, &y, &index);
    trace_chunk(worker);
    const RGB sum = worker.chunk.radiance[0];
    if (!is_usable_sample(sum)) return index;
    if (luminance(sum) > most) most = luminance(sum), brightest = index;
  }
  return brightest;
}

std::string debug_sample(const Scene& scene, Vec2i pixel, uint32_t index, const RoundLog::Place& place) {
  const FlushDenormals flush;
  Worker worker(scene, false);
  RoundLog log(scene, place);
  worker.log = &log;
  const int32_t x = pixel.x, y = pixel.y;
  const ArenaScope scope(worker.arena);
  generate_camera_rays(worker, 1, &x, &y, &index);
  const SampleChunk& c = worker.chunk;
  log.line(fmt::format("sample {} of pixel {},{}: film position ({:.9g}, {:.9g}), camera weight {:.6g}{}", index, x, y,
                       c.film_x[0], c.film_y[0], c.ray_weight[0],
                       c.time ? fmt::format(", time {:.6g} of the transforms' interval", c.time[0]) : ""));
  trace_chunk(worker);
  const RGB sum = c.radiance[0];
  log.line(fmt::format("radiance [{:.9g} {:.9g} {:.9g}], luminance {:.9g}{}", sum.x, sum.y, sum.z, luminance(sum),
                       is_usable_sample(sum) ? "" : ": not a valid sample, left out of the picture"));
  return log.text();
}

}  // namespace whit
