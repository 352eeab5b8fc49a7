#include "core/accuracy/report_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/accuracy/estimate.h"
#include "core/accuracy/report_axis.h"
#include "core/accuracy/report_words.h"
#include "core/base/plain_text.h"

namespace whit {
namespace {

constexpr int kColours = 7;  // Of the style: .k0 are samples.

bool can_be_drawn(const CostSetting& s) {
  return s.cpu_seconds.value > 0 && s.nrmse.value > 0 && std::isfinite(s.cpu_seconds.value) &&
         std::isfinite(s.nrmse.value);
}

// Knobs in the order they appear.
std::vector<std::string> knobs_of(const CostReport& report) {
  std::vector<std::string> knobs;
  for (const CostSetting& s : report.settings)
    if (std::find(knobs.begin(), knobs.end(), s.knob) == knobs.end()) knobs.push_back(s.knob);
  return knobs;
}

// Of one knob; or, where its values were measured with several numbers of samples, of one of its values.
struct Curve {
  std::string knob, value;
  int colour = 0;
  std::vector<const CostSetting*> points;
};

bool has_levels(const CostReport& report, const std::string& knob) {
  for (const CostSetting& a : report.settings)
    for (const CostSetting& b : report.settings)
      if (a.knob == knob && b.knob == knob && a.value == b.value && a.samples != b.samples) return true;
  return false;
}

std::vector<Curve> curves_of(const CostReport& report) {
  std::vector<Curve> curves;
  const std::vector<std::string> knobs = knobs_of(report);
  for (size_t k = 0; k < knobs.size(); ++k) {
    const bool by_value = knobs[k] != "samples" && has_levels(report, knobs[k]);
    const size_t first = curves.size();
    for (const CostSetting& s : report.settings) {
      if (s.knob != knobs[k] || !can_be_drawn(s)) continue;
      const std::string value = by_value ? s.value : "";
      auto at = std::find_if(curves.begin() + static_cast<ptrdiff_t>(first), curves.end(),
                             [&](const Curve& c) { return c.value == value; });
      if (at == curves.end()) at = curves.insert(at, {knobs[k], value, static_cast<int>(k) % kColours, {}});
      at->points.push_back(&s);
    }
  }
  for (Curve& curve : curves)
    std::stable_sort(curve.points.begin(), curve.points.end(), [](const CostSetting* a, const CostSetting* b) {
      return a->cpu_seconds.value < b->cpu_seconds.value;
    });
  return curves;
}

// What four times the samples of the last level are expected to give.
struct Beyond {
  double seconds = 0;
  ErrorEstimate error;
};

std::optional<Beyond> beyond_last(const CostReport& report) {
  std::vector<ErrorLevel> levels;
  for (const CostSetting& s : report.settings)
    if (s.knob == "samples" && can_be_drawn(s)) levels.push_back({s.samples, s.nrmse, s.upper95});
  std::sort(levels.begin(), levels.end(), [](auto& a, auto& b) { return a.samples < b.samples; });
  if (levels.size() < 2 || levels.back().samples > (1 << 28)) return std::nullopt;
  const int samples = 4 * levels.back().samples;
  const std::optional<ErrorEstimate> error = predict_error(fit_order(levels), samples);
  const double seconds = report.fixed_seconds + report.per_sample_seconds * samples;
  if (!error || !(error->nrmse.value > 0) || !(seconds > 0) || !std::isfinite(seconds)) return std::nullopt;
  return Beyond{seconds, *error};
}

// A mark for each knob, which tells them apart without colours.
const char* shape(int colour) {
  constexpr std::array<const char*, kColours> kShapes{"M-5 0a5 5 0 1 0 10 0a5 5 0 1 0 -10 0Z",
                                                      "M-4.5 -4.5H4.5V4.5H-4.5Z",
                                                      "M0 -6L6 0L0 6L-6 0Z",
                                                      "M0 -5.5L5.5 4.5H-5.5Z",
                                                      "M0 5.5L5.5 -4.5H-5.5Z",
                                                      "M-5 -5L0 -2L5 -5V3L0 6L-5 3Z",
                                                      "M-6 -2H-2V-6H2V-2H6V2H2V6H-2V2H-6Z"};
  return kShapes[static_cast<size_t>(colour)];
}

struct Box {
  double x0, y0, x1, y1;
  bool meets(const Box& b) const { return x0 < b.x1 && b.x0 < x1 && y0 < b.y1 && b.y0 < y1; }
};

class Chart {
 public:
  Chart(const CostReport& report, int width, int height)
      : report_(report), width_(width), height_(height), curves_(curves_of(report)), beyond_(beyond_last(report)) {
    std::vector<double> seconds, errors;
    for (const Curve& curve : curves_)
      for (const CostSetting* s : curve.points) {
        seconds.insert(seconds.end(), {s->cpu_seconds.value, s->cpu_seconds.low, s->cpu_seconds.high});
        errors.insert(errors.end(), {s->nrmse.value, s->nrmse.high});
      }
    points_ = seconds.size() / 3;
    if (beyond_) {
      seconds.push_back(beyond_->seconds);
      errors.push_back(beyond_->error.nrmse.value);
    }
    // A floor far below would take the room of the curves.
    if (!errors.empty() && report.reference_noise > 0.2 * *std::min_element(errors.begin(), errors.end()))
      errors.push_back(report.reference_noise);
    x_ = axis_over(seconds);
    y_ = axis_over(errors);
  }

