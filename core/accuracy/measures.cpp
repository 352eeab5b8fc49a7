#include "core/accuracy/measures.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

namespace whit {
namespace {

// A side of the blocks over which the spread of noise is measured: pixels' filters make neighbours alike.
constexpr int kNoiseBlock = 4;

template <class Of>
double mean_over(size_t n, const Of& of) {
  double sum = 0;
  for (size_t i = 0; i < n; ++i) sum += of(i);
  return sum / static_cast<double>(n);
}

double square(double v) { return v * v; }

}  // namespace

double mean_radiance(std::span<const float> rgb) {
  return mean_over(rgb.size(), [&](size_t i) { return double{rgb[i]}; });
}

double mean_square_error(std::span<const float> a, std::span<const float> b) {
  assert(a.size() == b.size());
  return mean_over(a.size(), [&](size_t i) { return square(double{a[i]} - double{b[i]}); });
}

double relative_mse(std::span<const float> x, std::span<const float> ref) {
  assert(x.size() == ref.size());
  const double epsilon = square(kRelmseShare * mean_radiance(ref));
  return mean_over(x.size(), [&](size_t i) {
    const double error = square(double{x[i]} - double{ref[i]});
    return error == 0 ? 0 : error / (square(double{ref[i]}) + epsilon);
  });
}

double error_quantile95(std::span<const float> x, std::span<const float> ref) {
  assert(x.size() == ref.size());
  if (x.empty()) return 0;
  std::vector<float> errors(x.size());
  for (size_t i = 0; i < x.size(); ++i) {
    errors[i] = std::abs(x[i] - ref[i]);
    if (std::isnan(errors[i])) return std::numeric_limits<double>::quiet_NaN();
  }
  // The least that 95 % of the values are not above.
  const auto at = errors.begin() + static_cast<ptrdiff_t>((errors.size() * 95 + 99) / 100 - 1);
  std::nth_element(errors.begin(), at, errors.end());
  return *at == 0 ? 0 : double{*at} / mean_radiance(ref);
}

double share_over_2_255(std::span<const float> display, std::span<const float> display_ref) {
  assert(display.size() == display_ref.size());
  constexpr float kLimit = 2.0f / 255;
  return mean_over(display.size() / 3, [&](size_t pixel) {
    for (size_t i = 3 * pixel; i < 3 * pixel + 3; ++i)
      if (!(std::abs(display[i] - display_ref[i]) <= kLimit)) return 1;
    return 0;
  });
}

WorstPixels worst_pixels(std::span<const double> squared_errors) {
  WorstPixels worst;
  const double total = std::accumulate(squared_errors.begin(), squared_errors.end(), 0.0);
  // Without an error no pixel carries it, and where one is not finite there are no shares.
  if (!(total > 0) || std::isinf(total)) return worst;
  std::vector<size_t> order(squared_errors.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::sort(order.begin(), order.end(), [&](size_t a, size_t b) {
    return squared_errors[a] != squared_errors[b] ? squared_errors[a] > squared_errors[b] : a < b;
  });
  double sum = 0;
  for (size_t i = 0; i < order.size() && sum < total / 2; ++i) {
    sum += squared_errors[order[i]];
    worst.pixels.push_back(order[i]);
    worst.shares.push_back(squared_errors[order[i]] / total);
  }
  return worst;
}

WorstPixels worst_pixels(std::span<const float> x, std::span<const float> ref) {
  assert(x.size() == ref.size());
  std::vector<double> squares(x.size() / 3);
  for (size_t i = 0; i < x.size(); ++i) squares[i / 3] += square(double{x[i]} - double{ref[i]});
  return worst_pixels(squares);
}

ReferenceNoise halves_noise(std::span<const float> a, std::span<const float> b, int width) {
  assert(a.size() == b.size() && width > 0);
  const size_t across = static_cast<size_t>((width + kNoiseBlock - 1) / kNoiseBlock);
  const size_t row = 3 * static_cast<size_t>(width);
  const size_t down = (a.size() / row + kNoiseBlock - 1) / kNoiseBlock;
  std::vector<double> blocks(across * down);
  for (size_t i = 0; i < a.size(); ++i)
    blocks[i / row / kNoiseBlock * across + i % row / 3 / kNoiseBlock] += square(double{a[i]} - double{b[i]}) / 4;
  double sum = 0, squares = 0;
  for (double block : blocks) {
    sum += block;
    squares += block * block;
  }
  // The variance of a sum of independent blocks is at most the sum of their mean squares, of which these are samples;
  // chi-square of f degrees has the relative variance 2 / f.
  if (sum == 0) return {};
  return {sum / static_cast<double>(a.size()), std::max(1.0, 2 * sum * sum / squares)};
}

namespace {

template <class ErrorOf>
ErrorProducts products_of(size_t replicates, size_t n, const ErrorOf& error_of) {
  ErrorProducts result{static_cast<int>(replicates), std::vector<double>(replicates * replicates)};
  for (size_t r = 0; r < replicates; ++r)
    for (size_t s = r; s < replicates; ++s)
      result.products[r * replicates + s] = result.products[s * replicates + r] =
          mean_over(n, [&](size_t i) { return error_of(r, i) * error_of(s, i); });
  return result;
}

}  // namespace

ErrorProducts error_products(std::span<const std::span<const float>> pictures, std::span<const float> ref) {
  return products_of(pictures.size(), ref.size(),
                     [&](size_t r, size_t i) { return double{pictures[r][i]} - double{ref[i]}; });
}

ErrorProducts difference_products(std::span<const std::span<const float>> a,
                                  std::span<const std::span<const float>> b) {
  assert(a.size() == b.size());
  return products_of(a.size(), a.empty() ? 0 : a[0].size(),
                     [&](size_t r, size_t i) { return double{a[r][i]} - double{b[r][i]}; });
}

}  // namespace whit
