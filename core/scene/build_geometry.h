// From groups to surfaces: their shapes become floats in the space of their group, and are handed to the ray tracer.
#pragma once

#include <vector>

#include "core/scene/build_groups.h"
#include "core/scene/build_lights.h"

namespace whit {

/// What is to know of the surfaces beyond what stands in the scene.
struct BakedGeometry {
  std::vector<LitShape> lit;
  int sort_keys = 0;  ///< Number of different SceneShape::sort_key.
};

/// Makes surfaces of all shapes, for `scene` and its ray tracer; what the groups hold of them is freed.
BakedGeometry bake_groups(const BuildContext& context, Groups& groups, Scene& scene);

/// Places the baked groups where instances and motion put them.
void place_instances(const BuildContext& context, const Groups& groups, Scene& scene);

}  // namespace whit