  std::string svg() {
    if (points_ < 2) return "";
    out_ = fmt::format(
        "<svg class=\"chart\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"Error against CPU seconds\">\n", width_,
        height_);
    axes();
    floor();
    band();
    for (const Curve& curve : curves_) line(curve);
    for (bool pareto : {false, true})
      for (const Curve& curve : curves_)
        for (const CostSetting* s : curve.points)
          if (s->pareto == pareto) mark(curve, *s);
    labels();
    return out_ + "</svg>\n";
  }

 private:
  static constexpr double kLeft = 58, kRight = 18, kTop = 14, kBottom = 46;

  double x(double seconds) const { return kLeft + x_.place(seconds) * (width_ - kLeft - kRight); }
  double y(double error) const { return kTop + (1 - y_.place(error)) * (height_ - kTop - kBottom); }

  template <class... Args>
  void add(fmt::format_string<Args...> format, Args&&... args) {
    out_ += fmt::format(format, std::forward<Args>(args)...);
  }

  void text(double at_x, double at_y, const char* kind, const std::string& what) {
    add("<text x=\"{:.1f}\" y=\"{:.1f}\" class=\"{}\">{}</text>\n", at_x, at_y, kind, html_text(what));
  }

  void axes() {
    const double bottom = height_ - kBottom, right = width_ - kRight;
    for (double tick : x_.ticks(width_ / 70)) {
      add("<path class=\"grid\" d=\"M{:.1f} {:.1f}V{:.1f}\"/>\n", x(tick), kTop, bottom);
      text(x(tick), bottom + 17, "tick middle", seconds_tick(tick));
    }
    for (double tick : y_.ticks(height_ / 32)) {
      add("<path class=\"grid\" d=\"M{:.1f} {:.1f}H{:.1f}\"/>\n", kLeft, y(tick), right);
      text(kLeft - 7, y(tick) + 4, "tick end", percent_tick(tick));
    }
    add("<path class=\"frame\" d=\"M{:.1f} {:.1f}V{:.1f}H{:.1f}\"/>\n", kLeft, kTop, bottom, right);
    text((kLeft + right) / 2, height_ - 8, "title middle", "CPU seconds");
    add("<text transform=\"translate(13 {:.1f}) rotate(-90)\" class=\"title middle\">error (nRMSE)</text>\n",
        (kTop + bottom) / 2);
  }

