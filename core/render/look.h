// What there is at a place of the picture: one ray through it, for people who point there.
#pragma once

#include "core/scene/scene.h"

namespace whit {

/// The first surface that shows there.
struct LookedAt {
  int shape = -1;  ///< Index into Scene::shapes; -1 where there is nothing.
  uint32_t primitive = 0;
  int instance = -1;     ///< Index into Scene::instances; -1 for what stands in the world by itself.
  double depth = 0;      ///< Along the camera's axis, as the AOV Z, and
  double distance = 0;   ///< from the camera, in the world's units.
  Vec3d point{0, 0, 0};  ///< In the world.
};

/// `film` in pixels of the whole picture, as the camera has it: (0.5, 0.5) is the middle of the first. Through the middle
/// of the lens, as the shutter opens.
LookedAt look_at_film(const Scene& scene, Vec2d film);

}  // namespace whit
