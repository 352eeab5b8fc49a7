#include "core/compare/ssim.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/compare/convolve.h"

namespace whit {
namespace {

constexpr int kRadius = 5;
constexpr double kSigma = 1.5, kC1 = 0.01 * 0.01, kC2 = 0.03 * 0.03;

HalfKernel<double> gaussian() {
  HalfKernel<double> kernel;
  double sum = 0;
  for (int i = 0; i <= kRadius; ++i) {
    kernel.weights.push_back(std::exp(-i * i / (2 * kSigma * kSigma)));
    sum += kernel.weights.back() * (i > 0 ? 2 : 1);
  }
  for (double& w : kernel.weights) w /= sum;
  return kernel;
}

struct Pictures {
  std::span<const float> a, b;
  int width, height;
};

// Of one channel. The maximum is not included.
struct Tile {
  int channel, x0, x1, y0, y1;
  size_t width() const { return static_cast<size_t>(x1 - x0); }
};

// Where the picture that goes on as its mirror image has its pixel `i`.
int mirrored(int i, int size) {
  const int period = 2 * size, at = ((i % period) + period) % period;
  return at < size ? at : period - 1 - at;
}

// What is averaged with the window: both pictures, the sum of their squares (only that is asked for) and their product.
// In doubles, because variances are small differences of these.
enum { kA, kB, kSquares, kProduct, kPlanes };

class Window {
 public:
  explicit Window(size_t width)
      : width_(width), rows_(kPlanes, std::vector<double>(width + 2 * kRadius)), ring_(kPlanes * kDepth * width) {
    for (std::vector<double>& plane : averages_) plane.resize(width);
  }

  void show(const Pictures& pictures, const Tile& tile, int y) {
    read(pictures, tile, y);
    for (size_t plane = 0; plane < kPlanes; ++plane) {
      std::array<const double*, 2 * kRadius + 1> from;
      for (size_t k = 0; k < from.size(); ++k) from[k] = rows_[plane].data() + k;
      convolve(kernel_, &from[kRadius], width_, row(plane, y));
    }
  }

  // The sum of the similarities of a row, when the rows up to kRadius below have been shown.
  double sum_of_row(int y) {
    for (size_t plane = 0; plane < kPlanes; ++plane) {
      std::array<const double*, 2 * kRadius + 1> from;
      for (int k = -kRadius; k <= kRadius; ++k) from[static_cast<size_t>(k + kRadius)] = row(plane, y + k);
      convolve(kernel_, &from[kRadius], width_, averages_[plane].data());
    }
    double* out = averages_[kA].data();
    const double *b = averages_[kB].data(), *squares = averages_[kSquares].data();
    const double* product = averages_[kProduct].data();
    for (size_t x = 0; x < width_; ++x) {
      const double product_of_means = out[x] * b[x], squares_of_means = out[x] * out[x] + b[x] * b[x];
      const double variances = squares[x] - squares_of_means, covariance = product[x] - product_of_means;
      out[x] = (2 * product_of_means + kC1) * (2 * covariance + kC2) / ((squares_of_means + kC1) * (variances + kC2));
    }
    double sum = 0;
    for (size_t x = 0; x < width_; ++x) sum += out[x];
    return sum;
  }

 private:
  static constexpr int kDepth = 16;  // Rows that are kept: the next power of two.

  double* row(size_t plane, int y) { return &ring_[(plane * kDepth + static_cast<size_t>(y & (kDepth - 1))) * width_]; }

  void read(const Pictures& pictures, const Tile& tile, int y) {
    const auto first = static_cast<size_t>(mirrored(y, pictures.height)) * static_cast<size_t>(pictures.width);
    for (size_t i = 0; i < rows_[kA].size(); ++i) {
      const int x = mirrored(tile.x0 - kRadius + static_cast<int>(i), pictures.width);
      const size_t at = 3 * (first + static_cast<size_t>(x)) + static_cast<size_t>(tile.channel);
      rows_[kA][i] = double{pictures.a[at]};
      rows_[kB][i] = double{pictures.b[at]};
    }
    const double *a = rows_[kA].data(), *b = rows_[kB].data();
    double *squares = rows_[kSquares].data(), *product = rows_[kProduct].data();
    for (size_t i = 0; i < rows_[kA].size(); ++i) {
      squares[i] = a[i] * a[i] + b[i] * b[i];
      product[i] = a[i] * b[i];
    }
  }

  const HalfKernel<double> kernel_ = gaussian();
  size_t width_;
  std::vector<std::vector<double>> rows_;  // The row shown, and kRadius numbers on either side, for each plane.
  std::vector<double> ring_;               // The last rows shown, filtered along themselves.
  std::array<std::vector<double>, kPlanes> averages_;
};

double sum_of_tile(const Pictures& pictures, const Tile& tile) {
  Window window(tile.width());
  double sum = 0;
  for (int y = tile.y0 - kRadius; y < tile.y1 + kRadius; ++y) {
    window.show(pictures, tile, y);
    if (y - kRadius >= tile.y0) sum += window.sum_of_row(y - kRadius);
  }
  return sum;
}

// Tiles of a size at which their numbers stay in the processor's cache, on a grid that is the same for any number of threads.
std::vector<Tile> tiles_of(int x0, int x1, int y0, int y1) {
  constexpr int kWidth = 384, kHeight = 256;
  std::vector<Tile> tiles;
  for (int y = y0; y < y1; y += kHeight)
    for (int x = x0; x < x1; x += kWidth)
      for (int channel = 0; channel < 3; ++channel)
        tiles.push_back({channel, x, std::min(x + kWidth, x1), y, std::min(y + kHeight, y1)});
  return tiles;
}

}  // namespace

double structural_similarity(std::span<const float> a, std::span<const float> b, int width, int height) {
  assert(a.size() == 3 * static_cast<size_t>(width) * static_cast<size_t>(height) && b.size() == a.size());
  const int border = std::min(width, height) > 2 * kRadius ? kRadius : 0;
  const std::vector<Tile> tiles = tiles_of(border, width - border, border, height - border);
  std::vector<double> sums(tiles.size());
  tbb::parallel_for(size_t{0}, tiles.size(), [&](size_t i) { sums[i] = sum_of_tile({a, b, width, height}, tiles[i]); });
  double sum = 0;
  for (double s : sums) sum += s;
  return sum / (3.0 * (width - 2 * border) * (height - 2 * border));
}

}  // namespace whit
