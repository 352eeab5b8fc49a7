// Numbers with units, as people write them on the command line.
#pragma once

#include <string>

namespace whit {

/// Seconds of "60s", "2min", "1500ms", "1h" or "60"; 0 where it is no time above 0.
double duration_of(const std::string& text);

/// The share of "1%", "0.5 %" or "0.01"; 0 where it is none above 0.
double share_of(const std::string& text);

}  // namespace whit
