// FLIP: how different two pictures look when one flips between them.
//
// Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom, Fairchild: "FLIP: A Difference Evaluator for Alternating
// Images", Proceedings of the ACM on Computer Graphics and Interactive Techniques 3(2), 2020; and of light, Andersson,
// Nilsson, Shirley, Akenine-Moller: "Visualizing Errors in Rendered High Dynamic Range Images", Eurographics Short
// Papers, 2021.
//
// Both run on all cores, and their bits do not depend on how many there are. Of memory they take the map, light
// another number for each pixel, and a few megabytes for each core.
#pragma once

#include <span>
#include <vector>

namespace whit {

/// A screen 0.7 m wide with 3840 pixels seen from 0.7 m: the paper's, 3840 pi / 180.
inline constexpr double kFlipPixelsPerDegree = 67.02064327658226;

struct Flip {
  std::vector<float> map;  ///< A number in [0, 1] for each pixel.
  double mean = 0;
};

/// Of display (sRGB-encoded) pictures, three floats a pixel; values outside [0, 1] are clamped, NaN makes NaN.
Flip flip(std::span<const float> ref, std::span<const float> test, int width, int height,
          double pixels_per_degree = kFlipPixelsPerDegree);

/// The exposures at which two pictures of light are looked at, in stops (powers of two): `count` from start to stop.
struct FlipExposures {
  double start = 0, stop = 0;
  int count = 0;
};

/// From the one at which the brightest pixel, to the one at which the median pixel of the picture comes to 0.85 on the
/// display. None of a picture that is black everywhere.
FlipExposures flip_exposures(std::span<const float> rgb);

/// HDR-FLIP. Of light in linear Rec.709, three floats a pixel: the largest FLIP at any of the exposures of `ref`, by
/// Narkowicz's fit to the tone curve of ACES. If `ref` is black, the exposures are those of `test`. Negative values count
/// as 0, infinity as white, NaN makes NaN.
Flip hdr_flip(std::span<const float> ref, std::span<const float> test, int width, int height,
              double pixels_per_degree = kFlipPixelsPerDegree);

}  // namespace whit
