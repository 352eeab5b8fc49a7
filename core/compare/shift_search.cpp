#include "core/compare/shift_search.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace whit {
namespace {

struct Sums {
  double with = 0, without = 0;
};

Sums errors_of(const ShiftPlane& out, const ShiftPlane& ref, Vec2i by) {
  Sums sums;
  const int x0 = std::max(0, by.x), x1 = out.width + std::min(0, by.x);
  const int y0 = std::max(0, by.y), y1 = out.height + std::min(0, by.y);
  for (int y = y0; y < y1; ++y) {
    const float *o = out.row(y), *unshifted = ref.row(y), *shifted = ref.row(y - by.y) - by.x;
    float with = 0, without = 0;
#pragma omp simd reduction(+ : with, without)
    for (int x = x0; x < x1; ++x) {
      with += (o[x] - shifted[x]) * (o[x] - shifted[x]);
      without += (o[x] - unshifted[x]) * (o[x] - unshifted[x]);
    }
    sums.with += double{with}, sums.without += double{without};
  }
  return sums;
}

double length2(Vec2i v) { return static_cast<double>(v.x) * v.x + static_cast<double>(v.y) * v.y; }

}  // namespace

ShiftMap::ShiftMap(const std::vector<std::pair<ShiftPlane, ShiftPlane>>& parts, Vec2i reach) : reach_(reach) {
  const size_t count = static_cast<size_t>(2 * reach.x + 1) * static_cast<size_t>(2 * reach.y + 1);
  std::vector<double> gain(count), without(count);
  left_.resize(count);
  tbb::parallel_for(size_t{0}, count, [&](size_t i) {
    Sums sums;
    for (const auto& [out, ref] : parts) {
      const Sums part = errors_of(out, ref, by_of(i));
      sums.with += part.with, sums.without += part.without;
    }
    left_[i] = sums.without > 0 ? sums.with / sums.without : 1;
    gain[i] = sums.without - sums.with;
    without[i] = sums.without;
  });
  // What leaves out most of what differs explains nothing.
  for (size_t i = 0; i < count; ++i)
    if (without[i] < 0.5 * without[index(Vec2i(0))]) left_[i] = std::max(left_[i], 1.0);
  const size_t most = static_cast<size_t>(std::max_element(gain.begin(), gain.end()) - gain.begin());
  best_ = by_of(most);
  const std::vector<bool> as_good = around(best_, left_[most] + 0.02 * (1 - left_[most]));
  for (size_t i = 0; i < count; ++i)
    if (as_good[i] && length2(by_of(i)) < length2(best_)) best_ = by_of(i);
}

size_t ShiftMap::index(Vec2i by) const {
  return static_cast<size_t>((by.y + reach_.y) * (2 * reach_.x + 1) + by.x + reach_.x);
}

Vec2i ShiftMap::by_of(size_t index) const {
  const int i = static_cast<int>(index), width = 2 * reach_.x + 1;
  return {i % width - reach_.x, i / width - reach_.y};
}

// Those that leave at most so much and are joined to `by` by others that do.
std::vector<bool> ShiftMap::around(Vec2i by, double most) const {
  std::vector<bool> seen(left_.size());
  std::vector<Vec2i> next{by};
  seen[index(by)] = true;
  while (!next.empty()) {
    const Vec2i at = next.back();
    next.pop_back();
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const Vec2i to = at + Vec2i(dx, dy);
        if (std::abs(to.x) > reach_.x || std::abs(to.y) > reach_.y || seen[index(to)] || left_[index(to)] > most)
          continue;
        seen[index(to)] = true;
        next.push_back(to);
      }
  }
  return seen;
}

bool ShiftMap::ambiguous(Vec2i by) const {
  if (std::abs(by.x) > reach_.x || std::abs(by.y) > reach_.y) return false;
  std::vector<double> sorted = left_;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  // Of all that are next to it the best counts: what is between pixels is seen from either side.
  const double here = left_[index(by)], usual = std::max(*middle, here);
  const std::vector<bool> its_own = around(by, here + 0.5 * (usual - here));
  for (size_t i = 0; i < left_.size(); ++i)
    if (!its_own[i] && left_[i] < here + 0.2 * (usual - here)) return true;
  return false;
}

}  // namespace whit
