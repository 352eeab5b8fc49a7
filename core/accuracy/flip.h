// LDR-FLIP: how different two pictures look when one flips between them.
//
// Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom, Fairchild: "FLIP: A Difference Evaluator for Alternating
// Images", Proceedings of the ACM on Computer Graphics and Interactive Techniques 3(2), 2020.
#pragma once

#include <span>
#include <vector>

namespace whit {

/// A screen 0.7 m wide with 3840 pixels seen from 0.7 m: the paper's.
inline constexpr double kFlipPixelsPerDegree = 67;

struct Flip {
  std::vector<float> map;  ///< A number in [0, 1] for each pixel.
  double mean = 0;
};

/// Of display (sRGB-encoded) pictures, three floats a pixel; values outside [0, 1] are clamped, NaN makes NaN.
Flip flip(std::span<const float> ref, std::span<const float> test, int width, int height,
          double pixels_per_degree = kFlipPixelsPerDegree);

}  // namespace whit
