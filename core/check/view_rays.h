// Camera rays over the whole picture, few enough to be quick, and what they meet: what the checks look at.
#pragma once

#include <functional>

#include "core/render/tracer.h"

namespace whit {

/// Calls look(worker, rays, points) for batches of camera rays through pixels that are spread evenly over the picture, or what the film keeps of it, about
/// `most` of them at most; `points` are where they meet surfaces, past interfaces. Stops when look() returns false.
/// Returns how many rays there were.
int for_view_rays(const Scene& scene, int most, const std::function<bool(Worker&, const Rays&, const Points&)>& look);

/// Whether any of such rays brings light, by the scene's own integrator.
bool view_has_light(const Scene& scene, int most);

/// A shape, whatever it is made of, as a box of its group's space.
Box3d box_of(const SceneShape& shape);

/// A ray from `o` along the unit vector `d`, of render space: what it meets first within `t_max`.
struct Meeting {
  int shape = -1;  ///< Index into Scene::shapes, -1 for nothing.
  float t = 0;
};
Meeting first_met(const Scene& scene, const Vec3f& o, const Vec3f& d, float t_max);

}  // namespace whit
