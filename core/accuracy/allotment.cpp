#include "core/accuracy/allotment.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

namespace whit {
namespace {

constexpr double kWorthDoubling = 1.4;
constexpr uint32_t kMostTimes = 32;

size_t doublings(uint32_t samples) { return samples > 0 ? static_cast<size_t>(std::bit_width(samples)) - 1 : 0; }

/// Calls body(channels' variances together) for the pixels of a unit's tile that are known, of its colour or of all.
template <class Body>
void each_variance(const FilmRender::Unit& unit, std::span<const float> variance, const Box2i& window, bool own,
                   const Body& body) {
  const auto width = static_cast<size_t>(window.max.x - window.min.x);
  for (int y = std::max(unit.pixels.min.y, window.min.y); y < std::min(unit.pixels.max.y, window.max.y); ++y) {
    for (int x = std::max(unit.pixels.min.x, window.min.x); x < std::min(unit.pixels.max.x, window.max.x); ++x) {
      if (own && !unit.holds(x, y)) continue;
      const size_t p = static_cast<size_t>(y - window.min.y) * width + static_cast<size_t>(x - window.min.x);
      const double v = double{variance[3 * p]} + double{variance[3 * p + 1]} + double{variance[3 * p + 2]};
      if (std::isfinite(v)) body(v);
    }
  }
}

}  // namespace

std::vector<double> allot(std::span<const Allotment> parts, double sum, double most) {
  std::vector<double> n(parts.size());
  const auto at = [&](double scale) {
    double total = 0;
    for (size_t k = 0; k < parts.size(); ++k) {
      const Allotment& p = parts[k];
      const double root = p.area > 0 ? std::sqrt(p.variance / p.area) : 0.0;
      n[k] = std::clamp(scale * root, static_cast<double>(p.samples), std::max(most, static_cast<double>(p.samples)));
      if (p.variance > 0) total += p.variance / n[k];
    }
    return total;
  };
  // The sum falls as the scale grows: halve the interval of its logarithm, over all that is possible.
  double low = -300, high = 300;
  for (int step = 0; step < 60; ++step) {
    const double middle = 0.5 * (low + high);
    (at(std::exp2(middle)) > sum ? low : high) = middle;
  }
  at(std::exp2(high));
  return n;
}

std::vector<size_t> by_need(std::span<const Allotment> parts) {
  std::vector<size_t> order(parts.size());
  std::iota(order.begin(), order.end(), size_t{0});
  const auto need = [&](size_t u) {
    const double n = parts[u].samples;
    return parts[u].area > 0 ? parts[u].variance / (parts[u].area * n * n) : 0.0;
  };
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return need(a) > need(b); });
  return order;
}

std::vector<uint32_t> next_samples(std::span<const Allotment> parts, double sum, uint32_t most, uint32_t follow) {
  const std::vector<double> ideal = allot(parts, sum, most);
  const auto twice = [&](size_t k) { return std::max(parts[k].samples, std::min(2 * parts[k].samples, most)); };
  std::vector<uint32_t> want(parts.size());
  double now = 0;
  bool any = false;
  for (size_t k = 0; k < parts.size(); ++k) {
    want[k] = ideal[k] >= kWorthDoubling * parts[k].samples ? twice(k) : parts[k].samples;
    any |= want[k] > parts[k].samples;
    now += parts[k].variance / std::max(parts[k].samples, 1u);
  }
  if (!any) {
    for (const size_t k : by_need(parts)) {
      if (now <= sum || parts[k].variance == 0) break;
      want[k] = twice(k);
      now -= parts[k].variance / parts[k].samples - parts[k].variance / want[k];
    }
  }
  const uint32_t least = std::min(*std::max_element(want.begin(), want.end()) / kMostTimes, follow);
  for (size_t k = 0; k < want.size(); ++k) {
    if (want[k] < least) want[k] = twice(k);
  }
  return want;
}

UnitNoise::UnitNoise(std::span<const FilmRender::Unit> units) : known_(units.size()) {
  for (const FilmRender::Unit& u : units) areas_.push_back(static_cast<double>(u.area()));
}

void UnitNoise::look(const FilmRender& film, std::span<const FilmRender::Unit> units, std::span<const float> variance,
                     const Box2i& window, int reach) {
  for (int colour = 0; colour < 2; ++colour) {
    // Where filters reach out, pixels mix both colours: only the samples of one are looked at, in all pixels they reach.
    const std::vector<float> of_colour = reach > 0 ? film.variance(colour) : std::vector<float>();
    for (size_t u = static_cast<size_t>(colour); u < units.size(); u += 2) {
      double sum = 0, squares = 0, n = 0;
      each_variance(units[u], reach > 0 ? of_colour : variance, window, reach == 0,
                    [&](double v) { sum += v, squares += v * v, n += 1; });
      Noise noise;
      const double samples = units[u].samples, mean = n > 0 ? sum / n : 0.0;
      noise.variance = mean * samples;
      if (n > 1) noise.error2 = std::max(0.0, squares / n - mean * mean) / (n - 1) * samples * samples;
      std::vector<Noise>& known = known_[u];
      known.resize(std::max(known.size(), doublings(units[u].samples) + 1), noise);
      known[doublings(units[u].samples)] = noise;
    }
  }
}

void UnitNoise::save(ByteWriter& out) const {
  for (const std::vector<Noise>& unit : known_) out.list(std::span(unit));
}

void UnitNoise::restore(ByteReader& in) {
  for (std::vector<Noise>& unit : known_) unit = in.list<Noise>();
}

std::vector<Allotment> UnitNoise::allotments(std::span<const FilmRender::Unit> units) const {
  std::vector<Noise> noise(units.size());
  double area = 0, mean = 0, square = 0, error2 = 0;
  for (size_t u = 0; u < units.size(); ++u) {
    const size_t partner = u ^ 1;
    noise[u] = known_[partner][std::min(doublings(units[u].samples), doublings(units[partner].samples))];
    area += areas_[u], mean += areas_[u] * noise[u].variance;
    square += areas_[u] * noise[u].variance * noise[u].variance, error2 += areas_[u] * noise[u].error2;
  }
  mean /= area;
  const double between = std::max(0.0, square / area - mean * mean - error2 / area);
  std::vector<Allotment> parts(units.size());
  for (size_t u = 0; u < units.size(); ++u) {
    const double own = noise[u].error2, all = between + own;
    const double kept = all > 0 ? between / all : 1.0;
    parts[u] = {areas_[u], areas_[u] * (mean + kept * (noise[u].variance - mean)), units[u].samples};
  }
  return parts;
}

}  // namespace whit
