// Pictures inside a page: PNG files as text.
#pragma once

#include <string>

#include "core/accuracy/cost.h"

namespace whit {

/// A "data:" address of the picture as an sRGB display shows it, reduced to at most so many pixels in width. "" without
/// pixels.
std::string picture_address(const CostImage& image, int most_width);

/// The value that all but one in 200 pixels are not above (means of the channels), or the largest where that is 0.
double heat_scale(const CostImage& image);

/// A picture of the means of the channels from black over red to white, which is `full` and all above. Where it is
/// reduced, the largest of the pixels remains.
std::string heat_address(const CostImage& image, double full, int most_width);

}  // namespace whit
