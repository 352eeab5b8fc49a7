#include "core/image/checksum.h"

#include <fmt/format.h>
#include <isa-l/crc64.h>

#include <algorithm>
#include <cstring>

#include "core/base/mapped_file.h"

namespace whit {

uint64_t checksum(std::string_view bytes, uint64_t before) {
  return crc64_ecma_refl(before, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
}

std::optional<uint64_t> file_checksum(const std::string& path) {
  const MappedFile file(path);
  const uint64_t sum = checksum(file.bytes());
  return file.problem().empty() ? std::optional(sum) : std::nullopt;
}

std::string checksum_text(uint64_t sum) { return fmt::format("{:016x}", sum); }

SummedBytes::SummedBytes(std::string_view all) : bytes(all) {
  if (all.size() >= sizeof sum) std::memcpy(&sum, all.data() + all.size() - sizeof sum, sizeof sum);
  bytes.remove_suffix(std::min(all.size(), sizeof sum));
}

}  // namespace whit
