#include "core/compare/layer_measures.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace whit {
namespace {

constexpr size_t kChunk = size_t{1} << 16;  // Numbers that one thread takes at a time.
constexpr int kBlock = 8;

/// What `of` makes of each chunk of [0, n), in order.
template <class T, class Of>
std::vector<T> by_chunks(size_t n, const Of& of) {
  std::vector<T> parts((n + kChunk - 1) / kChunk);
  tbb::parallel_for(size_t{0}, parts.size(),
                    [&](size_t k) { parts[k] = of(k * kChunk, std::min(n, (k + 1) * kChunk)); });
  return parts;
}

struct Sums {
  double a = 0, b = 0, magnitude = 0, squares = 0, distances = 0;
  float peak = -std::numeric_limits<float>::infinity();
  double largest = 0;
};

Sums sums_of(const PlanePair& plane, size_t first, size_t last) {
  double a = 0, b = 0, magnitude = 0, squares = 0, distances = 0, largest = 0;
  float peak = -std::numeric_limits<float>::infinity();
  const float *const pa = plane.a.data(), *const pb = plane.b.data();
#pragma omp simd reduction(+ : a, b, magnitude, squares, distances) reduction(max : peak, largest)
  for (size_t i = first; i < last; ++i) {
    const double x = pa[i], y = pb[i], d = x - y;
    a += x, b += y, magnitude += std::abs(y), squares += d * d, distances += std::abs(d);
    peak = std::max(peak, pb[i]);
    largest = std::max(largest, std::abs(d));
  }
  return {a, b, magnitude, squares, distances, peak, largest};
}

double relative_error(double a, double b, double epsilon) { return (a - b) * (a - b) / (b * b + epsilon); }

void add_relative(const LayerPlanes& planes, double floor, std::vector<float>& relative) {
  const double share = 1 / static_cast<double>(planes.size()), epsilon = floor * floor;
  constexpr double kMost = std::numeric_limits<float>::max();
  by_chunks<char>(relative.size(), [&](size_t first, size_t last) {
    for (const PlanePair& plane : planes) {
      const float *const pa = plane.a.data(), *const pb = plane.b.data();
      float* const to = relative.data();
#pragma omp simd
      for (size_t i = first; i < last; ++i)
        to[i] = static_cast<float>(std::min(kMost, to[i] + share * relative_error(pa[i], pb[i], epsilon)));
    }
    return '\0';
  });
}

/// The mean over pixels and channels of what `of` makes of a pair of numbers.
template <class Of>
double mean_of(const LayerPlanes& planes, const Of& of) {
  double sum = 0;
  for (const PlanePair& plane : planes)
    for (const double part : by_chunks<double>(plane.b.size(), [&](size_t first, size_t last) {
           const float *const pa = plane.a.data(), *const pb = plane.b.data();
           double chunk = 0;
#pragma omp simd reduction(+ : chunk)
           for (size_t i = first; i < last; ++i) chunk += of(double{pa[i]}, double{pb[i]});
           return chunk;
         }))
      sum += part;
  return sum / static_cast<double>(planes.size() * planes[0].b.size());
}

// The median of the magnitudes that are not 0, of some 60 thousand of them.
double median_magnitude(const LayerPlanes& planes) {
  constexpr size_t kAsked = 60000;
  std::vector<float> some;
  const size_t step = std::max<size_t>(1, planes.size() * planes[0].b.size() / kAsked);
  for (const PlanePair& plane : planes)
    for (size_t i = 0; i < plane.b.size(); i += step)
      if (plane.b[i] != 0) some.push_back(std::abs(plane.b[i]));
  if (some.empty()) return 0;
  const auto middle = some.begin() + static_cast<ptrdiff_t>(some.size() / 2);
  std::nth_element(some.begin(), middle, some.end());
  return double{*middle};
}

// A lamp is no measure for what it shines on.
double usual_magnitude(const LayerPlanes& planes) {
  return mean_of(planes,
                 [most = 10 * median_magnitude(planes)](double, double b) { return std::min(most, std::abs(b)); });
}

// Where a plane's largest difference is first.
size_t place_of(const PlanePair& plane, double largest) {
  for (size_t i = 0; i < plane.a.size(); ++i)
    if (std::abs(double{plane.a[i]} - double{plane.b[i]}) >= largest) return i;
  return 0;
}

}  // namespace

