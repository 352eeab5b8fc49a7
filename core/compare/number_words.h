// Numbers as reports write them.
#pragma once

#include <string>

namespace whit {

/// Three significant digits, without an exponent: "0.00123", "14.0", "12300"; "unknown" of what is not finite.
std::string three_digits(double value);

/// "1.23 %"; of changes with their sign: "+1.23 %".
std::string percent_text(double share);
std::string signed_percent_text(double share);

/// For sentences: at most three digits and none for nothing, "1 %", "1.1 %", "100 %"; of more than that all, "1234 %".
std::string short_percent_text(double share);

}  // namespace whit