  void floor() {
    if (!(report_.reference_noise > y_.low) || report_.reference_noise > y_.high) return;
    const double at = y(report_.reference_noise);
    add("<path class=\"floor\" d=\"M{:.1f} {:.1f}H{:.1f}\"/>\n", kLeft, at, width_ - kRight);
    const std::string what = "noise of the reference, " + percent_text(report_.reference_noise);
    text(kLeft + 8, at - 5, "note", what);
    taken_.push_back({kLeft, at - 16, kLeft + 8 + 6.0 * static_cast<double>(what.size()), at + 2});
  }

  // Between the ends of two places of the samples' curve.
  void strip(const char* kind, double x0, const Estimate& e0, double x1, const Estimate& e1) {
    add("<path class=\"{}\" d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}L{:.1f} {:.1f}L{:.1f} {:.1f}Z\"/>\n", kind, x(x0),
        y(e0.high), x(x1), y(e1.high), x(x1), y(e1.low), x(x0), y(e0.low));
  }

  void band() {
    const auto samples = std::find_if(curves_.begin(), curves_.end(), [](auto& c) { return c.knob == "samples"; });
    if (samples == curves_.end()) return;
    const auto& points = samples->points;
    for (size_t i = 1; i < points.size(); ++i)
      strip("band k0", points[i - 1]->cpu_seconds.value, points[i - 1]->nrmse, points[i]->cpu_seconds.value,
            points[i]->nrmse);
    if (!beyond_) return;
    const CostSetting& last = *points.back();
    strip("band guess k0", last.cpu_seconds.value, last.nrmse, beyond_->seconds, beyond_->error.nrmse);
    add("<path class=\"line guess k0\" d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\"><title>{}</title></path>\n",
        x(last.cpu_seconds.value), y(last.nrmse.value), x(beyond_->seconds), y(beyond_->error.nrmse.value),
        html_text(fmt::format("{} samples, extrapolated: {} in about {}", 4 * int64_t{last.samples},
                              percent_interval(beyond_->error.nrmse), seconds_text(beyond_->seconds))));
    const std::string what = std::to_string(4 * int64_t{last.samples});
    const double end = x(beyond_->seconds), at = y(beyond_->error.nrmse.value) + 18;
    text(end, at, "note end", what);
    taken_.push_back({end - 7.0 * static_cast<double>(what.size()), at - 12, end, at + 2});
  }

  void line(const Curve& curve) {
    if (curve.points.size() < 2) return;
    std::string path;
    for (const CostSetting* s : curve.points)
      path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", x(s->cpu_seconds.value), y(s->nrmse.value));
    add("<path class=\"line k{}\" d=\"{}\"/>\n", curve.colour, path);
  }

  void mark(const Curve& curve, const CostSetting& s) {
    const double cx = x(s.cpu_seconds.value), cy = y(s.nrmse.value);
    add("<g class=\"point k{}{}\"><title>{}</title>\n", curve.colour, s.pareto ? " pareto" : " beaten",
        html_text(fmt::format("{}: {} in {} CPU{}", setting_name(s), percent_interval(s.nrmse),
                              seconds_interval(s.cpu_seconds), s.pareto ? "" : "; another is faster and nearer")));
    add("<path class=\"bar\" d=\"M{:.1f} {:.1f}V{:.1f}M{:.1f} {:.1f}H{:.1f}\"/>\n", cx, y(s.nrmse.high), y(s.nrmse.low),
        x(s.cpu_seconds.low), cy, x(s.cpu_seconds.high));
    add("<path class=\"mark\" transform=\"translate({:.1f} {:.1f})\" d=\"{}\"/></g>\n", cx, cy, shape(curve.colour));
    taken_.push_back({cx - 6, cy - 6, cx + 6, cy + 6});
  }

  // Beside the mark where nothing else is; a label without room is left to the table.
  void labels() {
    for (bool pareto : {true, false})
      for (const Curve& curve : curves_)
        for (const CostSetting* s : curve.points)
          if (s->pareto == pareto) label(curve, *s);
  }

  // What tells it from the rest of its curve, and at the curve's start what it is a curve of.
  static std::string label_of(const Curve& curve, const CostSetting& s) {
    if (curve.knob == "samples") return std::to_string(s.samples);
    if (curve.value.empty()) return one_line(s.value);
    return curve.points.front() == &s ? one_line(fmt::format("{} {}", s.value, s.samples)) : std::to_string(s.samples);
  }

