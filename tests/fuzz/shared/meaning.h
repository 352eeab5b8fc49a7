// What a parsed scene says, without where it says so: two texts mean the same when this is equal.
#pragma once

#include <string>

#include "parser/scene_description.h"

namespace whit::fuzz {

/// All statements, parameters, transforms and names of a scene, in words. Numbers to the last bit.
std::string meaning_of(const SceneDescription& scene);

}  // namespace whit::fuzz
