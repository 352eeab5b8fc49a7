// What the shadow rays of a scene's lights end on: plugins say where they are, emitting primitives are asked here.
#pragma once

#include "core/scene/scene.h"

namespace whit {

/// For a light of a scene whose ray tracer is built.
RayEnd end_of(const Scene& scene, const SceneLight& light);

}  // namespace whit
