// Integrators say what happens to light; the renderer moves the batches. They meet here.
#pragma once

#include "core/plugin/param.h"

namespace whit {

/// One batch of rays of the same depth on its way through the stages. Implemented by core/render.
class RayRound {
 public:
  virtual ~RayRound() = default;
  /// Specular bounces so far, 0 for camera rays.
  virtual int depth() const = 0;
  /// Finds the nearest surfaces. Surfaces of interface materials are passed through.
  virtual void intersect() = 0;
  /// Adds, for rays that hit nothing, the radiance of the lights at infinity.
  virtual void add_escaped() = 0;
  /// Computes the surface points of the hits, grouped by material, with their lobes.
  virtual void find_surfaces() = 0;
  /// Adds the emission of surfaces that emit.
  virtual void add_emitted() = 0;
  /// Number of lights that can be sampled, and the direct light of one of them, with shadows.
  virtual int light_count() const = 0;
  virtual void add_direct(int light) = 0;
  /// Sends rays on in the mirror direction and in the refracted direction of specular lobes, for the next round.
  virtual void spawn_specular() = 0;
};

class Integrator : public Plugin {
 public:
  static constexpr const char* kCategory = "integrator";
  /// What happens to one round of rays: called once per batch and depth.
  virtual void shade(RayRound& round) const = 0;
  /// Rounds of rays at most (maxdepth).
  virtual int max_depth() const = 0;
  /// The part of the picture "pixelbounds" restricts rendering to: x0, x1, y0, y1 in pixels; all by default.
  const std::vector<int>& pixel_bounds() const { return pixel_bounds_; }

 protected:
  std::vector<int> pixel_bounds_;
};

}  // namespace whit
