#include "core/compare/noise_reach.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace whit {
namespace {

constexpr int kSide = 8, kDistances = 3;
using Block = std::array<double, kSide * kSide>;

// Sums of products of neighbours, and of squares of the same numbers: along rows, then along columns.
struct Products {
  std::array<double, 2 * kDistances> products{}, squares{};
  void operator+=(const Products& o) {
    for (size_t k = 0; k < products.size(); ++k) products[k] += o.products[k], squares[k] += o.squares[k];
  }
};

// The block's differences, their mean taken away and their spread 1. What is far off counts as three times that. False where all
// are equal.
bool standardise(Block& z) {
  constexpr double kMost = 3, kCount = kSide * kSide;
  double sum = 0, square = 0;
  for (const double v : z) sum += v;
  for (double& v : z) v -= sum / kCount, square += v * v;
  if (!(square > 0)) return false;
  const double scale = 1 / std::sqrt(square / kCount);
  for (double& v : z) v = std::clamp(v * scale, -kMost, kMost);
  return true;
}

void add_block(const Block& z, Products& to) {
  for (int axis = 0; axis < 2; ++axis)
    for (int distance = 1; distance <= kDistances; ++distance) {
      const auto k = static_cast<size_t>(axis * kDistances + distance - 1);
      const int step = axis == 0 ? distance : distance * kSide;
      const int across = axis == 0 ? kSide - distance : kSide, down = axis == 0 ? kSide : kSide - distance;
      for (int y = 0; y < down; ++y)
        for (int x = 0; x < across; ++x) {
          const auto i = static_cast<size_t>(y * kSide + x);
          to.products[k] += z[i] * z[i + static_cast<size_t>(step)];
          to.squares[k] += z[i] * z[i];
        }
    }
}

Products row_of_blocks(std::span<const float> a, std::span<const float> b, int width, int y0) {
  Products row;
  for (int x0 = 0; x0 + kSide <= width; x0 += kSide) {
    Block z;
    for (int k = 0; k < kSide * kSide; ++k) {
      const size_t i =
          static_cast<size_t>(y0 + k / kSide) * static_cast<size_t>(width) + static_cast<size_t>(x0 + k % kSide);
      const double d = double{a[i]} - double{b[i]};
      z[static_cast<size_t>(k)] = std::isfinite(d) ? d : 0.0;
    }
    if (standardise(z)) add_block(z, row);
  }
  return row;
}

}  // namespace

double noise_reach(std::span<const float> a, std::span<const float> b, int width, int height) {
  std::vector<Products> rows(static_cast<size_t>(height / kSide));
  tbb::parallel_for(size_t{0}, rows.size(),
                    [&](size_t r) { rows[r] = row_of_blocks(a, b, width, static_cast<int>(r) * kSide); });
  Products all;
  for (const Products& row : rows) all += row;
  // Below this it is chance. A mean of 64 that is taken away makes neighbours unlike by 1/64.
  constexpr double kChance = 0.02;
  double along[2] = {1, 1};
  for (size_t k = 0; k < all.products.size(); ++k) {
    const double alike = all.squares[k] > 0 ? all.products[k] / all.squares[k] : 0;
    if (alike > kChance) along[k / kDistances] += 2 * (alike + 1.0 / (kSide * kSide));
  }
  return along[0] * along[1];
}

}  // namespace whit
