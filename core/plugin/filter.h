// Pixel filters: separable or not, of finite support.
#pragma once

#include "core/plugin/param.h"

namespace whit {

class Filter : public Plugin {
 public:
  static constexpr const char* kCategory = "filter";
  float x_width = 2, y_width = 2;  ///< Radii in pixels.

  /// The filter's weight at an offset (pixels) from the pixel's centre, for |x| <= x_width, |y| <= y_width.
  virtual float evaluate(float x, float y) const = 0;
};

/// The radii, with the default of the filter in question.
inline auto xwidth_param(float default_radius) {
  return param(&Filter::x_width, "xwidth", default_radius, Unit::Pixels, "Radius of the filter in x.", kPositive);
}
inline auto ywidth_param(float default_radius) {
  return param(&Filter::y_width, "ywidth", default_radius, Unit::Pixels, "Radius of the filter in y.", kPositive);
}

}  // namespace whit
