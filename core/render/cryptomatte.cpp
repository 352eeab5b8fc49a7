#include "core/render/cryptomatte.h"

#include <fmt/format.h>

#include <bit>
#include <cstring>
#include <set>

namespace whit {

/// Appleby, MurmurHash3, 2011, in the public domain.
uint32_t murmur_hash(std::string_view text) {
  constexpr uint32_t c1 = 0xcc9e2d51, c2 = 0x1b873593;
  const auto mix = [](uint32_t k) { return std::rotl(k * c1, 15) * c2; };
  uint32_t hash = 0;
  const size_t whole = text.size() / 4 * 4;
  for (size_t i = 0; i < whole; i += 4) {
    uint32_t k = 0;
    std::memcpy(&k, text.data() + i, 4);
    hash = std::rotl(hash ^ mix(k), 13) * 5 + 0xe6546b64;
  }
  uint32_t tail = 0;
  for (size_t i = text.size(); i > whole; --i) tail = tail << 8 | static_cast<unsigned char>(text[i - 1]);
  hash ^= mix(tail);
  hash ^= static_cast<uint32_t>(text.size());
  hash = (hash ^ hash >> 16) * 0x85ebca6b;
  hash = (hash ^ hash >> 13) * 0xc2b2ae35;
  return hash ^ hash >> 16;
}

uint32_t matte_id(std::string_view name) {
  const uint32_t hash = murmur_hash(name), exponent = hash >> 23 & 255;
  return exponent == 0 || exponent == 255 ? hash ^ 1u << 23 : hash;
}

float matte_float(uint32_t id) { return std::bit_cast<float>(id); }

std::string json_text(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    if (static_cast<unsigned char>(c) < 0x20) out += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    else out += c;
  }
  return out + '"';
}

std::vector<OutputMetadata> matte_header(const std::string& layer, const std::vector<std::string>& names) {
  const std::string key = "cryptomatte/" + fmt::format("{:08x}", murmur_hash(layer)).substr(0, 7) + "/";
  std::string manifest;
  for (const std::string& name : std::set<std::string>(names.begin(), names.end())) {
    manifest += fmt::format("{}{}:\"{:08x}\"", manifest.empty() ? "{" : ",", json_text(name), matte_id(name));
  }
  return {{key + "name", layer},
          {key + "hash", std::string("MurmurHash3_32")},
          {key + "conversion", std::string("uint32_to_float32")},
          {key + "manifest", manifest.empty() ? "{}" : manifest + "}"}};
}

}  // namespace whit
