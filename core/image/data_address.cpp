#include "core/image/data_address.h"

#include <isa-l/igzip_lib.h>

#include <algorithm>
#include <stdexcept>

namespace whit {

std::string base64(std::span<const unsigned char> bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t i = 0; i < bytes.size(); i += 3) {
    unsigned bits = 0;
    for (size_t k = 0; k < 3; ++k) bits = bits << 8 | (i + k < bytes.size() ? bytes[i + k] : 0u);
    for (size_t k = 0; k < 4; ++k) out += i + k <= bytes.size() ? kDigits[bits >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

std::string png_address(const DisplayPixels& pixels) { return "data:image/png;base64," + base64(encode_png(pixels)); }

std::string jpeg_address(const DisplayPixels& pixels, int quality) {
  return "data:image/jpeg;base64," + base64(encode_jpeg(pixels, quality));
}

std::vector<unsigned char> deflated(std::span<const unsigned char> bytes) {
  constexpr size_t kPiece = size_t{1} << 20;  // The library counts in 32 bits.
  std::vector<unsigned char> scratch(ISAL_DEF_LVL3_DEFAULT), out;
  isal_zstream stream;
  isal_deflate_init(&stream);
  stream.gzip_flag = IGZIP_ZLIB;
  stream.level = 3;
  stream.level_buf = scratch.data();
  stream.level_buf_size = static_cast<uint32_t>(scratch.size());
  std::vector<unsigned char> piece(kPiece);
  do {
    const std::span<const unsigned char> in = bytes.first(std::min(kPiece, bytes.size()));
    bytes = bytes.subspan(in.size());
    stream.next_in = const_cast<unsigned char*>(in.data());
    stream.avail_in = static_cast<uint32_t>(in.size());
    stream.end_of_stream = bytes.empty() ? 1 : 0;
    do {
      stream.next_out = piece.data();
      stream.avail_out = static_cast<uint32_t>(piece.size());
      if (isal_deflate(&stream) != COMP_OK) throw std::logic_error("ISA-L does not deflate");
      out.insert(out.end(), piece.begin(), piece.end() - stream.avail_out);
    } while (stream.avail_out == 0);
  } while (!bytes.empty());
  return out;
}

}  // namespace whit
