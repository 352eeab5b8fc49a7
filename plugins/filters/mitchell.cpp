// The piecewise cubic of Mitchell and Netravali, which trades blur (B) against ringing (C); slightly negative lobes.
// Source: Mitchell and Netravali, Reconstruction Filters in Computer Graphics, SIGGRAPH 1988. Stretched to the radii.

#include <cmath>

#include "core/plugin/filter.h"
#include "core/plugin/registry.h"

namespace whit {
namespace {

class MitchellFilter final : public Filter {
 public:
  float B = 1.0f / 3, C = 1.0f / 3;

  float evaluate(float x, float y) const override { return cubic(2 * x / x_width) * cubic(2 * y / y_width); }

 private:
  /// The filter of radius 2.
  float cubic(float signed_x) const {
    const float x = std::abs(signed_x);
    if (x > 2) return 0;
    if (x > 1) {
      return ((-B - 6 * C) * x * x * x + (6 * B + 30 * C) * x * x + (-12 * B - 48 * C) * x + (8 * B + 24 * C)) / 6;
    }
    return ((12 - 9 * B - 6 * C) * x * x * x + (-18 + 12 * B + 6 * C) * x * x + (6 - 2 * B)) / 6;
  }
};

const Register<MitchellFilter> mitchell{
    "mitchell",
    "Mitchell and Netravali's cubic: sharp, with faint negative lobes.",
    xwidth_param(2),
    ywidth_param(2),
    param(&MitchellFilter::B, "B", 1.0f / 3, Unit::None, "Amount of blur."),
    param(&MitchellFilter::C, "C", 1.0f / 3, Unit::None, "Amount of ringing; B + 2C = 1 is recommended.")};

}  // namespace
}  // namespace whit
