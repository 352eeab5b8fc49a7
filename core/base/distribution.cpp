#include "core/base/distribution.h"

#include <algorithm>
#include <cmath>

#include "core/base/radical_inverse.h"

namespace whit {
namespace {

/// For n lanes the last of `cells` cells whose cumulative value is at most u, by bisection: all lanes take the same
/// number of steps. Lane i looks at cdf + start[i]; the cell starts at 0 in `cell`.
void find_cells(int n, const float* cdf, const ptrdiff_t* start, int cells, const float* u, int* cell, float* rest) {
#pragma omp simd
  for (int i = 0; i < n; ++i) cell[i] = 0;
  for (int left = cells; left > 1;) {
    const int half = left / 2;
#pragma omp simd
    for (int i = 0; i < n; ++i) cell[i] += cdf[start[i] + cell[i] + half] <= u[i] ? half : 0;
    left -= half;
  }
#pragma omp simd
  for (int i = 0; i < n; ++i) {
    const float low = cdf[start[i] + cell[i]], high = cdf[start[i] + cell[i] + 1];
    const float r = (u[i] - low) / (high - low);
    rest[i] = r < kBelowOne ? r : kBelowOne;
  }
}

}  // namespace

double build_cell_cdf(std::span<const double> weights, float* cdf) {
  constexpr double kUnits = 1 << 24;
  double sum = 0;
  size_t positive = 0;
  for (const double w : weights) sum += w, positive += w > 0 ? 1 : 0;
  const bool black = positive == 0;
  if (black) positive = weights.size();
  // One unit for every cell that counts, and the rest in proportion.
  const double total = black ? static_cast<double>(weights.size()) : sum;
  const double shared = kUnits - static_cast<double>(positive);
  double running = 0, given = 0;
  cdf[0] = 0;
  for (size_t i = 0; i < weights.size(); ++i) {
    const double w = black ? 1 : weights[i];
    running += w, given += w > 0 ? 1 : 0;
    const bool complete = given == static_cast<double>(positive);  // rounding of the sum must not leave a gap
    cdf[i + 1] = static_cast<float>((complete ? kUnits : given + std::floor(shared * (running / total))) / kUnits);
  }
  return sum;
}

GridDistribution::GridDistribution(int columns, int rows,
                                   const std::function<void(int row, std::span<double>)>& row_weights)
    : columns_(columns),
      rows_(rows),
      rows_cdf_(static_cast<size_t>(rows) + 1),
      columns_cdf_(static_cast<size_t>(rows) * (static_cast<size_t>(columns) + 1)) {
  std::vector<double> weights(static_cast<size_t>(columns)), row_sums(static_cast<size_t>(rows));
  for (size_t r = 0; r < row_sums.size(); ++r) {
    row_weights(static_cast<int>(r), weights);
    row_sums[r] = build_cell_cdf(weights, columns_cdf_.data() + r * (weights.size() + 1));
  }
  build_cell_cdf(row_sums, rows_cdf_.data());
}

void GridDistribution::sample(int n, const float* u, const float* v, int* column, int* row, float* du,
                              float* dv) const {
  constexpr int kBlock = 128;
  ptrdiff_t start[kBlock];
  for (int first = 0; first < n; first += kBlock) {
    const int count = std::min(kBlock, n - first);
    std::fill_n(start, count, 0);
    find_cells(count, rows_cdf_.data(), start, rows_, v + first, row + first, dv + first);
    const ptrdiff_t stride = columns_ + 1;
    for (int i = 0; i < count; ++i) start[i] = stride * row[first + i];
    find_cells(count, columns_cdf_.data(), start, columns_, u + first, column + first, du + first);
  }
}

}  // namespace whit
