// Textures that say how much of its radiance a surface has where.
#pragma once

#include <vector>

#include "core/scene/scene.h"

namespace whit {

/// Values of an emission map; what is no number counts as 0.
RGBLanes emission_values(const Tex<RGB>& map, const ShadingBatch& s);

/// The mean of the map over each triangle of the shape's mesh, or over the shape: of 16 points, one in the middle of each
/// of as many equal parts, each filtered over its part. 0 where all of them are black.
std::vector<RGB> emission_means(const SceneShape& shape, const Tex<RGB>& map);

}  // namespace whit
