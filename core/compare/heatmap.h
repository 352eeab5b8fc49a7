// Where two pictures differ, as a picture.
#pragma once

#include <string>

#include "core/compare/heat.h"
#include "core/compare/pair.h"

namespace whit {

/// Writes a picture (a PNG, by the ending of its name) of the beauty's difference, the channels' mean; of a pair without
/// a beauty that of all its channels. Colours are perceptually uniform: "magma" for |a - b|, "berlin" for a - b, with a bar
/// beneath that says what they are. The scale ends at the value that all but one in a thousand pixels are within, or at
/// `full` where that is not 0. Pixels with a number that is not finite are marked in green. Small pictures are enlarged by a
/// whole number. "" or the reason why not.
std::string write_heatmap(const std::string& path, const PicturePair& pair, HeatSign sign, double full = 0);

}  // namespace whit
