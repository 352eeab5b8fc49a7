// How far a picture is from its limit, by what the film knows: the variance of its pixels.
//
// The error is nRMSE: the root mean square over pixels and the three linear channels, over the mean radiance. What is
// claimed holds with a confidence that is stated, for the pixels that can be trusted.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/vec.h"
#include "core/render/film_buffer.h"

namespace whit {

/// Pixels of which a few samples cannot tell the error, left out of the claim: those beside something much brighter, of
/// which they may get light that no sample has met; those much quieter than their surroundings, whose samples have
/// perhaps missed what makes these noisy, where a pixel has the 16 samples that tell; and all of a tile of 16 x 16 where a
/// fourth is one of the two.
struct Doubts {
  std::vector<uint8_t> pixels;  ///< 1 for each pixel of the window that is doubted, row by row.
  int64_t count = 0;
  Box2i where;                 ///< Around all of them, in pixels of the picture; empty without any.
  std::vector<Vec2i> densest;  ///< A doubted pixel of each of the three tiles that have the most of them.
};
/// `variance`: three a pixel. `samples`: of each pixel. `reach`: pixels that the filter reaches beyond its own.
Doubts find_doubts(const Picture& picture, std::span<const float> variance, std::span<const uint32_t> samples,
                   int reach);

/// An error that is claimed.
struct ErrorClaim {
  double value = 0;          ///< nRMSE, as estimated.
  double low = 0, high = 0;  ///< Which it lies above and below, each with the confidence asked for.
  double freedom = 0;        ///< Degrees of freedom of the estimate.
};

/// From variances by blocks of samples (block_variance()). Tiles of 8 x 8 pixels are taken for independent of each other,
/// and all that is in one for one number with blocks - 1 degrees of freedom; of 16 x 16 where some pixel is doubted. The
/// sum v of their contributions has (blocks - 1) (sum v)^2 / sum v^2 degrees of freedom (Satterthwaite, 1946), and v times
/// that over its chi-square quantile is the bound. `confidence` in (0,1), one-sided. Infinite where nothing can be said:
/// no mean radiance, no pixel that is trusted, not two blocks.
ErrorClaim claim_error(const Picture& picture, std::span<const float> variance, const Doubts& doubts,
                       double confidence);

}  // namespace whit
