#include "core/accuracy/report_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace whit {

std::string three_digits(double value) {
  if (!std::isfinite(value)) return "unknown";
  if (value == 0) return "0";
  // Rounding first: 9.996 is 10.0, not 10.00.
  const double scale = std::pow(10.0, 2 - std::floor(std::log10(std::abs(value))));
  const double rounded = std::round(value * scale) / scale;
  const int decimals = std::max(0, 2 - static_cast<int>(std::floor(std::log10(std::abs(rounded)) + 1e-9)));
  return fmt::format("{:.{}f}", rounded, decimals);
}

std::string percent_text(double share) {
  return std::isfinite(share) ? three_digits(share * 100) + " %" : three_digits(share);
}

std::string signed_percent_text(double share) { return fmt::format("{}{}", share > 0 ? "+" : "", percent_text(share)); }

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

namespace {

// How many bytes the UTF-8 character at the start of the text has; 0 where there is none.
size_t character_length(std::string_view text) {
  const auto byte = [&](size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  if (first < 0x80) return 1;
  const size_t length = first >= 0xf5 ? 0 : first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : first >= 0xc2 ? 2 : 0;
  if (length == 0 || length > text.size()) return 0;
  for (size_t i = 1; i < length; ++i)
    if ((byte(i) & 0xc0) != 0x80) return 0;
  // Characters spelt longer than needed, halves of surrogate pairs, and what is beyond Unicode.
  if ((first == 0xe0 && byte(1) < 0xa0) || (first == 0xed && byte(1) > 0x9f)) return 0;
  if ((first == 0xf0 && byte(1) < 0x90) || (first == 0xf4 && byte(1) > 0x8f)) return 0;
  return length;
}

std::string_view escaped(std::string_view character) {
  if (character == "<") return "&lt;";
  if (character == ">") return "&gt;";
  if (character == "&") return "&amp;";
  if (character == "\"") return "&quot;";
  if (character == "'") return "&#39;";
  return character;
}

// The text, each character of it as `of` says.
template <class Of>
std::string each_character(std::string_view text, const Of& of) {
  std::string out;
  for (std::string_view rest = text; !rest.empty();) {
    const size_t length = character_length(rest);
    out += length == 0 ? std::string_view("?") : of(rest.substr(0, length));
    rest.remove_prefix(std::max<size_t>(1, length));
  }
  return out;
}

// Below a space, "delete", and U+0080 to U+009F, which terminals obey too.
bool is_control(std::string_view character) {
  const auto byte = [&](size_t i) { return static_cast<unsigned char>(character[i]); };
  return byte(0) < 0x20 || byte(0) == 0x7f || (byte(0) == 0xc2 && byte(1) < 0xa0);
}

}  // namespace

std::string one_line(std::string_view text) {
  return each_character(text, [](std::string_view c) { return is_control(c) ? std::string_view(" ") : c; });
}

std::string html_text(std::string_view text) { return each_character(one_line(text), escaped); }

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
