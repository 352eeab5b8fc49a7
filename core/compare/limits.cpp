#include "core/compare/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/diagnostics.h"
#include "core/compare/layer_measures.h"
#include "core/compare/measures.h"

namespace whit {
namespace {

std::string unknown_measure(const std::string& name, bool below) {
  std::string known;
  for (const std::string& one : measure_names(below)) known.append(known.empty() ? "" : ", ").append(one);
  const std::string near = nearest_name(name, measure_names(below));
  return fmt::format("there is no measure \"{}\"{}; there are {}", name,
                     near.empty() ? "" : fmt::format(", did you mean {}?", near), known);
}

void judge_measures(const Limits& limits, Comparison& c) {
  for (Measured& m : c.measured) {
    const MeasureRow& row = *find_measure(m.measure);
    const std::optional<double> limit = m.limit = limit_of(row, limits);
    if (!limit) continue;
    const double value = deviation(m);
    if (row.falls ? !(value >= *limit) : !(value <= *limit))
      c.failed.push_back({m.measure, m.layer, value, *limit, m.channel, m.at, m.words});
  }
}

void judge_hard_fail(const Limits& limits, Comparison& c) {
  if (!limits.hard_fail) return;
  for (const Measured& m : c.measured)
    if (m.measure == "max" && !(m.value <= *limits.hard_fail))
      c.failed.push_back({"hard-fail", m.layer, m.value, *limits.hard_fail, m.channel, m.at, ""});
}

// Share of the pixels with a channel that is off by more, and the first of them.
struct PixelsOff {
  double share = 0;
  std::optional<Vec2i> first;
};
PixelsOff pixels_off(const PicturePair& pair, double by) {
  std::vector<uint8_t> off(pair.pixels());
  for (const ComparedLayer& layer : pair.layers)
    for (const size_t c : layer.channels) {
      const ComparedChannel& channel = pair.channels[c];
      for (size_t i = 0; i < off.size(); ++i) {
        const float a = channel.a[i], b = channel.b[i];
        off[i] |= static_cast<uint8_t>(!equal_numbers(a, b) && !(std::abs(double{a} - double{b}) <= by));
      }
    }
  const auto first = std::find(off.begin(), off.end(), 1);
  PixelsOff result;
  result.share = static_cast<double>(std::count(first, off.end(), 1)) / static_cast<double>(off.size());
  if (first != off.end()) result.first = pair.place(static_cast<size_t>(first - off.begin()));
  return result;
}

void judge_pixels(const PicturePair& pair, const Limits& limits, Comparison& c) {
  if (!limits.fail_pixels) return;
  const PixelsOff off = pixels_off(pair, limits.pixel_error);
  if (!(off.share <= *limits.fail_pixels))
    c.failed.push_back({"fail-pixels", "", off.share, *limits.fail_pixels, "", off.first, ""});
}

void judge_exact(const PicturePair& pair, Comparison& c) {
  if (!pair.cropped && c.a_window != c.b_window)
    c.failed.push_back({"exact", "", 1, 0, "", {}, "one has pixels where the other has none"});
  for (const Measured& m : c.measured)
    if (m.measure == "pixels" && m.value > 0) c.failed.push_back({"exact", m.layer, m.value, 0, m.channel, m.at, ""});
}

// What is mirrored or goes half a pixel is no noise, even where noise hides it from the test.
void judge_displacement(Comparison& c) {
  constexpr double kHalf = 0.5;
  for (const Measured& m : c.measured)
    if (m.measure == "shift" && m.value >= kHalf && !m.limit)
      c.failed.push_back({m.measure, m.layer, m.value, kHalf, m.channel, m.at, m.words});
}

void judge_noise(Comparison& c) {
  if (c.noise) judge_displacement(c);
  if (!c.noise || c.noise->same) return;
  Failure failure{"noise", "", c.noise->p, c.noise->alpha, "", {}, ""};
  if (!c.noise->regions.empty()) {
    const NoiseRegion& first = c.noise->regions.front();
    failure.channel = first.channel;
    failure.at = first.box.min;
  }
  c.failed.push_back(failure);
}

void judge_nonfinite(const Limits& limits, Comparison& c) {
  if (limits.allow_nonfinite || c.nonfinite_count == 0) return;
  const NonFinite& first = c.nonfinite.front();
  c.failed.push_back({"nonfinite", "", static_cast<double>(c.nonfinite_count), 0, first.channel, first.at,
                      fmt::format("{} in {}", first.value, first.side == Side::A ? c.a_path : c.b_path)});
}

}  // namespace

std::optional<double> limit_of(const MeasureRow& row, const Limits& limits) {
  const auto own = limits.of.find(row.name);
  if (own != limits.of.end()) return own->second;
  // Noise changes no ids; what is displaced differs by more than noise.
  return limits.noise && std::string(row.name) != "mismatch" ? std::nullopt : row.limit;
}

std::string add_limit(const std::string& text, bool below, Limits& limits) {
  const size_t equals = text.find('=');
  const std::string name = text.substr(0, equals);
  const MeasureRow* row = find_measure(name);
  if (!row) return unknown_measure(name, below);
  if (row->falls != below)
    return fmt::format("{} {} as pictures differ: use --fail-{}", name, row->falls ? "falls" : "rises",
                       row->falls ? "below" : "above");
  if (equals == std::string::npos)
    return fmt::format("\"{}\" needs a value, as in {}={}", text, name, row->limit.value_or(1));
  const std::string number = text.substr(equals + 1);
  char* end = nullptr;
  const double value = std::strtod(number.c_str(), &end);
  if (number.empty() || *end != '\0' || std::isnan(value) || (value < 0 && !below))
    return fmt::format("\"{}\": the limit of {} must be a number{} ({}inf switches it off)", text, name,
                       below ? "" : " that is not below 0", below ? "-" : "");
  limits.of[name] = value;
  return "";
}

void judge(const PicturePair& pair, const Limits& limits, Comparison& comparison) {
  comparison.failed.clear();
  if (limits.exact) {
    judge_exact(pair, comparison);
  } else {
    judge_measures(limits, comparison);
    judge_hard_fail(limits, comparison);
    judge_pixels(pair, limits, comparison);
    judge_noise(comparison);
  }
  std::stable_sort(comparison.failed.begin(), comparison.failed.end(),
                   [](const Failure& l, const Failure& r) { return times_over(l) > times_over(r); });
  const auto others = std::exchange(comparison.failed, {});
  judge_nonfinite(limits, comparison);
  comparison.failed.insert(comparison.failed.end(), others.begin(), others.end());
}

}  // namespace whit
