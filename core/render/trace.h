// From camera samples to radiances: the depth-by-depth loop over batches of rays.
#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <memory>

#include "core/plugin/transport.h"
#include "core/render/worker.h"

namespace whit {

/// Rays of a batch at most: what the stages' arrays of a batch take stays within a worker's L2 cache.
inline constexpr int kBatch = 1024;

/// Fills worker.chunk with the camera samples of `n` (pixel, index) pairs: film positions, times, and the
/// rays of depth 0.
void generate_camera_rays(Worker& worker, int n, const int32_t* px, const int32_t* py, const uint32_t* index);

/// Whether a sample can be part of a picture: finite, and of no negative luminance. A channel may be below zero, where a
/// light's colour is outside of Rec.709. -1e-5 is pbrt's.
inline bool is_usable_sample(const RGB& l) {
  const float size = std::abs(l.x) + std::abs(l.y) + std::abs(l.z);
  const bool not_negative = luminance(l) >= -1e-5f, finite = size <= std::numeric_limits<float>::max();
  return not_negative & finite;
}

class Tracer;

/// What watches the transport, around it.
using Wrap = std::function<std::unique_ptr<Transport>(Tracer&)>;

/// Traces the chunk's rays until none is left; worker.chunk.radiance holds the result.
void trace_chunk(Worker& worker, const Wrap& wrap = {});

}  // namespace whit
