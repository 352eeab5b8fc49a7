#include "core/compare/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/compare/measures.h"
#include "core/compare/number_words.h"

namespace whit {
namespace {

// Whether a channel's name has its layer's in it, as most have.
bool names_layer(const std::string& channel, const std::string& layer) {
  return channel == layer || channel.rfind(layer + ".", 0) == 0;
}

// Displaced by more than a distance: mirrored, flipped, turned or transposed, as its words say.
bool is_turned(const Failure& f) { return f.measure == "shift" && std::isinf(f.value); }

std::string place_text(const Failure& f) {
  std::string text;
  if (!f.layer.empty() && !names_layer(f.channel, f.layer)) text.append(" in layer ").append(f.layer);
  if (!f.channel.empty()) text.append(" in ").append(f.channel);
  if (f.at) text.append(fmt::format(" at ({}, {})", f.at->x, f.at->y));
  return f.words.empty() || is_turned(f) ? text : text + " (" + f.words + ")";
}

std::string nonfinite_text(double count) {
  return count == 1 ? "a number is NaN or infinite"
                    : fmt::format("{:.0f} numbers are NaN or infinite, the first", count);
}

// What happened, without where.
std::string what_text(const Failure& f) {
  const std::string name = f.measure;
  if (name == "nonfinite") return nonfinite_text(f.value);
  if (name == "exact") return fmt::format("{} of the pixels are not equal, the first", short_percent_text(f.value));
  if (name == "hard-fail") return fmt::format("a pixel is off by {:.4g}, more than {:.4g},", f.value, f.limit);
  if (name == "fail-pixels")
    return fmt::format("{} of the pixels are off, more than {}, the first", short_percent_text(f.value),
                       short_percent_text(f.limit));
  if (name == "noise") return fmt::format("they differ by more than noise ({}, below {:g})", p_text(f.value), f.limit);
  if (is_turned(f)) return "the picture is " + f.words;
  if (name == "ratio")
    return fmt::format("the mean is off by {}, more than {},", short_percent_text(f.value),
                       short_percent_text(f.limit));
  const MeasureRow* row = find_measure(name);
  return fmt::format("{} {:.4g} is {} {:.4g}", name, f.value, row && row->falls ? "below" : "above", f.limit);
}

}  // namespace

const Measured* Comparison::find(const std::string& measure, const std::string& layer) const {
  const auto found = std::find_if(measured.begin(), measured.end(),
                                  [&](const Measured& m) { return m.measure == measure && m.layer == layer; });
  return found == measured.end() ? nullptr : &*found;
}

const Failure* Comparison::failure_of(const Measured& m) const {
  const auto found = std::find_if(failed.begin(), failed.end(),
                                  [&](const Failure& f) { return f.measure == m.measure && f.layer == m.layer; });
  return found == failed.end() ? nullptr : &*found;
}

double deviation(const Measured& m) { return m.measure == "ratio" ? std::abs(m.value - 1) : m.value; }

std::string p_text(double p) { return p > 0 ? fmt::format("p = {:.2g}", p) : "p < 1e-300"; }

double times_over(const Failure& failure) {
  constexpr double kMost = std::numeric_limits<double>::max();
  const MeasureRow* row = find_measure(failure.measure);
  const bool falls = failure.measure == "noise" || (row && row->falls);
  const double over = falls ? failure.limit / failure.value : failure.value / failure.limit;
  return std::isfinite(over) ? std::max(1.0, over) : kMost;
}

double badness(const Comparison& comparison) {
  constexpr double kMost = std::numeric_limits<double>::infinity();
  if (!comparison.cannot.empty()) return kMost;
  double worst = 0;
  for (const Failure& f : comparison.failed) worst = std::max(worst, times_over(f));
  if (worst > 0) return worst;
  // Among those that passed, by how near a default they came.
  for (const Measured& m : comparison.measured) {
    const MeasureRow* row = find_measure(m.measure);
    if (!row->limit) continue;
    worst = std::max(worst, std::min(1.0, deviation(m) / *row->limit));
  }
  return worst;
}

std::string failure_text(const Failure& failure) { return what_text(failure) + place_text(failure); }

std::string verdict_text(const Comparison& c) {
  if (!c.cannot.empty()) return "cannot compare: " + c.cannot;
  if (!c.failed.empty()) {
    std::string text = "differs: " + failure_text(c.failed.front());
    if (c.failed.size() > 1) text.append(fmt::format("; {} more", c.failed.size() - 1));
    return text;
  }
  if (c.differing_pixels == 0) return "same: every number is equal";
  if (c.noise) return fmt::format("same within the noise ({})", p_text(c.noise->p));
  const bool one = c.differing_pixels == 1;
  return fmt::format("same: {} within the limits",
                     one ? "a pixel differs" : fmt::format("{} pixels differ", c.differing_pixels));
}

}  // namespace whit
