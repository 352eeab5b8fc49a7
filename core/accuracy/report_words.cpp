#include "core/accuracy/report_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/plain_text.h"

namespace whit {

namespace {

struct TimeUnit {
  const char* name;
  double size;
};

TimeUnit unit_of_seconds(double seconds) {
  const double s = std::abs(seconds);
  if (s == 0 || !std::isfinite(s)) return {"s", 1};
  if (s < 1e-3) return {"us", 1e-6};
  if (s < 0.1) return {"ms", 1e-3};
  if (s < 600) return {"s", 1};
  return s < 36000 ? TimeUnit{"min", 60} : TimeUnit{"h", 3600};
}

std::string ends(const Estimate& e, double size) {
  return fmt::format("[{}, {}]", three_digits(e.low / size), three_digits(e.high / size));
}

}  // namespace

std::string seconds_text(double seconds) {
  const TimeUnit unit = unit_of_seconds(seconds);
  return std::isfinite(seconds) ? three_digits(seconds / unit.size) + " " + unit.name : three_digits(seconds);
}

std::string percent_tick(double share) { return fmt::format("{:.4g} %", share * 100); }

std::string seconds_tick(double seconds) {
  const TimeUnit unit = unit_of_seconds(seconds);
  return fmt::format("{:.4g} {}", seconds / unit.size, unit.name);
}

std::string percent_interval(const Estimate& share) { return percent_text(share.value) + " " + ends(share, 0.01); }

std::string seconds_interval(const Estimate& seconds) {
  return seconds_text(seconds.value) + " " + ends(seconds, unit_of_seconds(seconds.value).size);
}

std::string seconds_range(const Estimate& seconds) {
  const TimeUnit unit = unit_of_seconds(std::max(std::abs(seconds.low), std::abs(seconds.high)));
  return ends(seconds, unit.size) + " " + unit.name;
}

std::string effect_seconds(const CostEffect& effect) {
  return effect.resolved ? seconds_interval(effect.seconds)
                         : fmt::format("not resolved {}", seconds_range(effect.seconds));
}

std::string setting_name(const CostSetting& setting) {
  if (setting.knob == "samples") return fmt::format("{} samples", setting.samples);
  return one_line(fmt::format("{} {}, {} samples", setting.knob, setting.value, setting.samples));
}

std::string reference_text(const CostReport& report) {
  return fmt::format(
      "The reference is the same integrator at its best, not reality: {} samples a pixel in two halves of "
      "different seeds ({}), which has an error of {} itself.",
      report.reference_samples, seconds_text(report.reference_seconds), percent_text(report.reference_noise));
}

std::string order_text(const CostReport& report) {
  if (!std::isfinite(report.order.value)) return "How nRMSE falls with the samples is not known";
  return fmt::format("nRMSE falls as samples^-{} [{}, {}]", three_digits(report.order.value),
                     three_digits(report.order.low), three_digits(report.order.high));
}

std::string time_text(const CostReport& report) {
  return fmt::format("{} + {} a sample", seconds_text(report.fixed_seconds), seconds_text(report.per_sample_seconds));
}

}  // namespace whit
