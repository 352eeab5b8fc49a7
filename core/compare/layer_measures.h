// The arithmetic of measures, over the planes of one layer. Sums are of doubles, in an order that does not depend on
// the number of threads.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/vec.h"

namespace whit {

/// True of equal numbers, and of two that are none.
inline bool equal_numbers(float a, float b) { return a == b || (a != a && b != b); }

/// True when no value is NaN or infinite.
bool all_finite(std::span<const float> values);

/// A channel of both pictures, finite numbers alone.
struct PlanePair {
  std::span<const float> a, b;
};
using LayerPlanes = std::vector<PlanePair>;

struct LayerErrors {
  double mean_magnitude = 0;   ///< Of |b|, over pixels and channels.
  double usual_magnitude = 0;  ///< The same, with what is above ten times the median of those that are not 0 cut there.
  std::vector<double> mean_a, mean_b;  ///< Of each channel.
  double mse = 0, mae = 0;
  double peak = 0;     ///< The largest of b.
  double largest = 0;  ///< Of |a - b|, and where that is first.
  size_t largest_pixel = 0, largest_channel = 0;
  double relmse = 0;          ///< Mean of (a - b)^2 / (b^2 + (0.1 mean|b|)^2).
  std::vector<float> robust;  ///< Of each pixel the same, with the usual magnitude in the place of the mean.
};
LayerErrors layer_errors(const LayerPlanes& planes);

/// The share of the pixels that "robust" leaves out, the worst ones.
inline constexpr double kTrimmed = 0.001;

/// What the worst part of some errors has of them.
struct Worst {
  size_t count = 0;         ///< So many are left out.
  double mean_without = 0;  ///< Of the others.
  double share = 0;         ///< Of the sum, that they hold.
};
Worst worst_share(const std::vector<float>& errors, double part);

/// Which channel's mean is furthest from the reference's. Channels next to black there have no say.
struct Ratio {
  bool any = false;  ///< Some channel has a say, or all are black in the reference.
  double value = 1;
  size_t channel = 0;
};
Ratio furthest_ratio(const LayerErrors& errors);

/// Where means of nothing are divided: a tenth of a magnitude; of black a millionth, which no display shows.
double floor_of(double magnitude);

/// The block of 8 x 8 pixels whose mean is furthest off, against the mean magnitude of the block's channels. Blocks at the far
/// edges end there and overlap their neighbours, so that all are whole; a picture smaller than that is a block.
struct BlockError {
  double value = 0;  ///< |a - b| / (mean over channels of |b| + floor)
  size_t channel = 0;
  Vec2i corner{0, 0};
};
struct BlockErrors {
  BlockError mean;         ///< Of the mean over channels,
  BlockError one_channel;  ///< and of the channel that is furthest off: colours do not make up for each other.
};
/// `valid`: 1 for pixels that count, or null.
BlockErrors largest_block_errors(const LayerPlanes& planes, const uint8_t* valid, int width, int height, double floor);

/// Pixels whose number the other picture has at none of the 3 x 3 pixels around, in one direction or the other: where two
/// things meet, chance decides which of them a pixel is.
struct Mismatch {
  double share = 0;  ///< Of the pixels.
  size_t first = 0;  ///< Pixel.
};
Mismatch mismatch_of(std::span<const float> a, std::span<const float> b, int width, int height);

/// For each pixel whether some channel is not equal. What is no number equals what is none.
std::vector<uint8_t> differing(const LayerPlanes& planes);

}  // namespace whit
