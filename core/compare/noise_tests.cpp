#include "core/compare/noise_tests.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/compare/quantiles.h"

namespace whit {
namespace {

// p of a mean that is off by so much beyond rounding. Tails of Student's t are heavier than the normal distribution's, so that what
// is likely by that is not looked at closer.
double mean_p(const BlockSums& sums, double variance, double freedom, double below) {
  const double beyond = std::abs(sums.difference) - sums.tolerance;
  if (!(beyond > 0)) return 1;
  const double t = variance > 0 ? beyond / std::sqrt(variance) : std::numeric_limits<double>::infinity();
  return t > normal_quantile(1 - below / 2) ? student_t_tails(freedom, t) : 1;
}

// p of differences whose squares are so many times what the variances say.
double spread_p(double beyond, double variance, double above, double under) {
  if (!(beyond > 0)) return 1;
  const double ratio = variance > 0 ? beyond / variance : std::numeric_limits<double>::infinity();
  // Within two deviations it is likely enough.
  if (!(ratio > 1 + 2 * std::sqrt(2 / above + 2 / under))) return 1;
  return f_tail(above, under, ratio);
}

// The variance of a sample is common to both where the files say how many they have. A picture with few samples that has met none
// of something rare believes that it has no noise: the larger of the two sums holds.
double variance_of_both(const BlockSums& sums, const NoiseModel& model) {
  const double variance = sums.variance_a + sums.variance_b;
  if (!(model.samples_a > 0 && model.samples_b > 0)) return variance;
  const double of_one = (model.samples_a * sums.variance_a + model.samples_b * sums.variance_b) / 2;
  return std::max(variance, of_one * (1 / model.samples_a + 1 / model.samples_b));
}

}  // namespace

BlockAnswer known_test(const BlockSums& sums, const NoiseModel& model, double area, double below) {
  const double sum = sums.variance_a + sums.variance_b, f = model.freedom;
  // Satterthwaite's degrees of freedom. Squares of variances that are estimated are too large by (f + 2) / f, that of their sum by
  // 2 more.
  const double all = sums.variance_squares > 0 ? (f + 2) * sum * sum / sums.variance_squares - 2 : f;
  const double freedom = std::max(f, all / area), pixels = std::max(1.0, all / (2 * f) / area);
  const double variance = variance_of_both(sums, model);
  const double mean = mean_p(sums, variance * area, freedom, below);
  return {std::min(mean, spread_p(sums.beyond, variance, pixels, freedom)), 2};
}

BlockAnswer paired_test(const BlockSums& sums, double area, double below) {
  const double n = sums.pixels, independent = n / area;
  if (!(independent > 2)) return {};
  const double spread = std::max(0.0, (sums.squares - sums.difference * sums.difference / n) / (n - area));
  return {mean_p(sums, n * spread * area, independent - 1, below), 1};
}

}  // namespace whit