bool all_finite(std::span<const float> values) {
  const auto parts = by_chunks<float>(values.size(), [&](size_t first, size_t last) {
    float sum = 0;  // Is no number as soon as a difference of a value and itself is none.
#pragma omp simd reduction(+ : sum)
    for (size_t i = first; i < last; ++i) sum += values[i] - values[i];
    return sum;
  });
  return std::all_of(parts.begin(), parts.end(), [](float sum) { return sum == 0; });
}

LayerErrors layer_errors(const LayerPlanes& planes) {
  const size_t pixels = planes.front().a.size();
  const double n = static_cast<double>(pixels), numbers = n * static_cast<double>(planes.size());
  LayerErrors e;
  double magnitude = 0;
  e.peak = -std::numeric_limits<double>::infinity();
  for (size_t c = 0; c < planes.size(); ++c) {
    Sums sum;
    for (const Sums& part : by_chunks<Sums>(pixels, [&](size_t f, size_t l) { return sums_of(planes[c], f, l); })) {
      sum.a += part.a, sum.b += part.b, sum.magnitude += part.magnitude;
      sum.squares += part.squares, sum.distances += part.distances;
      sum.peak = std::max(sum.peak, part.peak);
      sum.largest = std::max(sum.largest, part.largest);
    }
    e.mean_a.push_back(sum.a / n);
    e.mean_b.push_back(sum.b / n);
    magnitude += sum.magnitude;
    e.mse += sum.squares / numbers;
    e.mae += sum.distances / numbers;
    e.peak = std::max(e.peak, double{sum.peak});
    if (sum.largest <= e.largest) continue;
    e.largest = sum.largest;
    e.largest_channel = c;
  }
  if (e.largest > 0) e.largest_pixel = place_of(planes[e.largest_channel], e.largest);
  e.mean_magnitude = magnitude / numbers;
  e.usual_magnitude = usual_magnitude(planes);
  e.robust.assign(pixels, 0.0f);
  const double floor = floor_of(e.mean_magnitude);
  e.relmse = mean_of(planes, [epsilon = floor * floor](double x, double y) { return relative_error(x, y, epsilon); });
  add_relative(planes, floor_of(e.usual_magnitude), e.robust);
  return e;
}

Worst worst_share(const std::vector<float>& errors, double part) {
  std::vector<float> sorted = errors;
  Worst worst;
  worst.count = static_cast<size_t>(part * static_cast<double>(sorted.size()));
  const auto first_worst = sorted.end() - static_cast<ptrdiff_t>(worst.count);
  if (worst.count > 0) std::nth_element(sorted.begin(), first_worst, sorted.end());
  const double without = std::accumulate(sorted.begin(), first_worst, 0.0);
  const double with = std::accumulate(first_worst, sorted.end(), without);
  worst.mean_without = without / static_cast<double>(sorted.size() - worst.count);
  worst.share = with > 0 ? (with - without) / with : 0;
  return worst;
}

double floor_of(double magnitude) { return magnitude > 0 ? 0.1 * magnitude : 1e-6; }

Ratio furthest_ratio(const LayerErrors& errors) {
  constexpr double kDark = 0.05;
  Ratio furthest;
  bool any = false;
  for (size_t c = 0; c < errors.mean_b.size(); ++c) {
    if (!(errors.mean_b[c] > kDark * errors.mean_magnitude)) continue;
    const double ratio = errors.mean_a[c] / errors.mean_b[c];
    if (!any || std::abs(ratio - 1) > std::abs(furthest.value - 1)) furthest = {true, ratio, c};
    any = true;
  }
  if (any || errors.mean_magnitude > 0) return {any, furthest.value, furthest.channel};
  // Of a black reference: the light that there should not be.
  for (size_t c = 0; c < errors.mean_a.size(); ++c)
    if (std::abs(errors.mean_a[c]) > floor_of(0)) furthest = {true, std::numeric_limits<double>::infinity(), c};
  furthest.any = true;
  return furthest;
}

