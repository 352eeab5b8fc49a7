// Where the error is: the pixels that carry half of it, and what is there.
#pragma once

#include <span>

#include "core/accuracy/cost_levels.h"

namespace whit {

/// Squared error of each pixel, the mean of the replicates'.
std::vector<double> squared_errors(const CostLevel& level, const Picture& reference);

struct WorstThings {
  std::vector<CostWorst> things;  ///< Most first.
  size_t half = 0;                ///< So many pixels carry half of the squared error.
};

/// Traces one sample for each pixel to see what is there.
WorstThings find_worst(CostWorld& world, std::span<const double> squared_errors, const Picture& reference,
                       const Sources& sources);

}  // namespace whit
