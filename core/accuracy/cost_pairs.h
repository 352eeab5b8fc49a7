// The scene as it stands beside the scene with one thing changed: pictures in pairs of the same seeds and samples, of one
// process, rendered tile by tile in turn.
#pragma once

#include <vector>

#include "core/accuracy/cost_levels.h"

namespace whit {

struct CostPairs {
  int samples = 0;
  std::vector<Picture> base, variant;
  std::vector<Elapsed> base_spent, variant_spent;
  int size() const { return static_cast<int>(variant.size()); }
};

/// As many of the pairs as the clock allows.
CostPairs render_pairs(CostWorld& base, CostWorld& variant, const CostRequest& request, CostClock& clock, int samples,
                       int pairs);

/// How the pictures of the pairs differ, apart from the noise that their seeds have in common.
struct PairDifference {
  Estimate bias;                 ///< Root mean square of the difference of their limits, over the mean radiance.
  double mean_change = 0;        ///< Mean of variant - base, over the mean radiance.
  double pixels_changed = 0;     ///< Share whose luminance is off by more than 1 %, beyond what the seeds explain.
  std::vector<float> magnitude;  ///< Of each pixel's mean difference: three channels, over the mean radiance.
};
PairDifference difference_of(const CostPairs& pairs, const Picture& reference);

}  // namespace whit
