#include "core/image/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>

namespace whit {
namespace {

constexpr int kBlock = 8;
constexpr double kTiny = 1e-12;

// The colour of a picture as doubles: height x width x 3.
struct Plane {
  int width = 0, height = 0;
  std::vector<double> v;
  double at(int x, int y, int c) const { return v[(static_cast<size_t>(y) * width + x) * 3 + c]; }
};

Plane colours(const Image& image) {
  Plane plane{image.width, image.height, {}};
  plane.v.reserve(static_cast<size_t>(image.width) * image.height * 3);
  const std::vector<int> rgb = image.rgb_channels();
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int c : rgb) plane.v.push_back(image.pixel(x, y)[c]);
  return plane;
}

double mean(const Plane& p) {
  double sum = 0;
  for (double v : p.v) sum += v;
  return sum / static_cast<double>(p.v.size());
}

std::array<double, 3> channel_means(const Plane& p) {
  std::array<double, 3> sum{};
  for (size_t i = 0; i < p.v.size(); ++i) sum[i % 3] += p.v[i];
  for (double& s : sum) s /= static_cast<double>(p.v.size() / 3);
  return sum;
}

int64_t count_bad(const Plane& p) {
  int64_t bad = 0;
  for (size_t i = 0; i < p.v.size(); i += 3)
    bad += !(std::isfinite(p.v[i]) && std::isfinite(p.v[i + 1]) && std::isfinite(p.v[i + 2]));
  return bad;
}

double relative_mse(const Plane& o, const Plane& r, double r_mean) {
  const double eps = (0.1 * r_mean) * (0.1 * r_mean) + kTiny;
  double sum = 0;
  for (size_t i = 0; i < r.v.size(); ++i) sum += (o.v[i] - r.v[i]) * (o.v[i] - r.v[i]) / (r.v[i] * r.v[i] + eps);
  return sum / static_cast<double>(r.v.size());
}

// Channels that are next to black in the reference have no say, unless all are.
double furthest_ratio(const Plane& o, const Plane& r, double r_mean) {
  const std::array<double, 3> om = channel_means(o), rm = channel_means(r);
  double furthest = 1;
  bool any = false;
  for (int c = 0; c < 3; ++c) {
    if (!(rm[c] > 0.05 * r_mean)) continue;
    const double ratio = om[c] / rm[c];
    if (!any || std::abs(ratio - 1) > std::abs(furthest - 1)) furthest = ratio;
    any = true;
  }
  if (any) return furthest;
  return mean(o) == r_mean ? 1.0 : std::numeric_limits<double>::infinity();
}

double block_mean(const Plane& p, int x0, int x1, int y0, int y1) {
  double sum = 0;
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x)
      for (int c = 0; c < 3; ++c) sum += p.at(x, y, c);
  return sum / (3.0 * (x1 - x0) * (y1 - y0));
}

// Blocks at the right and lower edge with less than half the pixels are left out.
double largest_block_error(const Plane& o, const Plane& r, double r_mean) {
  double largest = 0;
  for (int y0 = 0; y0 < r.height; y0 += kBlock)
    for (int x0 = 0; x0 < r.width; x0 += kBlock) {
      const int x1 = std::min(x0 + kBlock, r.width), y1 = std::min(y0 + kBlock, r.height);
      if ((x1 - x0) * (y1 - y0) < kBlock * kBlock / 2) continue;
      const double bo = block_mean(o, x0, x1, y0, y1), br = block_mean(r, x0, x1, y0, y1);
      largest = std::max(largest, std::abs(bo - br) / (br + 0.1 * r_mean + kTiny));
    }
  return largest;
}

// The p-quantile, linear between the two nearest ranks.
double quantile(std::vector<double> v, double p) {
  const double rank = p * static_cast<double>(v.size() - 1);
  const size_t low = static_cast<size_t>(rank);
  std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(low), v.end());
  const double a = v[low];
  const double b =
      low + 1 < v.size() ? *std::min_element(v.begin() + static_cast<std::ptrdiff_t>(low) + 1, v.end()) : a;
  return a + (rank - static_cast<double>(low)) * (b - a);
}

