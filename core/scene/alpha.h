// Alpha masks of shapes: textures that cut surfaces away, evaluated for the ray tracer.
#pragma once

#include <memory>

#include "core/scene/scene.h"

namespace whit {

/// The alpha test a shape needs, or null when its surface is whole. `shape` must stay where it is.
std::unique_ptr<AlphaTest> make_alpha_test(const SceneShape& geometry, const Shape& shape);

}  // namespace whit
