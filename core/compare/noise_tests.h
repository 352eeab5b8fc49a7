// The tests of a block: can its difference be noise alone.
#pragma once

#include "core/compare/noise_cells.h"

namespace whit {

/// Welch's test of the block's mean and Fisher's of the spread within it, by the variances that the files know.
BlockAnswer known_test(const BlockSums& sums, const NoiseModel& model, double area, double below);

/// Student's test of paired numbers: the difference's own spread within the block is its noise. Nothing to say of what has not
/// more than two independent pixels.
BlockAnswer paired_test(const BlockSums& sums, double area, double below);

}  // namespace whit
