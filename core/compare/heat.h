// Differences as colours.
#pragma once

#include <span>
#include <vector>

#include "core/compare/colour_maps.h"
#include "core/compare/pair.h"

namespace whit {

enum class HeatSign : uint8_t { Absolute, Signed };

/// A number for each pixel, the mean over channels: of |a - b|, or of a - b. NaN where that is not finite; equal
/// infinities of what is no colour differ by nothing.
std::vector<float> difference_of(const PicturePair& pair, const std::vector<size_t>& channels, HeatSign sign);

/// The channels whose difference is shown: the beauty's, else all that are numbers rather than names.
std::vector<size_t> shown_channels(const PicturePair& pair);

/// The magnitude that all but one in a thousand of the finite numbers are within; the largest where that is 0; 1 where
/// nothing differs.
double heat_scale(std::span<const float> difference);

/// The map's colours: "magma" for absolute differences, "berlin" for signed ones.
const ColourMap& heat_map(HeatSign sign);

/// The colour of a difference where `full` is the end of the map; what lies beyond has the colour of the end, and NaN one
/// that neither map has.
ByteColour heat_colour(double difference, HeatSign sign, double full);
inline constexpr ByteColour kNanColour{0, 255, 64};

}  // namespace whit
