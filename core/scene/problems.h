// What was said while a scene was bound, in the light of its plan: what nothing uses cannot be wrong with the picture.
#pragma once

#include "core/base/diagnostics.h"
#include "core/scene/effect_plan.h"

namespace whit {

/// The problems of a bound scene, in order; errors of statements and parameters that the picture does not need, as
/// warnings that whit check calls errors (Diagnostic::excused).
Diagnostics weigh_problems(const BoundScene& scene, const EffectPlan& plan);

/// What is not wrong, but makes another picture than the scene's author may expect: media are not simulated, or there is
/// no light.
Diagnostics find_surprises(const SceneDescription& description, const EffectPlan& plan);

}  // namespace whit
