// Takes both pictures of a pair to one scale.
#pragma once

#include <string>

#include "core/compare/pair.h"

namespace whit {

/// Takes the colours of both to linear light where they are not on one scale already, cuts light where the other picture's
/// numbers end, and notes all that. "" or why that cannot be.
std::string make_alike(const PairRequest& request, PicturePair& pair);

}  // namespace whit
