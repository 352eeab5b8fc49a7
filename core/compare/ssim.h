// The structural similarity of two pictures.
//
// Wang, Bovik, Sheikh, Simoncelli: "Image Quality Assessment: From Error Visibility to Structural Similarity", IEEE
// Transactions on Image Processing 13(4), 2004.
#pragma once

#include <span>

namespace whit {

/// Mean over pixels and channels, 1 for equal pictures. Of display values in [0, 1], three floats a pixel; a Gaussian of 1.5
/// pixels, cut at 5, in which all pixels are counted with weights (not N - 1), over the pixels that have all of it inside,
/// as scikit-image's structural_similarity() does it with data_range=1, gaussian_weights=True and
/// use_sample_covariance=False. Where width or height is below 11 there may be no such pixel, and scikit-image gives up:
/// then the mean is over all pixels, and the picture goes on as its mirror image, its last pixel twice. NaN and infinity
/// make NaN. On all cores; the bits do not depend on how many there are.
double structural_similarity(std::span<const float> a, std::span<const float> b, int width, int height);

}  // namespace whit
