// The ideal low-pass filter sin(pi x)/(pi x), windowed by the central lobe of a sinc tau times as wide (Lanczos).
// Sharp, with negative lobes that ring at strong edges. Source: Pharr, Jakob, Humphreys, Physically Based Rendering,
// 3rd ed., 7.8.1; Duchon, Lanczos Filtering in One and Two Dimensions, 1979.

#include <cmath>

#include "core/base/fastmath.h"
#include "core/plugin/filter.h"
#include "core/plugin/registry.h"

namespace whit {
namespace {

class SincFilter final : public Filter {
 public:
  float tau = 3;

  float evaluate(float x, float y) const override { return windowed(x, x_width) * windowed(y, y_width); }

 private:
  static float sinc(float x) { return std::abs(x) < 1e-5f ? 1.0f : sin_of(kPi * x) / (kPi * x); }
  float windowed(float x, float radius) const { return std::abs(x) > radius ? 0.0f : sinc(x) * sinc(x / tau); }
};

const Register<SincFilter> sinc{
    "sinc", "Lanczos-windowed sinc: sharpest, rings at strong edges.", xwidth_param(4), ywidth_param(4),
    param(&SincFilter::tau, "tau", 3.0f, Unit::None, "Width of the window, in lobes of the sinc.", kPositive)};

}  // namespace
}  // namespace whit
