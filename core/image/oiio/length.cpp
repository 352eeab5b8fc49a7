// Files that are cut off, of the kinds where OpenImageIO takes what is missing for zeros.
// Source: SMPTE ST 268-1:2014, File Format for Digital Moving-Picture Exchange (DPX).
#include <array>
#include <cstring>

#include "core/image/decode.h"
#include "core/image/oiio/functions.h"

namespace whit {
namespace {

constexpr size_t kDpxHeader = 2048;  // of files of a kind for all and one for films
constexpr uint32_t kUndefined = 0xffffffff;

// Numbers of a header in the order of bytes that its first four tell.
class DpxHeader {
 public:
  explicit DpxHeader(const std::array<uint8_t, kDpxHeader>& bytes) : bytes_(bytes), big_(bytes[0] == 'S') {}
  uint32_t word(size_t at) const { return big_ ? number(at, 2) << 16 | number(at + 2, 2) : number(at, 4); }
  uint32_t half_word(size_t at) const { return number(at, 2); }
  uint32_t byte(size_t at) const { return bytes_[at]; }

 private:
  uint32_t number(size_t at, size_t n) const {
    uint32_t v = 0;
    for (size_t i = 0; i < n; ++i) v |= uint32_t{bytes_[at + i]} << 8 * (big_ ? n - 1 - i : i);
    return v;
  }
  const std::array<uint8_t, kDpxHeader>& bytes_;
  bool big_;
};

// Numbers of a pixel by what the first element describes.
uint64_t numbers_of_pixel(uint32_t description) {
  if (description == 50) return 3;                         // RGB
  if (description == 51 || description == 52) return 4;    // RGBA, ABGR
  if (description >= 100 && description <= 103) return 2;  // YCbCr with half of the colours: at least so many
  return 1;
}

// Bytes of a row: of 10 and 12 bits padded to words where `packing` is not 0.
uint64_t row_bytes(uint64_t numbers, uint32_t bits, uint32_t packing) {
  if (bits == 10 && packing != 0) return (numbers + 2) / 3 * 4;
  if (bits == 12 && packing != 0) return 2 * numbers;
  return (numbers * bits + 31) / 32 * 4;
}

// Where the first element's pixels end, as far as the header tells; 0 where it does not.
uint64_t dpx_end(const DpxHeader& h) {
  constexpr size_t kElement = 780;
  const uint32_t bits = h.byte(kElement + 23), packing = h.half_word(kElement + 24);
  const bool packed_runs = h.half_word(kElement + 26) != 0;
  if (packed_runs || (bits != 10 && bits != 12)) return 0;
  uint64_t start = h.word(kElement + 28), padding = h.word(kElement + 32);
  if (start == kUndefined || start == 0) start = h.word(4);
  if (padding == kUndefined) padding = 0;
  const uint64_t row = row_bytes(h.word(772) * numbers_of_pixel(h.byte(kElement + 20)), bits, packing);
  return start + (row + padding) * h.word(776);
}

}  // namespace

std::string length_problem(const PictureFile& picture) {
  const FilePtr file = open_to_read(picture);
  std::array<uint8_t, kDpxHeader> bytes{};
  if (std::fread(bytes.data(), 1, bytes.size(), file.get()) != bytes.size()) return "";
  if (std::memcmp(bytes.data(), "SDPX", 4) != 0 && std::memcmp(bytes.data(), "XPDS", 4) != 0) return "";
  if (std::fseek(file.get(), 0, SEEK_END) != 0) return std::strerror(errno);
  return dpx_end(DpxHeader(bytes)) > static_cast<uint64_t>(std::ftell(file.get())) ? "the file ends early" : "";
}

}  // namespace whit
