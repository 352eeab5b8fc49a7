// Pieces of pictures for a report.
#pragma once

#include <span>

#include "core/accuracy/cost.h"

namespace whit {

/// The rectangle of a picture, at most `side` pixels in each direction, that holds the most of `weights` (one for each
/// pixel), by blocks of half its size.
Box2i heaviest_place(const Picture& picture, const std::vector<double>& weights, int side);
CostImage crop_of(const Picture& picture, const Box2i& place);

/// The whole picture; averaged over squares so that no side is longer than `most` pixels, when that is not 0.
CostImage image_of(int width, int height, std::span<const float> rgb, int most = 0);

}  // namespace whit
