// Sums that tell whether bytes are what they were.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace whit {

/// CRC-64 (ECMA-182) of bytes; of bytes that come in pieces, with the sum of those before.
uint64_t checksum(std::string_view bytes, uint64_t before = 0);

/// The same of all that a regular file holds; nothing where it cannot be read.
std::optional<uint64_t> file_checksum(const std::string& path);

/// As 16 hexadecimal digits.
std::string checksum_text(uint64_t sum);

/// Bytes that end in their checksum.
struct SummedBytes {
  explicit SummedBytes(std::string_view all);
  bool are_whole() const { return checksum(bytes) == sum; }

  std::string_view bytes;  ///< Without it.
  uint64_t sum = 0;
};

}  // namespace whit
