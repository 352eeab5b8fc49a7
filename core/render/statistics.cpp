#include "core/render/statistics.h"

#include <tuple>

namespace whit {

void RenderStatistics::note_invalid(Vec2i pixel, uint32_t sample) {
  const auto key = std::make_tuple(pixel.y, pixel.x, sample);
  const auto first = std::make_tuple(first_invalid_pixel.y, first_invalid_pixel.x, first_invalid_sample);
  if (first_invalid_pixel.y < 0 || key < first) first_invalid_pixel = pixel, first_invalid_sample = sample;
  ++invalid_samples;
}

void RenderStatistics::add(const RenderStatistics& o) {
  camera_samples += o.camera_samples;
  camera_rays += o.camera_rays, reflection_rays += o.reflection_rays, refraction_rays += o.refraction_rays;
  indirect_rays += o.indirect_rays, probe_rays += o.probe_rays;
  passing_rays += o.passing_rays, shadow_rays += o.shadow_rays, clear_rays += o.clear_rays;
  surface_points += o.surface_points, footprints += o.footprints;
  time_samples += o.time_samples, lens_samples += o.lens_samples;
  texture_values += o.texture_values, alpha_tests += o.alpha_tests;
  lights_skipped += o.lights_skipped, stopped_rays += o.stopped_rays;
  for (size_t s = 0; s < kStages; ++s) stage_seconds[s] += o.stage_seconds[s];
  if (o.invalid_samples == 0) return;
  const int64_t total = invalid_samples + o.invalid_samples;
  note_invalid(o.first_invalid_pixel, o.first_invalid_sample);
  invalid_samples = total;
}

}  // namespace whit
