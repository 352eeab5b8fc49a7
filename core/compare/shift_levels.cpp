#include "core/compare/shift_levels.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace whit {
namespace {

// Of the absolute values, from a sample of large pictures. Of those that are not 0 if most are.
float percentile99(std::span<const float> v) {
  constexpr size_t kSample = 1 << 16;
  const size_t step = v.size() <= kSample ? 1 : v.size() / kSample | 1;
  std::vector<float> sample;
  for (size_t i = 0; i < v.size(); i += step)
    if (std::isfinite(v[i])) sample.push_back(std::abs(v[i]));
  for (int round = 0; round < 2 && !sample.empty(); ++round) {
    const auto rank = sample.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(sample.size() - 1));
    std::nth_element(sample.begin(), rank, sample.end());
    if (*rank > 0) return *rank;
    std::erase(sample, 0.0f);
  }
  return 0;
}

// What gain and offset are made of.
struct Moments {
  double out = 0, ref = 0, out_squares = 0, ref_squares = 0, products = 0, ref_absolute = 0;

  void add(const Moments& m) {
    out += m.out, ref += m.ref, out_squares += m.out_squares, ref_squares += m.ref_squares;
    products += m.products, ref_absolute += m.ref_absolute;
  }
};

Moments moments_of_row(const float* out, const float* ref, size_t n) {
  Moments m;
  // Short sums in floats, which are exact enough, in the order in which vectors have them.
  constexpr size_t kBlock = 256;
  for (size_t first = 0; first < n; first += kBlock) {
    const size_t end = std::min(first + kBlock, n);
    float o1 = 0, r1 = 0, oo = 0, rr = 0, orr = 0, ra = 0;
#pragma omp simd reduction(+ : o1, r1, oo, rr, orr, ra)
    for (size_t x = first; x < end; ++x) {
      const float o = out[x], r = ref[x];
      o1 += o, r1 += r, oo += o * o, rr += r * r, orr += o * r, ra += std::abs(r);
    }
    m.add({double{o1}, double{r1}, double{oo}, double{rr}, double{orr}, double{ra}});
  }
  return m;
}

Moments moments_of(const ShiftView& out, const ShiftView& ref) {
  constexpr int kRows = 16;
  std::vector<Moments> parts(static_cast<size_t>((out.height + kRows - 1) / kRows));
  const auto width = static_cast<size_t>(out.width);
  tbb::parallel_for(size_t{0}, parts.size(), [&](size_t part) {
    std::vector<float> o(width), r(width);
    const int first = static_cast<int>(part) * kRows;
    for (int y = first; y < std::min(first + kRows, out.height); ++y) {
      out.load(0, y, width, o.data());
      ref.load(0, y, width, r.data());
      parts[part].add(moments_of_row(o.data(), r.data(), width));
    }
  });
  Moments sum;
  for (const Moments& m : parts) sum.add(m);
  return sum;
}

void add_row(const ShiftView& view, int x, int y, std::vector<float>& row, std::vector<float>& sums) {
  view.load(x, y, row.size(), row.data());
  for (size_t i = 0; i < row.size(); ++i) sums[i] += row[i];
}

}  // namespace

void ShiftView::load(int x, int y, size_t n, float* to) const {
  const float* from = &numbers[static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)];
  const float factor = scale, most = bound, times = gain, plus = offset;
#pragma omp simd
  for (size_t i = 0; i < n; ++i) {
    const float v = from[i] * factor, low = v > -most ? v : -most, bounded = low < most ? low : most;
    to[i] = (v == v ? bounded : 0.0f) * times + plus;
  }
}

ShiftPlane plane_of(const ShiftView& view, int x, int y, int width, int height) {
  ShiftPlane plane{width, height, std::vector<float>(static_cast<size_t>(width) * static_cast<size_t>(height))};
  for (int row = 0; row < height; ++row)
    view.load(x, y + row, static_cast<size_t>(width), &plane.v[static_cast<size_t>(row) * static_cast<size_t>(width)]);
  return plane;
}

ShiftPlane reduced(const ShiftView& view, int size, int x, int y) {
  ShiftPlane plane{(view.width - x) / size, (view.height - y) / size, {}};
  const auto width = static_cast<size_t>(plane.width), block = static_cast<size_t>(size);
  plane.v.resize(width * static_cast<size_t>(plane.height));
  const float share = 1 / static_cast<float>(size * size);
  tbb::parallel_for(0, plane.height, [&](int to) {
    std::vector<float> row(width * block), sums(width * block);
    for (int i = 0; i < size; ++i) add_row(view, x, y + to * size + i, row, sums);
    float* out = &plane.v[static_cast<size_t>(to) * width];
    for (size_t i = 0; i < width; ++i) {
      float sum = 0;
      for (size_t k = 0; k < block; ++k) sum += sums[i * block + k];
      out[i] = sum * share;
    }
  });
  return plane;
}

// Gives `out` the mean and the deviation of `ref`, within reason.
void ShiftLevels::match(ShiftLevel& level) {
  constexpr double kMostGain = 4, kRounding = 1e-6;
  const Moments m = moments_of(level.out, level.ref);
  const double n = static_cast<double>(level.ref.pixels()), out_mean = m.out / n, ref_mean = m.ref / n;
  const double out_variance = std::max(0.0, m.out_squares / n - out_mean * out_mean);
  const double ref_variance = std::max(0.0, m.ref_squares / n - ref_mean * ref_mean);
  const double covariance = m.products / n - out_mean * ref_mean;
  if (!(out_variance > 0 && ref_variance > 0)) return;
  const double gain = std::clamp(std::sqrt(ref_variance / out_variance), 1 / kMostGain, kMostGain);
  level.out.gain = static_cast<float>(gain), level.out.offset = static_cast<float>(ref_mean - gain * out_mean);
  const double error = gain * gain * out_variance + ref_variance - 2 * gain * covariance;
  const double mean = m.ref_absolute / n;
  differ_ = error > kRounding * mean * mean;
}

ShiftLevels::ShiftLevels(std::span<const float> out, std::span<const float> ref, int width, int height, size_t pixels) {
  constexpr int kSmallest = 24;
  constexpr float kLeast = 1e-30f;  // Its inverse is a float, too.
  const float percentile = percentile99(ref);
  if (!(percentile > kLeast)) return;
  const float scale = 0.25f / percentile;
  levels_.push_back({1, {width, height, out, scale, 1}, {width, height, ref, scale, 1}});
  match(levels_.front());
  if (!differ_) return;
  while (levels_.back().ref.pixels() > pixels &&
         std::min(levels_.back().ref.width, levels_.back().ref.height) >= 2 * kSmallest) {
    const ShiftLevel& last = levels_.back();
    ShiftLevel next{2 * last.size, {}, {}};
    for (const auto& [from, to] : {std::pair{&last.out, &next.out}, std::pair{&last.ref, &next.ref}}) {
      memory_.push_back(reduced(*from, 2));
      *to = {memory_.back().width, memory_.back().height, {}};
    }
    levels_.push_back(next);
    // Memory has moved; what it points to has not.
    levels_.back().out.numbers = memory_[memory_.size() - 2].v;
    levels_.back().ref.numbers = memory_[memory_.size() - 1].v;
  }
}

}  // namespace whit
