#include "core/accuracy/cost_judge.h"

#include <algorithm>

#include "core/accuracy/estimate.h"
#include "core/accuracy/measures.h"
#include "core/compare/flip.h"

namespace whit {
namespace {

std::vector<float> shown(const Picture& picture, const DisplayTransform& display) {
  std::vector<float> out = picture.rgb;
  display.apply(out.data(), out.size() / 3);
  return out;
}

}  // namespace

Estimate median_and_ends(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const size_t n = values.size();
  return {n % 2 == 1 ? values[n / 2] : 0.5 * (values[n / 2 - 1] + values[n / 2]), values.front(), values.back()};
}

void set_seconds(const Elapsed& fixed, std::span<const Elapsed> spent, CostSetting& setting) {
  std::vector<double> wall, cpu;
  for (const Elapsed& one : spent) wall.push_back(fixed.wall + one.wall), cpu.push_back(fixed.cpu + one.cpu);
  setting.seconds = median_and_ends(std::move(wall)), setting.cpu_seconds = median_and_ends(std::move(cpu));
}

CostJudge::CostJudge(const CostLevels& levels, const DisplayTransform& display)
    : levels_(levels),
      display_(display),
      mean_(mean_radiance(levels.reference.rgb)),
      shown_(shown(levels.reference, display)) {}

void CostJudge::judge(std::span<const Picture> pictures, CostSetting& setting, double bias) const {
  const std::vector<float>& reference = levels_.reference.rgb;
  std::vector<double> squares;
  for (const Picture& picture : pictures) squares.push_back(mean_square_error(picture.rgb, reference));
  const ErrorEstimate error = estimate_error(squares, levels_.noise, mean_, bias);
  setting.nrmse = error.nrmse, setting.upper95 = error.upper95;
  setting.nrmse.low = std::max(0.0, setting.nrmse.low);
  const std::vector<float>& first = pictures.front().rgb;
  const std::vector<float> display = shown(pictures.front(), display_);
  setting.relmse = relative_mse(first, reference);
  setting.quantile95 = error_quantile95(first, reference);
  setting.share_2_255 = share_over_2_255(display, shown_);
  constexpr double kPixelsPerDegree = 67;  // As docs/accuracy.md says.
  setting.flip = flip(shown_, display, levels_.reference.width(), levels_.reference.height(), kPixelsPerDegree).mean;
}

}  // namespace whit
