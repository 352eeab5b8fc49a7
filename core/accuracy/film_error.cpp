#include "core/accuracy/film_error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/accuracy/measures.h"
#include "core/compare/quantiles.h"

namespace whit {
namespace {

constexpr float kBrighter = 8;  ///< Times as bright as a pixel and as the picture: light that samples may have missed.
constexpr float kQuieter = 1 / 64.0f;  ///< Of three degrees of freedom 0.3 % are by chance.
constexpr int kSurroundings = 2;       ///< Pixels to each side.
constexpr uint32_t kTelling = 16;      ///< Of fewer samples all may be alike where half of the light is in shadow.
constexpr int kTile = 16;

/// A window's pixels as numbers.
class Grid {
 public:
  explicit Grid(const Picture& p) : width_(p.width()), height_(p.window.max.y - p.window.min.y) {}
  int width() const { return width_; }
  int height() const { return height_; }
  size_t size() const { return static_cast<size_t>(width_) * static_cast<size_t>(height_); }
  size_t at(int x, int y) const {
    return static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x);
  }
  /// Calls body(pixel) for those within `reach` of one, itself included.
  template <class Body>
  void around(int x, int y, int reach, const Body& body) const {
    for (int v = std::max(y - reach, 0); v <= std::min(y + reach, height_ - 1); ++v) {
      for (int u = std::max(x - reach, 0); u <= std::min(x + reach, width_ - 1); ++u) body(at(u, v));
    }
  }

