// Scenes made small enough to be rendered a hundred times a second.
#pragma once

#include "parser/scene_description.h"

namespace whit::fuzz {

/// Makes the picture 4 x 4 pixels, and counts of samples and depths at most 8: how long something takes that was asked for
/// in numbers is not what is looked for.
void limit(SceneDescription& world);

}  // namespace whit::fuzz
