// Alpha masks of shapes: textures that cut surfaces away, evaluated for the ray tracer.
#pragma once

#include <memory>

#include "core/scene/scene.h"

namespace whit {

/// The alpha test of a shape. `shape` must stay where it is. `group_to_render` takes points of the shape's group to where
/// they would be in render space if the group were placed where it was defined: there, as in pbrt-v3, the textures are
/// evaluated.
std::unique_ptr<AlphaTest> make_alpha_test(const SceneShape& geometry, const Shape& shape,
                                           const Mat4d& group_to_render);

/// How many hits these tests have been asked about in this thread since the last call.
int64_t take_alpha_tests();

}  // namespace whit
