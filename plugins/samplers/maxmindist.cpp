// Film positions that keep their distance from each other: a (0,m,2)-net whose generator matrix is found by search when
// rendering begins, moved around at random from pixel to pixel and from set to set. Further dimensions are pairs of
// SobolSampler's. Source: Grünschloß and Keller, (t,m,s)-Nets and Maximized Minimum Distance, Part II, 2009.

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <vector>

#include "core/base/sobol.h"
#include "core/plugin/registry.h"
#include "plugins/shared/sample_sets.h"
#include "plugins/shared/sobol_sampler.h"

namespace whit {
namespace {

constexpr int kMostBits = 12;         // with more samples than 4096 distances no longer matter
constexpr int64_t kEffort = 4000000;  // pairs of points to look at: some milliseconds

/// The heights of 2^bits points (i, height[i]) on a grid of 2^bits columns and rows, by random generator matrices.
class NetSearch {
 public:
  explicit NetSearch(int bits) : bits_(bits), count_(1 << bits) {}

  std::vector<uint32_t> best() {
    std::vector<uint32_t> points = net(), candidate;
    int64_t distance2 = min_distance2(points, 0);
    while (work_ < kEffort && bits_ > 1) {
      candidate = net();
      const int64_t d = min_distance2(candidate, distance2);
      if (d > distance2) points = candidate, distance2 = d;
    }
    return points;
  }

 private:
  uint32_t random() { return mix32(++state_ * 0x9e3779b9u); }

  /// A net: the product of a lower and an upper triangular matrix with unit diagonals has no singular leading minor,
  /// and that makes every elementary interval hold one point.
  std::vector<uint32_t> net() {
    std::vector<uint32_t> lower(static_cast<size_t>(bits_)), points(static_cast<size_t>(count_));
    const auto n = static_cast<uint32_t>(bits_);
    const uint32_t mask = static_cast<uint32_t>(count_) - 1;
    // Row j of a column is bit n - 1 - j: the first row gives the most significant digit.
    for (uint32_t j = 0; j < n; ++j) lower[j] = ((1u << (n - 1 - j)) | (random() & ~((1u << (n - j)) - 1))) & mask;
    for (uint32_t k = 0; k < n; ++k) {
      const uint32_t upper = (1u << (n - 1 - k)) | (random() & mask & ~((1u << (n - k)) - 1));
      uint32_t column = 0;
      for (uint32_t j = 0; j < n; ++j)
        column |= static_cast<uint32_t>(std::popcount(lower[j] & upper) & 1) << (n - 1 - j);
      for (uint32_t i = 0; i < (1u << k); ++i) points[i | (1u << k)] = points[i] ^ column;
    }
    return points;
  }

  /// The smallest squared distance on the torus, in grid cells; any number up to `enough` when it is not above that.
  int64_t min_distance2(const std::vector<uint32_t>& points, int64_t enough) {
    const auto mask = static_cast<uint32_t>(count_) - 1;
    int64_t best = int64_t{count_} * count_;
    for (uint32_t i = 0; i <= mask; ++i) {
      for (uint32_t d = 1; d <= mask / 2 + 1 && int64_t{d} * d < best; ++d, ++work_) {
        const uint32_t up = (points[(i + d) & mask] - points[i]) & mask, down = (mask + 1 - up) & mask;
        const int64_t dy = std::min(up, down);
        best = std::min(best, int64_t{d} * d + dy * dy);
      }
      if (best <= enough) return best;
    }
    return best;
  }

  int bits_, count_;
  uint32_t state_ = 0;
  int64_t work_ = 0;
};

class MaxMinDist final : public SobolSampler {
 public:
  int dimensions = 4;  ///< pbrt's; here no dimension is worse than another.

  void check(Diagnostics&, SourcePos) override { set_samples_per_pixel(pixel_samples); }
  int set_samples_per_pixel(int n) override {
    asked_ = n;
    return pixel_samples = static_cast<int>(std::bit_ceil(static_cast<uint32_t>(std::clamp(n, 1, kMaxSamples))));
  }
  std::string rounding() const override {
    return asked_ == pixel_samples ? "" : fmt::format("maxmindist takes powers of two; {} were asked for", asked_);
  }
  bool extends() const override { return false; }

  bool prepare(const PrepareContext&) override {
    const int bits = std::bit_width(static_cast<uint32_t>(pixel_samples)) - 1;
    heights_.clear();
    if (bits <= kMostBits) heights_ = NetSearch(bits).best();
    return true;
  }

  void pixel_offset(const SampleKeys& keys, float* u, float* v) const override {
    if (heights_.size() != static_cast<size_t>(pixel_samples)) {
      get_2d(keys, 0, u, v);
      return;
    }
    const uint32_t base = mix32(seed ^ 0x4d4d6469u), mask = static_cast<uint32_t>(pixel_samples) - 1;
    const int bits = std::bit_width(mask);
    const float width = 1 / static_cast<float>(pixel_samples);
    const uint32_t* const heights = heights_.data();
    for_lanes(keys.n, [=, px = keys.px, py = keys.py, sample = keys.index](int i) {
      const uint32_t pixel = pixel_key(base, px[i], py[i]) ^ set_key(sample[i] >> bits);
      const uint32_t at = sample[i] & mask, jitter = hash_combine(pixel, at);
      // Moved on the torus by whole cells, so that distances stay, and jittered within the cell.
      const uint32_t x = (at + pixel) & mask, y = (heights[at] + (pixel >> 16)) & mask;
      u[i] = min_below_one((static_cast<float>(static_cast<int32_t>(x)) + unit_float(jitter)) * width);
      v[i] = min_below_one((static_cast<float>(static_cast<int32_t>(y)) + unit_float(mix32(jitter))) * width);
    });
  }

 private:
  static float min_below_one(float x) { return x < kBelowOne ? x : kBelowOne; }

  int asked_ = 16;                 ///< Before rounding.
  std::vector<uint32_t> heights_;  ///< Empty when there are too many samples for a search.
};

const Register<MaxMinDist> maxmindist{"maxmindist",
                                      "Film positions far from each other; scrambled Sobol points elsewhere.",
                                      pixelsamples_param("Samples per pixel; rounded up to a power of two."),
                                      param(&MaxMinDist::dimensions, "dimensions", 4, Unit::None,
                                            "Accepted for pbrt's sake; every dimension is as good as the first.")};

}  // namespace
}  // namespace whit
