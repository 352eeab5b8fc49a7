// Numbers with units, as people write them on the command line.
#pragma once

#include <cstdint>
#include <string>

namespace whit {

/// Seconds of "60s", "2min", "1500ms", "1h" or "60"; 0 where it is no time above 0.
double duration_of(const std::string& text);

/// Bytes of "512M", "1G", "1.5 GiB" or "1000000": units are powers of 1024; 0 where it is no size above 0.
uint64_t size_of(const std::string& text);

/// The share of "1%", "0.5 %" or "0.01"; 0 where it is none above 0.
double share_of(const std::string& text);

}  // namespace whit
