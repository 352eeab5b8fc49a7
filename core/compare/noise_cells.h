// What two files say of their noise, and the sums over cells that tests are made of.
#pragma once

#include "core/compare/noise_blocks.h"
#include "core/compare/pair.h"

namespace whit {

/// What is known of the noise of two pictures.
struct NoiseModel {
  bool known = false;  ///< By variances in both files; else by what the difference says of itself.
  double freedom = 3;  ///< Degrees of freedom of the variance of a pixel. whit takes four blocks of its samples.
  double area = 1;     ///< Pixels over which a pixel's noise reaches: a mean of n has n / area independent ones.
  double samples_a = 0, samples_b = 0;  ///< Per pixel, 0 where it is not said.

  /// The lesser number of samples; a few where nothing is said.
  double fewest_samples() const;
};
NoiseModel noise_model(const PicturePair& pair);

/// One channel that is tested, and how.
struct TestedChannel {
  const ComparedChannel* channel;
  const ComparedChannel* variance = nullptr;  ///< Null where the spread of the difference tells.
  /// Of a channel with variances, the pixels whose variance is not known: their difference tells.
  const ComparedChannel* unknown = nullptr;
  double allowance = 0;  ///< Share of the value that is no difference.
  double area = 1;       ///< As NoiseModel's.
};

/// All channels of colours and data, the beauty by its variances.
std::vector<TestedChannel> tested_channels(const PicturePair& pair, const NoiseModel& model);

/// The sums of its cells.
CellGrid make_grid(const PicturePair& pair, const TestedChannel& tested, const NoiseModel& model);

}  // namespace whit
