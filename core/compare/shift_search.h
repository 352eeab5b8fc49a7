// All displacements by whole pixels at once.
#pragma once

#include <utility>
#include <vector>

#include "core/base/vec.h"
#include "core/compare/shift_levels.h"

namespace whit {

/// The errors that displacements leave, as shares of the error without, over the pixels that both pictures have then.
class ShiftMap {
 public:
  /// Up to `reach` pixels each way, of parts of pictures that lie in the same places; sums over all parts.
  ShiftMap(const std::vector<std::pair<ShiftPlane, ShiftPlane>>& out_and_ref, Vec2i reach);

  /// The one that takes most of the error away; of those that take as much and lie together, the shortest.
  Vec2i best() const { return best_; }
  double left(Vec2i by) const { return left_[index(by)]; }
  /// True when others, which are not around it, explain as much as `by`: the pictures repeat themselves.
  bool ambiguous(Vec2i by) const;

 private:
  size_t index(Vec2i by) const;
  Vec2i by_of(size_t index) const;
  std::vector<bool> around(Vec2i by, double most) const;

  Vec2i reach_, best_{0};
  std::vector<double> left_;
};

}  // namespace whit
