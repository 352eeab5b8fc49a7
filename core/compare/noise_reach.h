// Over how many pixels noise reaches, from the difference of two pictures.
#pragma once

#include <span>

namespace whit {

/// The number of pixels that have one pixel's noise in common, 1 where each has its own: the variance of a mean of n pixels is
/// that many n-ths of a pixel's. By how alike neighbours of a - b are at distances of 1 to 3 pixels along rows and columns, in
/// blocks of 8 x 8 whose means, which may be true differences, are taken away.
double noise_reach(std::span<const float> a, std::span<const float> b, int width, int height);

}  // namespace whit
