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
  // Sums are one addition after another; what is made of them is not, and is most of the work.
  constexpr size_t kBlock = 128;
  double sums[kBlock], counts[kBlock], running = 0, given = 0;
  const auto all = static_cast<double>(positive);
  cdf[0] = 0;
  for (size_t first = 0; first < weights.size(); first += kBlock) {
    const size_t n = std::min(kBlock, weights.size() - first);
    for (size_t i = 0; i < n; ++i) {
      const double w = black ? 1 : weights[first + i];
      sums[i] = running += w, counts[i] = given += w > 0 ? 1 : 0;
    }
    float* out = cdf + first + 1;
#pragma omp simd
    for (size_t i = 0; i < n; ++i) {
      const double units = counts[i] + std::floor(shared * (sums[i] / total));
      const bool complete = counts[i] == all;  // rounding of the sum must not leave a gap
      out[i] = static_cast<float>((complete ? kUnits : units) / kUnits);
    }
  }
  return sum;
}

GridDistribution::GridDistribution(int columns, int rows)
    : columns_(columns),
      rows_(rows),
      row_sums_(static_cast<size_t>(rows)),
      rows_cdf_(static_cast<size_t>(rows) + 1),
      columns_cdf_(
          std::make_unique_for_overwrite<float[]>(static_cast<size_t>(rows) * (static_cast<size_t>(columns) + 1))) {}

void GridDistribution::set_row(int row, std::span<const double> weights) {
  const auto r = static_cast<size_t>(row);
  row_sums_[r] = build_cell_cdf(weights, columns_cdf_.get() + r * (weights.size() + 1));
}

void GridDistribution::finish() {
  build_cell_cdf(row_sums_, rows_cdf_.data());
  row_sums_ = {};
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
    find_cells(count, columns_cdf_.get(), start, columns_, u + first, column + first, du + first);
  }
}

}  // namespace whit
