// One camera sample of one pixel, traced again with an account of everything that happens.
#pragma once

#include "core/render/transport_log.h"

namespace whit {

/// The first sample of a pixel that is not valid; the brightest when all are.
uint32_t odd_sample(const Scene& scene, Vec2i pixel);

/// The account of sample `index` of a pixel of the full picture, as a text of lines; its last line is the sample's
/// radiance, as it would be added to the film. The numbers are those of render(): same rays, same random numbers.
std::string debug_sample(const Scene& scene, Vec2i pixel, uint32_t index, const TransportLog::Place& place);

}  // namespace whit
