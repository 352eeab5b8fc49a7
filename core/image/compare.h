// How far two renders are apart: the measures of the conformance script, and a few more for `whit diff`.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/image/image.h"

namespace whit {

/// What a comparison accepts.
struct CompareLimits {
  double relmse = 0.02;
  double ratio = 0.01;  ///< Of |ratio - 1|.
  double block = 0.08;
};

/// The measures; of the three colour channels in linear values, `out` against `ref`.
struct Comparison {
  std::string failure;     ///< Another size or window, NaN or infinity: then nothing else is measured.
  int64_t bad_pixels = 0;  ///< Pixels of `out` with NaN or infinity.
  double relmse = 0;       ///< Mean of (out - ref)^2 / (ref^2 + (0.1 mean(ref))^2).
  double ratio = 1;        ///< mean(out) / mean(ref) of the colour channel furthest from 1.
  double block = 0;        ///< Largest |out - ref| / (ref + 0.1 mean(ref)) after averaging blocks of 8 x 8 pixels.
  bool shifted = false;    ///< A displacement by one pixel explains `out` clearly better than none does.
  int shift_x = 0, shift_y = 0;
  double max_difference = 0;     ///< Largest |out - ref|.
  int64_t differing_pixels = 0;  ///< Pixels with a channel that is not equal.
  double psnr = 0;               ///< 10 log10(max(ref)^2 / mean square error) in dB; infinite when equal.
};

/// Compares the colours of two pictures (see ImageInfo::rgb_channels). `ref` is the truth.
Comparison compare_images(const Image& out, const Image& ref);

/// What is beyond its limit: of "relMSE", "ratio", "block", "shift", or the failure's text. Empty: accepted.
std::vector<std::string> judge(const Comparison& comparison, const CompareLimits& limits = {});

}  // namespace whit
