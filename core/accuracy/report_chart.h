// The charts of the page, as SVG. Colours are the page's: classes, and variables of its style.
#pragma once

#include <string>

#include "core/accuracy/cost.h"

namespace whit {

/// Error against CPU seconds, both logarithmic: a curve for each knob with its intervals, what is beaten in grey, what
/// four times the samples would give, the noise of the reference. "" with less than two settings that can be drawn.
std::string error_chart(const CostReport& report, int width, int height);

/// What the colours and marks of error_chart() mean.
std::string error_legend(const CostReport& report);

/// The interval of an effect's seconds on one scale for all.
std::string effect_bar(const CostReport& report, const CostEffect& effect);

}  // namespace whit
