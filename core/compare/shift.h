// Whether a picture is another one displaced, mirrored or turned.
#pragma once

#include <span>

#include "core/base/vec.h"

namespace whit {

/// What makes `out` of `ref`, as far as it explains `out` clearly better than nothing done does.
struct Displacement {
  bool found = false;
  Vec2d by{0.0};  ///< Pixels, right and down, that what is in `ref` has gone.
  const char* words =
      "";  ///< "mirrored left to right", "flipped top to bottom", "turned by 180 degrees", "transposed"; "" for a shift.
};

/// Of the same channel of two pictures of width x height pixels. Shifts are found from 0.04 pixels on and up to 16 at
/// least, of large pictures 64; transposed are only square pictures.
///
/// Noise is not taken for a displacement: errors are compared at whole pixels only, where noise has the same part in each of
/// them (between pixels, interpolation would blur it away), and what a displacement gains must be gained in many places.
/// A brighter or darker copy is none either: both pictures are given one mean and one deviation first. Where a pattern
/// repeats itself and several displacements explain as much, none is claimed; where only one direction can be told, as of
/// stripes, the other is 0. Values beyond four times the 99th percentile of |ref| count as that, NaN as 0.
///
/// On all cores; the bits do not depend on how many there are.
Displacement find_displacement(std::span<const float> out, std::span<const float> ref, int width, int height);

}  // namespace whit
