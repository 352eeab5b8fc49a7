// The report as a table: a row for each setting and each effect (RFC 4180).
#include <fmt/format.h>

#include <cmath>

#include "core/accuracy/report.h"

namespace whit {
namespace {

constexpr const char* kHeader =
    "kind,name,value,samples,command,seconds,seconds_low,seconds_high,cpu_seconds,cpu_seconds_low,cpu_seconds_high,"
    "nrmse,nrmse_low,nrmse_high,nrmse_upper95,bias,bias_low,bias_high,relmse,flip,share_2_255,quantile95,pareto,"
    "resolved,mean_change,pixels_changed\n";

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

// Enough digits to be read back; nothing where there is no number.
std::string number(double value) { return std::isfinite(value) ? fmt::format("{:.9g}", value) : std::string(); }

std::string three(const Estimate& e) { return fmt::format("{},{},{}", number(e.value), number(e.low), number(e.high)); }

std::string setting_row(const CostSetting& s) {
  return fmt::format("setting,{},{},{},{},{},{},{},{},{},{},{},{},{},{},,,\n", quoted(s.knob), quoted(s.value),
                     s.samples, quoted(s.command), three(s.seconds), three(s.cpu_seconds), three(s.nrmse),
                     number(s.upper95), s.bias ? three(*s.bias) : ",,", number(s.relmse), number(s.flip),
                     number(s.share_2_255), number(s.quantile95), s.pareto ? 1 : 0);
}

std::string effect_row(const CostEffect& e) {
  return fmt::format("effect,{},,,{},{},{},,,,,,,,,,,,,{},{},{}\n", quoted(e.name), quoted(e.command),
                     three(e.wall_seconds), three(e.seconds), e.resolved ? 1 : 0, number(e.mean_change),
                     number(e.pixels_changed));
}

}  // namespace

std::string cost_csv(const CostReport& report) {
  std::string out = kHeader;
  for (const CostSetting& setting : report.settings) out += setting_row(setting);
  for (const CostEffect& effect : report.effects) out += effect_row(effect);
  return out;
}

}  // namespace whit
