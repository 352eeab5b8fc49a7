// What a render did: counted per worker, added up at the end.
#pragma once

#include <cstdint>

#include "core/base/vec.h"
#include "core/batch/stage_clock.h"

namespace whit {

struct RenderStatistics {
  int64_t camera_samples = 0;
  int64_t camera_rays = 0, reflection_rays = 0, refraction_rays = 0, indirect_rays = 0;
  int64_t passing_rays = 0, shadow_rays = 0, probe_rays = 0;
  int64_t clear_rays = 0;  ///< Of the shadow rays: those that were known to meet nothing, and not traced.
  std::array<double, kStages> stage_seconds{};  ///< Over all workers; zero when stages are not timed.
  int64_t surface_points = 0, footprints = 0;
  int64_t time_samples = 0, lens_samples = 0;
  int64_t texture_values = 0;  ///< Points that textures were evaluated at for materials.
  int64_t alpha_tests = 0;     ///< Hits that alpha masks were asked about.
  int64_t lights_skipped = 0;  ///< Batches times lights that could reach none of the batch's points.

  int64_t stopped_rays = 0;           ///< That did not get ahead at interfaces; their samples are invalid.
  int64_t invalid_samples = 0;        ///< NaN, infinite or of negative luminance: left out of the picture.
  Vec2i first_invalid_pixel{-1, -1};  ///< In picture order.
  uint32_t first_invalid_sample = 0;

  int64_t rays() const {
    return camera_rays + reflection_rays + refraction_rays + indirect_rays + passing_rays + shadow_rays + probe_rays;
  }
  void add(const RenderStatistics& o);
  void note_invalid(Vec2i pixel, uint32_t sample);
};

}  // namespace whit
