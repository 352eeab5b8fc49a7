// Rays waiting for their depth: growable storage that is reused for the whole render.
#pragma once

#include <memory>

#include "core/batch/fields.h"
#include "core/batch/rays.h"

namespace whit {

/// Which arrays rays carry beside those that all have.
struct CarriedByRays {
  bool differentials = false;
  bool time = false;
  bool densities = false;  ///< Rays::pdf and from.
  bool eta2 = false;
  bool via = false;
};

/// Rays of one depth, ordered by slot (the sample they belong to).
class RayQueue {
 public:
  RayQueue(int depth, const CarriedByRays& carried);

  /// The rays so far; the arrays have room for what reserve() was asked for.
  const Rays& rays() const { return rays_; }
  int n() const { return rays_.n; }

  /// Makes room for `capacity` rays, keeping those that are there.
  void reserve(int capacity);
  /// The next n of the room, for the caller to fill: all of them rays from now on.
  Rays append(int n);
  /// No rays, of this depth from now on. Their memory stays.
  void start(int depth) { rays_.n = 0, rays_.depth = depth; }

 private:
  Rays rays_;  ///< Before the first reserve(), arrays that are carried point to nothing of use.
  int capacity_ = 0;
  std::unique_ptr<Arena> storage_;
};

}  // namespace whit
