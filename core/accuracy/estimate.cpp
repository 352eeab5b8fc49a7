#include "core/accuracy/estimate.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/compare/quantiles.h"

namespace whit {
namespace {

constexpr double kTwoSided = 0.975, kOneSided = 0.95;

// Mean squared errors of few replicates are skewed where few pixels carry them, and a sample that happens to hold none
// of the rare large ones has a small mean and a small deviation. The upper end is moved up in proportion to the relative
// deviation of one replicate, which is small where many pixels share in the error. Simulated: docs/accuracy.md.
constexpr double kSkew = 4;

// How much further than the bracket of slopes the ends of an extrapolation lie, as exponents of the ratio of samples: 6 %
// and 28 % at four times. Scenes have been seen to speed up from one level to the next more than to slow down.
constexpr double kSlowMargin = 0.04, kFastMargin = 0.18;
constexpr int kExtrapolationLimit = 4;

// Of two runs of a program, beyond what runs in one process tell.
constexpr double kRunSpread = 0.02;

double mean_of(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double deviation_of(std::span<const double> values) {
  const double mean = mean_of(values);
  double sum = 0;
  for (double v : values) sum += (v - mean) * (v - mean);
  return std::sqrt(sum / static_cast<double>(values.size() - 1));
}

struct Interval {
  double value = 0, low = 0, high = 0;
};

// The expectation of positive values, by t on its logarithm.
Interval positive_mean(std::span<const double> values, double p) {
  const double mean = mean_of(values);
  if (mean == 0) return {};
  const auto n = static_cast<double>(values.size());
  const double relative = deviation_of(values) / mean;
  const double reach = student_t_quantile(n - 1, p) * relative / std::sqrt(n);
  return {mean, mean * std::exp(-reach), mean * std::exp(reach * (1 + kSkew * relative))};
}

// The reference's error is one draw, and its estimate by halves another, independent one of the same distribution: their
// difference has twice the variance of either, and half the degrees of freedom have that.
Interval shared_noise(const ReferenceNoise& reference, double p) {
  if (reference.mse == 0) return {};
  const double freedom = reference.freedom / 2;
  return {reference.mse, reference.mse * freedom / chi_square_quantile(freedom, p),
          reference.mse * freedom / chi_square_quantile(freedom, 1 - p)};
}

// The interval of a difference from those of its terms (Zou and Donner 2008): each end goes as far as the ends of the
// terms that lead there, in the mean square. `common` is more variance, in multiples of which the ends are `quantile`.
Interval minus(const Interval& a, const Interval& b, double common, double quantile) {
  const double more = quantile * quantile * common;
  const double value = a.value - b.value;
  const double below =
      std::sqrt((a.value - a.low) * (a.value - a.low) + (b.high - b.value) * (b.high - b.value) + more);
  const double above =
      std::sqrt((a.high - a.value) * (a.high - a.value) + (b.value - b.low) * (b.value - b.low) + more);
  return {value, value - below, value + above};
}

double root(double mse, double mean_radiance) { return mse > 0 ? std::sqrt(mse) / mean_radiance : 0 * mse; }

// Twice the mean product of what replicates have in common and the reference's error is the same for all of them. Its
// variance, of pixels that are alike:
double common_variance(double bias_square, const ReferenceNoise& reference) {
  return 4 * bias_square * reference.mse / reference.freedom;
}

Interval mse_interval(std::span<const double> replicate_mse, const ReferenceNoise& reference, double bias_square,
                      double p) {
  const Interval seen = positive_mean(replicate_mse, p);
  const double common = common_variance(bias_square, reference);
  return minus(seen, shared_noise(reference, p), common, normal_quantile(p));
}

}  // namespace

ErrorEstimate estimate_error(std::span<const double> replicate_mse, const ReferenceNoise& reference,
                             double mean_radiance, double bias) {
  assert(replicate_mse.size() >= 2);
  const double bias_square = bias * mean_radiance * bias * mean_radiance;
  const Interval two_sided = mse_interval(replicate_mse, reference, bias_square, kTwoSided);
  const Interval one_sided = mse_interval(replicate_mse, reference, bias_square, kOneSided);
  return {
      {root(two_sided.value, mean_radiance), root(two_sided.low, mean_radiance), root(two_sided.high, mean_radiance)},
      root(one_sided.high, mean_radiance)};
}

namespace {

// The mean of the products of different replicates, without replicate `left_out` (-1: with all).
double mean_of_different(const ErrorProducts& errors, int left_out) {
  double sum = 0;
  int count = 0;
  for (int r = 0; r < errors.replicates; ++r)
    for (int s = 0; s < errors.replicates; ++s) {
      if (r == s || r == left_out || s == left_out) continue;
      sum += errors.products[static_cast<size_t>(r) * static_cast<size_t>(errors.replicates) + static_cast<size_t>(s)];
      ++count;
    }
  return sum / count;
}

}  // namespace

Estimate estimate_bias(const ErrorProducts& errors, const ReferenceNoise& reference, double mean_radiance) {
  assert(errors.replicates >= 3);
  const double value = mean_of_different(errors, -1);
  // The jackknife, which is on the large side for products.
  const int n = errors.replicates;
  double sum = 0;
  for (int r = 0; r < n; ++r) {
    const double without = mean_of_different(errors, r);
    sum += (without - value) * (without - value);
  }
  const double deviation = std::sqrt(sum * (n - 1) / n);
  const double reach = student_t_quantile(n - 1, kTwoSided) * deviation;
  const double common = common_variance(std::max(0.0, value), reference);
  const Interval square = minus({value, value - reach, value + reach}, shared_noise(reference, kTwoSided), common,
                                normal_quantile(kTwoSided));
  return {root(square.value, mean_radiance), root(square.low, mean_radiance), root(square.high, mean_radiance)};
}

namespace {

// Fitting a straight line to logarithms needs them.
bool has_logarithm(const ErrorLevel& level) {
  return level.samples > 0 && level.nrmse.value > 0 && std::isfinite(level.nrmse.high);
}

// Standard deviation of the logarithm of a level's nRMSE. Where the reference's noise hides its low end, the high end is
// what there is.
double log_deviation(const ErrorLevel& level) {
  const Estimate& e = level.nrmse;
  const double width = e.low > 0 ? std::log(e.high / e.low) / 2 : std::log(e.high / e.value);
  return std::max(width / normal_quantile(kTwoSided), 1e-4);  // Without any spread weights would be infinite.
}

struct Line {
  double slope = 0, slope_variance = 0, at_zero = 0;
};

Line fit_line(const std::vector<ErrorLevel>& levels) {
  double w = 0, wx = 0, wy = 0;
  const auto weight = [](const ErrorLevel& level) { return 1 / (log_deviation(level) * log_deviation(level)); };
  for (const ErrorLevel& level : levels) {
    w += weight(level);
    wx += weight(level) * std::log(level.samples);
    wy += weight(level) * std::log(level.nrmse.value);
  }
  const double x = wx / w, y = wy / w;
  double xx = 0, xy = 0;
  for (const ErrorLevel& level : levels) {
    const double dx = std::log(level.samples) - x;
    xx += weight(level) * dx * dx;
    xy += weight(level) * dx * (std::log(level.nrmse.value) - y);
  }
  return {xy / xx, 1 / xx, y - xy / xx * x};
}

}  // namespace

Convergence fit_order(std::span<const ErrorLevel> levels) {
  Convergence result{{levels.begin(), levels.end()}};
  std::vector<ErrorLevel> fitted;
  std::copy_if(levels.begin(), levels.end(), std::back_inserter(fitted), has_logarithm);
  if (fitted.empty()) return result;
  if (fitted.size() == 1) {
    result.log_factor = std::log(fitted[0].nrmse.value) + result.order.value * std::log(fitted[0].samples);
    return result;
  }
  const Line line = fit_line(fitted);
  result.log_factor = line.at_zero;
  // Levels that hold one another's samples are correlated, which takes away from the variance of a slope.
  const double reach = normal_quantile(kTwoSided) * std::sqrt(line.slope_variance);
  result.order = {-line.slope, -line.slope - reach, -line.slope + reach};
  // No scene follows a power exactly: the slopes between neighbours show how far it does not.
  for (size_t i = 1; i < fitted.size(); ++i) {
    const ErrorLevel& a = fitted[i - 1];
    const ErrorLevel& b = fitted[i];
    if (b.nrmse.low == 0) continue;  // Nothing is seen of that slope but noise.
    const double slope = std::log(a.nrmse.value / b.nrmse.value) / std::log(double(b.samples) / a.samples);
    result.order.low = std::min(result.order.low, slope);
    result.order.high = std::max(result.order.high, slope);
  }
  return result;
}

namespace {

// On the straight line between two levels in logarithms, ends like values.
ErrorEstimate between(const ErrorLevel& a, const ErrorLevel& b, int samples) {
  const double share = std::log(double(samples) / a.samples) / std::log(double(b.samples) / a.samples);
  const auto at = [&](double left, double right) { return std::pow(left, 1 - share) * std::pow(right, share); };
  return {{at(a.nrmse.value, b.nrmse.value), at(a.nrmse.low, b.nrmse.low), at(a.nrmse.high, b.nrmse.high)},
          at(a.upper95, b.upper95)};
}

ErrorEstimate beyond(const Convergence& convergence, int samples) {
  const ErrorLevel& last = convergence.levels.back();
  const double ratio = double(samples) / last.samples;
  const Estimate& order = convergence.order;
  const double slow = std::min(order.low, 0.5) - kSlowMargin;
  const double fast = std::max(order.high, 0.5) + kFastMargin;
  const double middle = std::sqrt(std::pow(ratio, -order.value) * std::pow(ratio, -0.5));
  return {
      {last.nrmse.value * middle, last.nrmse.low * std::pow(ratio, -fast), last.nrmse.high * std::pow(ratio, -slow)},
      last.upper95 * std::pow(ratio, -slow)};
}

}  // namespace

bool is_extrapolated(const Convergence& convergence, int samples) {
  return !convergence.levels.empty() && samples > convergence.levels.back().samples;
}

std::optional<ErrorEstimate> predict_error(const Convergence& convergence, int samples) {
  const std::vector<ErrorLevel>& levels = convergence.levels;
  if (levels.empty() || samples < levels.front().samples) return std::nullopt;
  if (samples > int64_t{levels.back().samples} * kExtrapolationLimit) return std::nullopt;
  if (samples > levels.back().samples) return beyond(convergence, samples);
  const auto next =
      std::find_if(levels.begin(), levels.end(), [&](const ErrorLevel& l) { return l.samples >= samples; });
  if (next->samples == samples) return ErrorEstimate{next->nrmse, next->upper95};
  return between(next[-1], *next, samples);
}

std::optional<SamplesFor> samples_for(const Convergence& convergence, double target, bool powers_of_two) {
  const std::vector<ErrorLevel>& levels = convergence.levels;
  if (levels.empty()) return std::nullopt;
  const auto candidate = [&](int samples) -> std::optional<SamplesFor> {
    const std::optional<ErrorEstimate> error = predict_error(convergence, samples);
    if (!error || error->upper95 > target) return std::nullopt;
    const bool measured = std::any_of(levels.begin(), levels.end(), [&](auto& l) { return l.samples == samples; });
    return SamplesFor{samples, *error, measured, is_extrapolated(convergence, samples)};
  };
  for (size_t i = 0; i < levels.size(); ++i) {
    const int first = levels[i].samples;
    const int64_t end = i + 1 < levels.size() ? levels[i + 1].samples : int64_t{first} * kExtrapolationLimit + 1;
    for (int64_t n = first; n < end; n = powers_of_two ? 2 * n : n + 1)
      if (auto found = candidate(static_cast<int>(n))) return found;
  }
  return std::nullopt;
}

namespace {

// Weighted least squares; `weights` are of squares. A parameter that would be negative is 0, and the other is fitted
// alone.
AffineFit weighted_affine(std::span<const double> x, std::span<const double> y, std::span<const double> weights) {
  double w = 0, wx = 0, wy = 0, wxx = 0, wxy = 0;
  for (size_t i = 0; i < x.size(); ++i) {
    w += weights[i];
    wx += weights[i] * x[i];
    wy += weights[i] * y[i];
    wxx += weights[i] * x[i] * x[i];
    wxy += weights[i] * x[i] * y[i];
  }
  AffineFit fit;
  const double determinant = w * wxx - wx * wx;
  if (determinant > 1e-9 * w * wxx) {
    fit.fixed = (wxx * wy - wx * wxy) / determinant;
    fit.per_sample = (w * wxy - wx * wy) / determinant;
    fit.covariance = {wxx / determinant, -wx / determinant, w / determinant};
    fit.freedom = static_cast<double>(x.size()) - 2;
    if (fit.fixed >= 0 && fit.per_sample >= 0) return fit;
  }
  const bool constant = fit.per_sample < 0;
  fit.fixed = constant ? wy / w : 0;
  fit.per_sample = constant ? 0 : wxy / wxx;
  fit.covariance = constant ? std::array{1 / w, 0.0, 0.0} : std::array{0.0, 0.0, 1 / wxx};
  fit.freedom = static_cast<double>(x.size()) - 1;
  return fit;
}

}  // namespace

AffineFit fit_affine(std::span<const double> samples, std::span<const double> seconds) {
  assert(samples.size() == seconds.size() && !samples.empty());
  // Deviations relative to what was measured favour the small, relative to the line they do not: three rounds are
  // enough for it to stay where it is.
  std::vector<double> expected(seconds.begin(), seconds.end()), weights(seconds.size());
  AffineFit fit;
  for (int round = 0; round < 3; ++round) {
    for (size_t i = 0; i < weights.size(); ++i) weights[i] = 1 / std::max(1e-18, expected[i] * expected[i]);
    fit = weighted_affine(samples, seconds, weights);
    for (size_t i = 0; i < weights.size(); ++i) expected[i] = fit.fixed + fit.per_sample * samples[i];
  }
  double sum = 0;
  for (size_t i = 0; i < weights.size(); ++i) {
    const double relative = expected[i] > 0 ? seconds[i] / expected[i] - 1 : 0;
    sum += relative * relative;
  }
  fit.spread = fit.freedom > 0 ? std::sqrt(sum / fit.freedom) : 0;
  for (double& c : fit.covariance) c *= fit.spread * fit.spread;
  return fit;
}

Estimate AffineFit::predict(double samples) const {
  const double value = fixed + per_sample * samples;
  const double of_line = covariance[0] + 2 * covariance[1] * samples + covariance[2] * samples * samples;
  const double t = freedom > 0 ? student_t_quantile(freedom, kTwoSided) : student_t_quantile(1, kTwoSided);
  const double reach = std::hypot(t * std::sqrt(std::max(0.0, of_line) + value * value * spread * spread),
                                  normal_quantile(kTwoSided) * kRunSpread * value);
  return {value, std::max(0.0, value - reach), value + reach};
}

std::optional<PairedDifference> paired_difference(std::span<const double> differences) {
  if (differences.size() < 2) return std::nullopt;
  const auto n = static_cast<double>(differences.size());
  const double mean = mean_of(differences);
  const double reach = student_t_quantile(n - 1, kTwoSided) * deviation_of(differences) / std::sqrt(n);
  return PairedDifference{{mean, mean - reach, mean + reach}, mean - reach > 0 || mean + reach < 0};
}

void mark_pareto(std::vector<CostSetting>& settings) {
  const auto beats = [](const CostSetting& a, const CostSetting& b) {
    return a.cpu_seconds.value <= b.cpu_seconds.value && a.nrmse.value <= b.nrmse.value &&
           (a.cpu_seconds.value < b.cpu_seconds.value || a.nrmse.value < b.nrmse.value);
  };
  for (CostSetting& setting : settings)
    setting.pareto =
        std::none_of(settings.begin(), settings.end(), [&](const CostSetting& other) { return beats(other, setting); });
}

}  // namespace whit
