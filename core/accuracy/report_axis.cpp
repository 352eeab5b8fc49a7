#include "core/accuracy/report_axis.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace whit {
namespace {

constexpr double kRoom = 0.06;       // Of the axis, at either end.
constexpr double kLeastRatio = 1.5;  // Of its ends, where all values are alike.
constexpr double kRounding = 1e-9;   // A tick at the very end is on the axis.

std::vector<double> ticks_at(const LogAxis& axis, const std::vector<double>& digits, int step) {
  std::vector<double> out;
  const int first = static_cast<int>(std::floor(std::log10(axis.low)));
  const int last = static_cast<int>(std::floor(std::log10(axis.high)));
  for (int power = first; power <= last; ++power) {
    if (power % step != 0) continue;
    for (double digit : digits) {
      const double tick = digit * std::pow(10.0, power);
      if (tick >= axis.low * (1 - kRounding) && tick <= axis.high * (1 + kRounding)) out.push_back(tick);
    }
  }
  return out;
}

}  // namespace

double LogAxis::place(double value) const {
  if (!(value > low)) return 0;
  return std::min(1.0, std::log(value / low) / std::log(high / low));
}

std::vector<double> LogAxis::ticks(int most) const {
  const auto fits = [&](const std::vector<double>& t) { return static_cast<int>(t.size()) <= most; };
  if (auto t = ticks_at(*this, {1, 2, 5}, 1); fits(t)) return t;
  for (int step = 1;; ++step)
    if (auto t = ticks_at(*this, {1}, step); fits(t)) return t;
}

LogAxis axis_over(const std::vector<double>& values) {
  double low = std::numeric_limits<double>::infinity(), high = 0;
  for (double v : values) {
    if (!(v > 0) || !std::isfinite(v)) continue;
    low = std::min(low, v);
    high = std::max(high, v);
  }
  if (high == 0) return {};
  const double wanting = std::max(1.0, std::sqrt(kLeastRatio * low / high));
  const double room = std::pow(high * wanting * wanting / low, kRoom);
  return {low / wanting / room, high * wanting * room};
}

}  // namespace whit