 private:
  int width_, height_;
};

/// The largest of three channels: a coloured lamp is as bright as a white one.
std::vector<float> brightness(const Picture& picture, const Grid& grid) {
  std::vector<float> out(grid.size());
  for (size_t p = 0; p < out.size(); ++p)
    out[p] = std::max({picture.rgb[3 * p], picture.rgb[3 * p + 1], picture.rgb[3 * p + 2]});
  return out;
}

void doubt_dim_neighbours(const std::vector<float>& bright, const Grid& grid, int reach,
                          std::vector<uint8_t>& doubted) {
  const double sum = std::accumulate(bright.begin(), bright.end(), 0.0);
  const float mean = static_cast<float>(sum / static_cast<double>(grid.size()));
  for (int y = 0; y < grid.height(); ++y) {
    for (int x = 0; x < grid.width(); ++x) {
      const float lamp = bright[grid.at(x, y)];
      if (lamp <= kBrighter * mean) continue;
      grid.around(x, y, reach + 1, [&](size_t p) { doubted[p] |= lamp > kBrighter * bright[p]; });
    }
  }
}

void doubt_quiet_pixels(std::span<const float> variance, std::span<const uint32_t> samples, const Grid& grid,
                        std::vector<uint8_t>& doubted) {
  std::vector<float> sum(grid.size()), around;
  for (size_t p = 0; p < sum.size(); ++p) sum[p] = variance[3 * p] + variance[3 * p + 1] + variance[3 * p + 2];
  for (int y = 0; y < grid.height(); ++y) {
    for (int x = 0; x < grid.width(); ++x) {
      if (samples[grid.at(x, y)] < kTelling) continue;
      around.clear();
      grid.around(x, y, kSurroundings, [&](size_t p) { around.push_back(sum[p]); });
      const auto middle = around.begin() + static_cast<std::ptrdiff_t>(around.size() / 2);
      std::nth_element(around.begin(), middle, around.end());
      doubted[grid.at(x, y)] |= sum[grid.at(x, y)] < kQuieter * *middle;
    }
  }
}

/// Calls body(x0, y0, x1, y1) for the tiles of the fixed grid of the picture, in pixels of the window.
template <class Body>
void each_tile(const Picture& picture, int size, const Body& body) {
  const Box2i& w = picture.window;
  for (int y = w.min.y / size * size; y < w.max.y; y += size) {
    for (int x = w.min.x / size * size; x < w.max.x; x += size) {
      body(std::max(x - w.min.x, 0), std::max(y - w.min.y, 0), std::min(x + size, w.max.x) - w.min.x,
           std::min(y + size, w.max.y) - w.min.y);
    }
  }
}

template <class Body>
void each_pixel(const Grid& grid, int x0, int y0, int x1, int y1, const Body& body) {
  for (int y = y0; y < y1; ++y) {
    for (int x = x0; x < x1; ++x) body(grid.at(x, y));
  }
}

void spread_to_tiles(const Picture& picture, const Grid& grid, std::vector<uint8_t>& doubted) {
  each_tile(picture, kTile, [&](int x0, int y0, int x1, int y1) {
    int n = 0;
    each_pixel(grid, x0, y0, x1, y1, [&](size_t p) { n += doubted[p]; });
    if (4 * n < (x1 - x0) * (y1 - y0)) return;
    each_pixel(grid, x0, y0, x1, y1, [&](size_t p) { doubted[p] = 1; });
  });
}

/// Where most of them are.
std::vector<Vec2i> densest(const Picture& picture, const Grid& grid, const std::vector<uint8_t>& doubted) {
  std::vector<std::pair<int, Vec2i>> tiles;
  each_tile(picture, kTile, [&](int x0, int y0, int x1, int y1) {
    int n = 0;
    Vec2i first;
    for (int y = y0; y < y1; ++y) {
      for (int x = x0; x < x1; ++x) {
        if (doubted[grid.at(x, y)] && n++ == 0) first = picture.window.min + Vec2i(x, y);
      }
    }
    if (n > 0) tiles.emplace_back(n, first);
  });
  std::stable_sort(tiles.begin(), tiles.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<Vec2i> out;
  for (size_t k = 0; k < std::min<size_t>(tiles.size(), 3); ++k) out.push_back(tiles[k].second);
  return out;
}

/// What independent parts of the picture add to the sum of variances.
struct Contributions {
  double sum = 0, squares = 0;
  void add(double v) { sum += v, squares += v * v; }
};

Contributions contributions(const Picture& picture, std::span<const float> variance, const Doubts& doubts) {
  const Grid grid(picture);
  Contributions all;
  each_tile(picture, kTile, [&](int x0, int y0, int x1, int y1) {
    double part[4] = {0, 0, 0, 0};
    bool doubtful = false;
    for (int y = y0; y < y1; ++y) {
      for (int x = x0; x < x1; ++x) {
        const size_t p = grid.at(x, y);
        const int fourth = 2 * ((y + picture.window.min.y) / 8 % 2) + (x + picture.window.min.x) / 8 % 2;
        if (doubts.pixels[p]) doubtful = true;
        else part[fourth] += double{variance[3 * p]} + double{variance[3 * p + 1]} + double{variance[3 * p + 2]};
      }
    }
    if (doubtful) all.add(part[0] + part[1] + part[2] + part[3]);
    else
      for (const double v : part) all.add(v);
  });
  return all;
}

}  // namespace

Doubts find_doubts(const Picture& picture, std::span<const float> variance, std::span<const uint32_t> samples,
                   int reach) {
  const Grid grid(picture);
  Doubts out;
  out.pixels.assign(grid.size(), 0);
  doubt_dim_neighbours(brightness(picture, grid), grid, reach, out.pixels);
  doubt_quiet_pixels(variance, samples, grid, out.pixels);
  spread_to_tiles(picture, grid, out.pixels);
  for (int y = 0; y < grid.height(); ++y) {
    for (int x = 0; x < grid.width(); ++x) {
      if (!out.pixels[grid.at(x, y)]) continue;
      ++out.count;
      out.where.extendBy(picture.window.min + Vec2i(x, y));
    }
  }
  out.densest = densest(picture, grid, out.pixels);
  return out;
}

ErrorClaim claim_error(const Picture& picture, std::span<const float> variance, const Doubts& doubts,
                       double confidence) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const double mean = mean_radiance(picture.rgb), trusted = static_cast<double>(doubts.pixels.size()) - doubts.count;
  const Contributions v = contributions(picture, variance, doubts);
  if (!(mean > 0) || trusted == 0 || !std::isfinite(v.sum)) return {kInfinity, 0, kInfinity, 0};
  const double scale = 1 / (3 * trusted * mean * mean);
  ErrorClaim claim;
  claim.value = std::sqrt(v.sum * scale);
  if (v.sum == 0) return claim;
  claim.freedom = (TileSums::kBlocks - 1) * v.sum * v.sum / v.squares;
  const auto bound = [&](double p) {
    return std::sqrt(v.sum * scale * claim.freedom / chi_square_quantile(claim.freedom, p));
  };
  claim.low = bound(confidence), claim.high = bound(1 - confidence);
  return claim;
}

}  // namespace whit
