// How far the pictures of a setting are from the reference, and how long they take.
#pragma once

#include <span>
#include <vector>

#include "core/accuracy/cost_levels.h"

namespace whit {

/// Median, least and greatest.
Estimate median_and_ends(std::vector<double> values);
/// What a whole command takes, by what its samples took in each replicate.
void set_seconds(const Elapsed& fixed, std::span<const Elapsed> spent, CostSetting& setting);

class CostJudge {
 public:
  /// Keeps references to both.
  CostJudge(const CostLevels& levels, const DisplayTransform& display);
  /// Fills what says how far the pictures are from the reference. Of the measures without
  /// a promise the first picture alone.
  /// `bias` is the nRMSE of another limit than the scene's.
  void judge(std::span<const Picture> pictures, CostSetting& setting, double bias = 0) const;

 private:
  const CostLevels& levels_;
  const DisplayTransform& display_;
  double mean_;
  std::vector<float> shown_;  ///< The reference as a display has it.
};

}  // namespace whit
