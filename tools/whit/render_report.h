// What `whit render` says when a picture is done.
#pragma once

#include "core/session/picture_stats.h"

namespace whit {

/// That there were samples without a valid radiance.
void report_invalid(const RenderStatistics& statistics);

/// The lines at the end of a render, with more figures if wanted (--stats).
void summarise(const RenderOutcome& outcome, bool with_statistics);

}  // namespace whit