namespace {

// The upper left corners of blocks along a side: the last ends at the edge.
std::vector<int> corners(int size) {
  std::vector<int> all;
  for (int at = 0; at + kBlock <= size; at += kBlock) all.push_back(at);
  if (all.empty() || all.back() + kBlock < size) all.push_back(std::max(0, size - kBlock));
  return all;
}

// The pixels of a block.
struct Block {
  Vec2i first, last;  ///< The latter left out.
};

// Sums of one channel over the block's pixels that count.
struct BlockSums {
  double a = 0, b = 0;
  int pixels = 0;
};

BlockSums block_sums(const PlanePair& plane, const uint8_t* valid, int width, const Block& block) {
  BlockSums sums;
  for (int y = block.first.y; y < block.last.y; ++y)
    for (size_t i = static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(block.first.x),
                end = i + static_cast<size_t>(block.last.x - block.first.x);
         i < end; ++i) {
      if (valid && !valid[i]) continue;
      sums.a += double{plane.a[i]}, sums.b += double{plane.b[i]};
      ++sums.pixels;
    }
  return sums;
}

BlockErrors block_errors(const LayerPlanes& planes, const uint8_t* valid, int width, const Block& block, double floor) {
  BlockErrors errors{{0, 0, block.first}, {0, 0, block.first}};
  const double share = 1 / static_cast<double>(planes.size());
  double magnitude = 0;
  for (size_t c = 0; c < planes.size(); ++c) {
    const BlockSums sums = block_sums(planes[c], valid, width, block);
    if (sums.pixels == 0) return errors;
    const double off = (sums.a - sums.b) / sums.pixels;
    magnitude += share * std::abs(sums.b / sums.pixels);
    errors.mean.value += share * off;
    if (std::abs(off) > errors.one_channel.value) errors.one_channel = {std::abs(off), c, block.first};
  }
  errors.mean.value = std::abs(errors.mean.value) / (magnitude + floor);
  errors.one_channel.value /= magnitude + floor;
  return errors;
}

void keep_larger(BlockError& here, const BlockError& other) {
  if (other.value > here.value) here = other;
}

}  // namespace

BlockErrors largest_block_errors(const LayerPlanes& planes, const uint8_t* valid, int width, int height, double floor) {
  const std::vector<int> across = corners(width), down = corners(height);
  std::vector<BlockErrors> rows(down.size());
  tbb::parallel_for(size_t{0}, down.size(), [&](size_t r) {
    for (const int x : across) {
      const Vec2i first(x, down[r]), last(std::min(x + kBlock, width), std::min(down[r] + kBlock, height));
      const BlockErrors errors = block_errors(planes, valid, width, {first, last}, floor);
      keep_larger(rows[r].mean, errors.mean);
      keep_larger(rows[r].one_channel, errors.one_channel);
    }
  });
  BlockErrors largest;
  for (const BlockErrors& row : rows)
    keep_larger(largest.mean, row.mean), keep_larger(largest.one_channel, row.one_channel);
  return largest;
}

namespace {

bool has_near(std::span<const float> plane, float value, int x, int y, int width, int height) {
  for (int ny = std::max(0, y - 1); ny <= std::min(height - 1, y + 1); ++ny)
    for (int nx = std::max(0, x - 1); nx <= std::min(width - 1, x + 1); ++nx)
      if (equal_numbers(plane[static_cast<size_t>(ny) * static_cast<size_t>(width) + static_cast<size_t>(nx)], value))
        return true;
  return false;
}

}  // namespace

Mismatch mismatch_of(std::span<const float> a, std::span<const float> b, int width, int height) {
  size_t count = 0;
  Mismatch result;
  for (size_t i = 0; i < a.size(); ++i) {
    if (equal_numbers(a[i], b[i])) continue;
    const int x = static_cast<int>(i % static_cast<size_t>(width)),
              y = static_cast<int>(i / static_cast<size_t>(width));
    if (has_near(b, a[i], x, y, width, height) && has_near(a, b[i], x, y, width, height)) continue;
    if (count++ == 0) result.first = i;
  }
  result.share = static_cast<double>(count) / static_cast<double>(a.size());
  return result;
}

std::vector<uint8_t> differing(const LayerPlanes& planes) {
  std::vector<uint8_t> differs(planes.front().a.size());
  by_chunks<char>(differs.size(), [&](size_t first, size_t last) {
    for (const PlanePair& plane : planes) {
      const float *const a = plane.a.data(), *const b = plane.b.data();
      uint8_t* const to = differs.data();
#pragma omp simd
      for (size_t i = first; i < last; ++i) {
        const int unequal =
            static_cast<int>(!(a[i] == b[i])) & (static_cast<int>(a[i] == a[i]) | static_cast<int>(b[i] == b[i]));
        to[i] = static_cast<uint8_t>(to[i] | unequal);
      }
    }
    return '\0';
  });
  return differs;
}

}  // namespace whit
