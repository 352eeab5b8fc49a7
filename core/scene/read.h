// Reading what the plan keeps, and dropping what cannot be read with all that is made of it.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/diagnostics.h"
#include "core/scene/effect_plan.h"

namespace whit {

/// Reads the files that decide whether the live textures and materials can be used. Those that cannot are dropped
/// (reported), as if their statements were wrong; the default material, which takes their place, may call for other
/// effects, so the scene is planned anew.
void read_live(BoundScene& scene, EffectPlan& plan, Diagnostics& diagnostics);

/// Drops what is made of textures that failed (by index: not 0) or of materials that are gone: other textures, shapes
/// that they cut out, materials, mixes of these.
void drop_users(BoundScene& scene, std::vector<uint8_t> failed);

}  // namespace whit
