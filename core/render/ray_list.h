// Rays waiting for their round: growable structure-of-arrays storage that is reused for the whole render.
#pragma once

#include <cstdint>
#include <vector>

#include "core/batch/lanes.h"

namespace whit {

/// Rays of one depth, ordered by slot (the sample they belong to). Render space.
class RayList {
 public:
  int n = 0;
  Vec3Lanes o, d;
  RGBLanes throughput;
  int32_t* slot = nullptr;           ///< Index of the camera sample in the worker's chunk.
  uint32_t* stream = nullptr;        ///< Branch of the ray tree, for the sampler.
  Vec3Lanes rx_o, rx_d, ry_o, ry_d;  ///< Differential rays; null when no effect needs them.

  explicit RayList(bool with_differentials) : with_differentials_(with_differentials) {}
  RayList(RayList&&) = default;
  RayList& operator=(RayList&&) = default;

  /// Floats, or integers of their size, that a ray takes, and those that its differentials take.
  static constexpr int kFields = 11, kDifferentialFields = 12;

  /// Makes room for `capacity` rays, keeping the first n.
  void reserve(int capacity);
  void clear() { n = 0; }

 private:
  bool with_differentials_;
  int capacity_ = 0;
  std::vector<float> storage_;
};

}  // namespace whit