// Mean square error over the interior, `ref` displaced by (dx, dy), values bounded so that no highlight decides.
double shifted_error(const Plane& o, const Plane& r, int dx, int dy, double cap) {
  double sum = 0;
  for (int y = 1; y < r.height - 1; ++y)
    for (int x = 1; x < r.width - 1; ++x)
      for (int c = 0; c < 3; ++c) {
        const double d = std::min(o.at(x, y, c), cap) - std::min(r.at(x + dx, y + dy, c), cap);
        sum += d * d;
      }
  return sum / (3.0 * (r.width - 2) * (r.height - 2));
}

void measure_shift(const Plane& o, const Plane& r, double r_mean, Comparison& result) {
  if (r.width < 3 || r.height < 3) return;
  const double cap = 4 * quantile(r.v, 0.99) + kTiny;
  double unshifted = 0, best = std::numeric_limits<double>::infinity();
  int best_x = 0, best_y = 0;
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) {
      const double error = shifted_error(o, r, dx, dy, cap);
      if (dx == 0 && dy == 0) unshifted = error;
      if (error < best) std::tie(best, best_x, best_y) = std::tuple{error, dx, dy};
    }
  if ((best_x == 0 && best_y == 0) || !(best < 0.8 * unshifted) || !(unshifted > 1e-6 * r_mean * r_mean)) return;
  result.shifted = true;
  result.shift_x = -best_x;
  result.shift_y = -best_y;
}

void measure_differences(const Plane& o, const Plane& r, Comparison& result) {
  double squares = 0, peak = 0;
  for (size_t i = 0; i < r.v.size(); i += 3) {
    bool differs = false;
    for (size_t c = i; c < i + 3; ++c) {
      const double d = std::abs(o.v[c] - r.v[c]);
      differs |= d != 0;
      squares += d * d;
      peak = std::max(peak, r.v[c]);
      result.max_difference = std::max(result.max_difference, d);
    }
    result.differing_pixels += differs;
  }
  const double mse = squares / static_cast<double>(r.v.size());
  result.psnr = mse > 0 ? 10 * std::log10(peak * peak / mse) : std::numeric_limits<double>::infinity();
}

std::string window(const ImageInfo& i) {
  return fmt::format("({}, {}) of {} x {}", i.x, i.y, i.full_width, i.full_height);
}

std::string layout_problem(const Image& out, const Image& ref) {
  if (out.width != ref.width || out.height != ref.height)
    return fmt::format("size {} x {}, expected {} x {}", out.width, out.height, ref.width, ref.height);
  if (std::tie(out.x, out.y, out.full_width, out.full_height) !=
      std::tie(ref.x, ref.y, ref.full_width, ref.full_height))
    return fmt::format("data window at {}, expected {}", window(out), window(ref));
  if (out.pixels.empty() || ref.pixels.empty()) return "there are no pixels";
  return "";
}

}  // namespace

Comparison compare_images(const Image& out, const Image& ref) {
  Comparison result;
  result.failure = layout_problem(out, ref);
  if (!result.failure.empty()) return result;
  const Plane o = colours(out), r = colours(ref);
  result.bad_pixels = count_bad(o);
  if (result.bad_pixels > 0) result.failure = fmt::format("{} pixels with NaN or infinity", result.bad_pixels);
  else if (const int64_t bad = count_bad(r); bad > 0)
    result.failure = fmt::format("{} pixels of the reference with NaN or infinity", bad);
  if (!result.failure.empty()) return result;
  const double m = mean(r);
  result.relmse = relative_mse(o, r, m);
  result.ratio = furthest_ratio(o, r, m);
  result.block = largest_block_error(o, r, m);
  measure_shift(o, r, m, result);
  measure_differences(o, r, result);
  return result;
}

std::vector<std::string> judge(const Comparison& comparison, const CompareLimits& limits) {
  if (!comparison.failure.empty()) return {comparison.failure};
  std::vector<std::string> why;
  if (!(comparison.relmse <= limits.relmse)) why.push_back("relMSE");
  if (!(std::abs(comparison.ratio - 1) <= limits.ratio)) why.push_back("ratio");
  if (!(comparison.block <= limits.block)) why.push_back("block");
  if (comparison.shifted) why.push_back("shift");
  return why;
}

}  // namespace whit