  void label(const Curve& curve, const CostSetting& s) {
    const std::string what = label_of(curve, s);
    const double cx = x(s.cpu_seconds.value), cy = y(s.nrmse.value), w = 6.4 * static_cast<double>(what.size()) + 2;
    const Box places[] = {{cx + 8, cy - 15, cx + 8 + w, cy - 1},
                          {cx - 8 - w, cy + 2, cx - 8, cy + 16},
                          {cx + 8, cy + 2, cx + 8 + w, cy + 16},
                          {cx - 8 - w, cy - 15, cx - 8, cy - 1}};
    for (const Box& place : places) {
      const bool inside = place.x0 > kLeft && place.x1 < width_ - 2 && place.y0 > 0 && place.y1 < height_ - kBottom;
      if (!inside || std::any_of(taken_.begin(), taken_.end(), [&](const Box& b) { return b.meets(place); })) continue;
      taken_.push_back(place);
      add("<text x=\"{:.1f}\" y=\"{:.1f}\" class=\"name k{}{}\">{}</text>\n", place.x0 + 1, place.y1 - 3, curve.colour,
          s.pareto ? "" : " beaten", html_text(what));
      return;
    }
  }

  const CostReport& report_;
  int width_, height_;
  std::vector<Curve> curves_;
  std::optional<Beyond> beyond_;
  size_t points_ = 0;
  LogAxis x_, y_;
  std::vector<Box> taken_;
  std::string out_;
};

}  // namespace

std::string error_chart(const CostReport& report, int width, int height) { return Chart(report, width, height).svg(); }

std::string error_legend(const CostReport& report) {
  std::string out = "<ul class=\"legend\">\n";
  const std::vector<std::string> knobs = knobs_of(report);
  const auto sign = [](const std::string& kind, const char* mark) {
    return fmt::format("<svg viewBox=\"-8 -8 16 16\"><g class=\"point {}\"><path class=\"mark\" d=\"{}\"/></g></svg>",
                       kind, mark);
  };
  for (size_t k = 0; k < knobs.size(); ++k) {
    const int colour = static_cast<int>(k) % kColours;
    out += fmt::format("<li>{}{}</li>\n", sign(fmt::format("k{} pareto", colour), shape(colour)),
                       html_text(knobs[k] == "samples" ? "samples per pixel" : knobs[k]));
  }
  return out + fmt::format("<li>{}grey: something measured is both faster and nearer</li>\n</ul>\n",
                           sign("beaten", shape(0)));
}

std::string effect_bar(const CostReport& report, const CostEffect& effect) {
  double low = 0, high = 0;
  for (const CostEffect& e : report.effects) {
    if (std::isfinite(e.seconds.low)) low = std::min(low, e.seconds.low);
    if (std::isfinite(e.seconds.high)) high = std::max(high, e.seconds.high);
  }
  if (!(high > low) || !std::isfinite(effect.seconds.low) || !std::isfinite(effect.seconds.high)) return "";
  const auto x = [&](double seconds) { return 4 + (seconds - low) / (high - low) * 152; };
  const Estimate& s = effect.seconds;
  std::string out = "<svg class=\"effect-bar\" viewBox=\"0 0 160 22\" aria-hidden=\"true\">";
  if (effect.resolved)
    out += fmt::format("<rect class=\"amount\" x=\"{:.1f}\" y=\"6\" width=\"{:.1f}\" height=\"10\"/>",
                       x(std::min(0.0, s.value)), std::abs(x(s.value) - x(0)));
  return out + fmt::format(
                   "<path class=\"zero\" d=\"M{:.1f} 1V21\"/><path class=\"whisker\" d=\"M{:.1f} 7V15M{:.1f} "
                   "11H{:.1f}M{:.1f} 7V15\"/></svg>",
                   x(0), x(s.low), x(s.low), x(s.high), x(s.high));
}

}  // namespace whit
