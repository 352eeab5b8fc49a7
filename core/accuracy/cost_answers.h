// What a report comes to, in sentences, each with the command that does what it says.
#pragma once

#include "core/accuracy/estimate.h"

namespace whit {

/// The lines through the levels of samples.
struct CostFits {
  Convergence convergence;
  AffineFit cpu, wall;
};

struct CostAnswers {
  std::vector<CostAnswer> answers;
  std::vector<std::string> not_known;
};

/// Of a report that has all its settings and effects. `nets`: the scene's sampler has better sets of 2^m samples than of
/// other numbers.
CostAnswers answer(const CostReport& report, const CostFits& fits, bool nets, const CostRequest& request);

}  // namespace whit
