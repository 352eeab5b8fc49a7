// How far pictures are apart: linear RGB, three floats a pixel, row by row. Sums are of doubles in a fixed order. NaN and
// infinity are not left out: measures of pictures that hold them are not finite, except where it is said otherwise.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/accuracy/estimate.h"

namespace whit {

/// Mean over pixels and channels.
double mean_radiance(std::span<const float> rgb);

/// Mean of (a - b)^2 over pixels and channels.
double mean_square_error(std::span<const float> a, std::span<const float> b);

/// What relMSE and nRMSE's quantile are relative to: relMSE's epsilon is (kRelmseShare * mean radiance)^2.
inline constexpr double kRelmseShare = 0.1;

/// Mean of (x - ref)^2 / (ref^2 + e) with e = (0.1 mean radiance of ref)^2.
double relative_mse(std::span<const float> x, std::span<const float> ref);

/// The value that 95 % of |x - ref| / mean radiance of ref are not above, over pixels and channels. NaN if any is.
double error_quantile95(std::span<const float> x, std::span<const float> ref);

/// Share of the pixels that have a channel off by more than 2/255, of display pictures. NaN counts as off.
double share_over_2_255(std::span<const float> display, std::span<const float> display_ref);

/// The pixels that carry half of the squared error: the most first, as few as do.
struct WorstPixels {
  std::vector<size_t> pixels;  ///< Numbers in the order of the picture.
  std::vector<double> shares;  ///< Of the squared error, of each.
};
WorstPixels worst_pixels(std::span<const float> x, std::span<const float> ref);
/// The same of squared errors, one a pixel (of several replicates together, say).
WorstPixels worst_pixels(std::span<const double> squared_errors);

/// The squared error of (a + b) / 2, where a and b are independent pictures of the same: mean((a - b)^2) / 4, with the
/// degrees of freedom that the spread over blocks of 4 x 4 pixels leaves it.
ReferenceNoise halves_noise(std::span<const float> a, std::span<const float> b, int width);

/// Mean products of the errors of pictures against a reference.
ErrorProducts error_products(std::span<const std::span<const float>> pictures, std::span<const float> ref);
/// Of the differences of pairs of pictures.
ErrorProducts difference_products(std::span<const std::span<const float>> a, std::span<const std::span<const float>> b);

}  // namespace whit
