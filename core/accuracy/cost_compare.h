// The knobs and effects of a scene, each beside the scene as it stands, as far as the time allows.
#pragma once

#include "core/accuracy/cost_judge.h"
#include "core/accuracy/cost_knobs.h"

namespace whit {

struct CostComparisons {
  std::vector<CostSetting> settings;
  std::vector<CostEffect> effects;
  std::vector<std::string> not_known;  ///< What there was no time for, or could not be rendered.
};

/// Compares the scene with each alternative at the greatest measured number of samples that leaves time for all.
CostComparisons compare_all(CostWorld& base, const std::vector<CostAlternative>& alternatives, const CostLevels& levels,
                            const CostJudge& judge, const Box2i& crop, ParsedFile& file, size_t world,
                            const CostRequest& request, CostClock& clock);

}  // namespace whit
