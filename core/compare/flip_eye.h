// What FLIP's eye makes of a picture: colours as they are seen from afar, edges and points, row by row.
#pragma once

#include <vector>

#include "core/compare/convolve.h"
#include "core/compare/flip_colour.h"

namespace whit {

/// All filters of the eye at a distance at which a degree is so many pixels wide.
struct EyeKernels {
  explicit EyeKernels(double pixels_per_degree);
  /// A separable filter: along rows, then along columns.
  struct Gaussian {
    HalfKernel<float> row, column;
  };
  Gaussian y, cx, cz_narrow, cz_wide;
  HalfKernel<float> flat, first, second;  ///< A Gaussian and its derivatives.
  int radius = 0;                         ///< The largest.
};

/// What is seen in a row of pixels.
struct SeenRow {
  explicit SeenRow(size_t width) : colours(width), edges(width), points(width) {}
  ColourRow colours;                 ///< As of to_hunt_lab().
  std::vector<float> edges, points;  ///< How strong they are.
};

/// Looks at a strip of a picture from top to bottom.
class Eye {
 public:
  /// `width` of what is seen; the rows shown are wider by the kernels' radius on either side.
  Eye(const EyeKernels& kernels, int width);

  /// Shows the next row, of linear light, which is taken for scratch.
  void show(ColourRow& light);

  /// What is seen in the row that came so many rows before the last one shown as the kernels' radius is.
  void see(SeenRow& out);

 private:
  enum Plane { kY, kCx, kCzNarrow, kCzWide, kFlat, kFirst, kSecond, kPlanes };
  float* row(Plane plane, int y);
  void filter_row(const std::vector<float>& in, const HalfKernel<float>& kernel, Plane plane);
  void filter_column(const HalfKernel<float>& kernel, Plane plane, std::vector<float>& out);

  const EyeKernels& kernels_;
  int width_, depth_, last_ = -1;
  std::vector<float> rings_;  // The last rows filtered along themselves, for each plane.
  std::vector<float> other_;
  std::vector<const float*> from_;  // The places of a filter's numbers, from -radius to radius.
};

}  // namespace whit
