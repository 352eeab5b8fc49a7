// Renders a scene's text in this process, for tests that look at pixels.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "core/render/render.h"
#include "tests/scene/scene_text.h"

namespace whit::test {

/// The picture of a scene's text, with every sample a number: the gate of all hard cases.
struct Rendered {
  RenderResult result;
  Diagnostics warnings;  ///< Where they are allowed.

  explicit Rendered(const std::string& text, const BuildOptions& build = {}, const RenderOptions& options = {},
                    Planned::Warnings mode = Planned::Warnings::Failures, const PlanOptions& plan = {}) {
    const BuiltScene built(text, build, mode, plan);
    result = render(*built.scene, options);
    warnings = built.warnings;
    EXPECT_EQ(result.statistics.invalid_samples, 0)
        << "first at " << result.statistics.first_invalid_pixel.x << ' ' << result.statistics.first_invalid_pixel.y;
  }
  const std::vector<float>& rgb() const { return result.picture.rgb; }
  RGB pixel(int x, int y) const {
    const float* p = &rgb()[3 * static_cast<size_t>(y * result.picture.width() + x)];
    return {p[0], p[1], p[2]};
  }
  double mean() const {
    double sum = 0;
    for (const float v : rgb()) sum += static_cast<double>(v);
    return sum / static_cast<double>(rgb().size());
  }
};

/// Mean of (a - b)^2 / (b^2 + 0.01) over all values, as tests/conformance/compare.py has it.
inline double relative_mse(const std::vector<float>& a, const std::vector<float>& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    const double d = static_cast<double>(a[i]) - static_cast<double>(b[i]), r = static_cast<double>(b[i]);
    sum += d * d / (r * r + 0.01);
  }
  return a.size() == b.size() ? sum / static_cast<double>(a.size()) : INFINITY;
}

}  // namespace whit::test
