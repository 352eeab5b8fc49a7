// The plan of a world, and what rendering it is going to take of memory, as JSON.
#pragma once

#include "core/base/json.h"
#include "core/scene/memory_plan.h"
#include "core/session/session.h"

namespace whit {

/// {"effects", "left_out", "not_simulated"}: which effects are on and which statements called for them, what is not read
/// and why, and what is asked for that nobody simulates.
Json::Object plan_json(const PlannedWorld& world, const Sources& sources);

/// The memory of a render without flags.
MemoryPlan plan_memory_of(const PlannedWorld& world);

/// The same: {"estimate_bytes", "limit_bytes", "step", "uses", "steps"}.
Json::Object memory_json(const PlannedWorld& world, const Sources& sources);

}  // namespace whit
