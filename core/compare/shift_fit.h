// How well a displacement explains what two pictures differ by.
#pragma once

#include <cstddef>
#include <vector>

#include "core/base/vec.h"
#include "core/compare/shift_levels.h"

namespace whit {

/// Sums of squared differences in cells of the picture, row by row.
struct CellErrors {
  int columns = 0, rows = 0;
  std::vector<double> sums;
};

/// How a hypothesis does against that of no displacement.
struct ShiftScore {
  double left = 1;   ///< The error that it leaves, as a share of that without.
  double gains = 0;  ///< What it gains, in its own standard deviations from cell to cell.
  /// The same of cells that are as large as to be independent of each other: the least for any size.
  double evidence = 0;
  size_t cells = 0;  ///< How many there are of the smallest size.

  static constexpr size_t kFewCells = 100;
  /// By both, because either alone comes about by chance: few places differ and happen to fit, or many gain next to nothing.
  /// Where there are few places, what fits by chance does not fit well.
  double value() const {
    if (!(left < (cells < kFewCells ? 0.2 : 1.0) && evidence > 0)) return 0;
    return evidence * (1 - left);
  }
};

ShiftScore score_of(const CellErrors& without, const CellErrors& with);

/// The displacement that fits best near a start.
struct ShiftFit {
  Vec2d by{0.0};         ///< In pixels of the level.
  double certainty = 0;  ///< Its length, in standard deviations of that as the cells of the picture agree on it.
  ShiftScore score;
};

/// Starts at whole pixels, goes to the best of them in at most so many steps, and from there between pixels by the shape of the errors around, of
/// pictures that are smoothed a little so that this shape is round. No score where the pictures are too small.
ShiftFit fit_shift(const ShiftLevel& level, Vec2i start, int steps);

/// The squared differences of two pictures of one size, summed over the cells.
CellErrors cell_errors(const ShiftPlane& a, const ShiftPlane& b);

}  // namespace whit
