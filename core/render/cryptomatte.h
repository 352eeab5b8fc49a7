// Cryptomatte 1.2: which things cover a pixel, and how much of it, under hashes of their names.
// Source: Friedman and Jones, Fully Automatic ID Mattes with Support for Motion Blur and Transparency, SIGGRAPH 2015,
// and the specification at github.com/Psyop/Cryptomatte.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/image/write.h"

namespace whit {

/// MurmurHash3_x86_32 with seed 0: the hash of a name, before it is a float.
uint32_t murmur_hash(std::string_view text);
/// The hash as the specification makes a float of it: its bits, kept from being infinite, no number or denormal.
uint32_t matte_id(std::string_view name);
/// The float of those bits.
float matte_float(uint32_t id);

/// The header's entries of a matte whose layers are called `layer`, for the names that are in it.
std::vector<OutputMetadata> matte_header(const std::string& layer, const std::vector<std::string>& names);

/// A text in quotes, as JSON has it.
std::string json_text(std::string_view text);

}  // namespace whit
