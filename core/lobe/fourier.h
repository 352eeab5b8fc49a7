// A tabulated BSDF: for pairs of zenith cosines, the coefficients of a cosine series in the azimuth between the
// directions. Jakob et al., A Comprehensive Framework for Rendering Layered Materials, 2014; PBR book, 3rd ed., 8.6
// and 14.1.4. The tables come from Jakob's layerlab.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace whit {

/// A table over n x n pairs of cosines, [o * n + i]. i is the direction light travels in (-wi), o that of wo.
struct FourierTable {
  float eta = 1;      ///< Index inside over that outside.
  int channels = 1;   ///< 1: luminance; 3: luminance, red, blue.
  int max_order = 0;  ///< The longest series.
  /// The n cosines, in [-1, 1]. None is below the one before; where two are equal the table may jump. layerlab's have -0
  /// and 0 in the middle, one for each side.
  std::vector<float> mu;
  std::vector<int32_t> first;    ///< Where the coefficients of a pair start; those of further channels follow.
  std::vector<int32_t> order;    ///< Their number in one channel.
  std::vector<float> a;          ///< f |cos| = sum over k of a[k] cos(k phi).
  std::vector<float> mean;       ///< a[0] of the first channel, 0 where there is no series.
  std::vector<float> integrals;  ///< Of `mean` from the first to the i-th cosine.

  int size() const { return static_cast<int>(mu.size()); }
  size_t at(int o, int i) const { return static_cast<size_t>(o) * mu.size() + static_cast<size_t>(i); }
};

/// Reads the content of a bsdf file ("SCATFUN", version 1). Returns what is wrong with it, "" when nothing is.
std::string parse_fourier_table(std::string_view bytes, FourierTable& table);

}  // namespace whit
