// Weights fall linearly from the centre to the radii. Source: Pharr, Jakob, Humphreys, Physically Based Rendering,
// 3rd ed., 7.8.1.

#include <algorithm>
#include <cmath>

#include "core/plugin/filter.h"
#include "core/plugin/registry.h"

namespace whit {
namespace {

class TriangleFilter final : public Filter {
 public:
  float evaluate(float x, float y) const override {
    return std::max(0.0f, x_width - std::abs(x)) * std::max(0.0f, y_width - std::abs(y));
  }
};

const Register<TriangleFilter> triangle{"triangle", "Weights that fall linearly to 0 at the radii.", xwidth_param(2),
                                        ywidth_param(2)};

}  // namespace
}  // namespace whit
