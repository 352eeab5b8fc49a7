// Numbers and names as the report's forms write them.
#pragma once

#include <string>

#include "core/accuracy/cost.h"
#include "core/compare/number_words.h"

namespace whit {

/// "31.2 ms", "14.0 s", "12.5 min", "3.20 h".
std::string seconds_text(double seconds);

/// At the ticks of an axis: "20 %", "0.5 s".
std::string percent_tick(double share);
std::string seconds_tick(double seconds);

/// "0.940 % [0.810, 1.00]": the ends in the unit of the value.
std::string percent_interval(const Estimate& share);
/// Likewise "14.0 s [12.0, 17.0]".
std::string seconds_interval(const Estimate& seconds);
/// The interval alone, "[-0.100, 0.300] s".
std::string seconds_range(const Estimate& seconds);

/// What an effect takes: "1.20 s [1.10, 1.30]", or "not resolved [-0.100, 0.300] s" where the interval holds zero.
std::string effect_seconds(const CostEffect& effect);

/// "64 samples", "sampler random, 64 samples".
std::string setting_name(const CostSetting& setting);

/// The first line of every form: what the reference is.
std::string reference_text(const CostReport& report);

/// "nRMSE falls as samples^-0.620 [0.580, 0.660]", or that it is not known.
std::string order_text(const CostReport& report);

/// "0.120 s + 31.2 ms a sample".
std::string time_text(const CostReport& report);

}  // namespace whit
