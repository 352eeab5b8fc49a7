#include "core/compare/number_words.h"

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

std::string short_percent_text(double share) {
  const double percent = 100 * share, size = std::abs(percent);
  return size >= 999.5 && size < 1e9 ? fmt::format("{:.0f} %", percent) : fmt::format("{:.3g} %", percent);
}

std::string signed_percent_text(double share) { return fmt::format("{}{}", share > 0 ? "+" : "", percent_text(share)); }

}  // namespace whit
