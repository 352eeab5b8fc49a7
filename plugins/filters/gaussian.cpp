// A Gaussian bump, lowered so that it reaches 0 at the radii. Never negative, so it rings nowhere, at the price of a
// little blur. Source: Pharr, Jakob, Humphreys, Physically Based Rendering, 3rd ed., 7.8.1.

#include <algorithm>

#include "core/base/fastmath.h"
#include "core/plugin/filter.h"
#include "core/plugin/registry.h"

namespace whit {
namespace {

class GaussianFilter final : public Filter {
 public:
  float alpha = 2;  ///< Falloff, per square pixel.

  bool prepare(const PrepareContext&) override {
    edge_x_ = exp_of(-alpha * x_width * x_width), edge_y_ = exp_of(-alpha * y_width * y_width);
    return true;
  }
  float evaluate(float x, float y) const override { return bump(x, edge_x_) * bump(y, edge_y_); }

 private:
  float bump(float x, float edge) const { return std::max(0.0f, exp_of(-alpha * x * x) - edge); }

  float edge_x_ = 0, edge_y_ = 0;  ///< The Gaussians at the radii.
};

const Register<GaussianFilter> gaussian{
    "gaussian", "A Gaussian, lowered to reach 0 at the radii.", xwidth_param(2), ywidth_param(2),
    param(&GaussianFilter::alpha, "alpha", 2.0f, Unit::None, "Falloff of exp(-alpha x^2), x in pixels.", kPositive)};

}  // namespace
}  // namespace whit
