// A report of costs in its four forms. All text that comes from the scene is escaped as the form needs it.
#pragma once

#include <string>

#include "core/accuracy/cost.h"

namespace whit {

/// For a terminal of so many columns: the table, a log-log plot of nRMSE against CPU seconds, answers, what is not known.
std::string cost_text(const CostReport& report, bool colour, int columns);

/// For machines.
std::string cost_json(const CostReport& report);

/// A row for each setting and effect.
std::string cost_csv(const CostReport& report);

/// One page that needs nothing else: charts, pictures, answers.
std::string cost_html(const CostReport& report);

}  // namespace whit
