// Where the lights of a scene shine: plugins say it themselves, emitting primitives are asked here.
#pragma once

#include "core/scene/scene.h"

namespace whit {

/// The reach of a light whose shape, if it has one, is in the scene.
LightReach reach_of(const Scene& scene, const SceneLight& light);

}  // namespace whit
