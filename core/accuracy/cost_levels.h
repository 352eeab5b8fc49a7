// The levels of samples: replicates of the scene at 4, 16, 64 ... samples per pixel, and the reference they are measured
// against.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/accuracy/cost_world.h"
#include "core/accuracy/estimate.h"

namespace whit {

struct CostLevel {
  int samples = 0;
  std::vector<Picture> pictures;  ///< One for each replicate.
  std::vector<Elapsed> spent;     ///< What their samples took.
};

struct CostLevels {
  std::vector<CostLevel> levels;
  Picture reference;             ///< Mean of its halves.
  ReferenceNoise noise;          ///< Its own, by what its halves differ.
  int reference_samples = 0;     ///< Of both halves.
  double reference_seconds = 0;  ///< Wall clock.
  Elapsed per_sample;            ///< As the last pass found it.
  int replicates = 0;
  std::optional<int> cut;  ///< The level that was begun and not ended.
  double needs = 0;        ///< Where there is no level: seconds that one would take.
};

/// Goes from level to level as long as the next will be done when the clock has spent `until` seconds.
CostLevels study_levels(CostWorld& world, const CostRequest& request, CostClock& clock, double until);

}  // namespace whit
