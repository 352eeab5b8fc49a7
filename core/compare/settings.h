// What somebody said of how to compare: a command line, a rule of a policy. What was not said is absent, so that one can
// be laid over the other.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "core/compare/compare.h"

namespace whit {

/// What may be said of the share of pairs alike that are called different.
inline constexpr double kLeastAlpha = 1e-12, kMostAlpha = 0.5;

struct CompareSettings {
  std::map<std::string, double> limits;  ///< By measure; infinity switches it off, minus infinity where lower is worse.
  std::optional<double> hard_fail, fail_pixels, pixel_error;
  std::optional<bool> exact, allow_nonfinite, noise;
  std::optional<double> alpha;
  std::optional<std::string> channels, colour_space;
  std::optional<std::string> skip;  ///< Why the picture is left out; "" takes that back.

  /// True where it asks for something to be measured.
  bool limits_anything() const { return !limits.empty() || hard_fail || fail_pixels || noise.value_or(false); }
  /// Says of each thing what `over` says, where it says something. A limit, or asking about noise, takes back that pictures shall
  /// be equal, with which nothing else would be asked.
  void lay(const CompareSettings& over);
  /// Writes what was said into a request.
  void apply(CompareRequest& request) const;
};

}  // namespace whit
