#include "core/image/signature.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

#include "core/base/limits.h"

namespace whit {
namespace {

constexpr size_t kLength = 26;  // of a PNG, up to its colour type
using Bytes = std::array<uint8_t, kLength>;

std::string_view text(const Bytes& b, size_t first, size_t count) {
  return {reinterpret_cast<const char*>(b.data()) + first, count};
}

// Signature, then the chunk IHDR with width, height and bits.
bool is_png(const Bytes& b) {
  const auto any = [&](size_t first) { return (b[first] | b[first + 1] | b[first + 2] | b[first + 3]) != 0; };
  return text(b, 0, 8) == "\x89PNG\r\n\x1a\n" && text(b, 12, 4) == "IHDR" && any(16) && any(20) && b[24] != 0;
}

bool is_jpg(const Bytes& b) { return b[0] == 0xff && b[1] == 0xd8 && b[2] == 0xff; }

bool is_exr(const Bytes& b) { return text(b, 0, 4) == "\x76\x2f\x31\x01"; }

// TGA has no signature: its colour map's kind, its own (with and without run lengths), size and bits have to make sense.
bool is_tga(const Bytes& b) {
  constexpr std::array<uint8_t, 6> kinds{1, 2, 3, 9, 10, 11};
  constexpr std::array<uint8_t, 5> bits{8, 15, 16, 24, 32};
  const auto one_of = [](const auto& list, uint8_t v) { return std::find(list.begin(), list.end(), v) != list.end(); };
  return b[1] <= 1 && one_of(kinds, b[2]) && (b[12] | b[13]) != 0 && (b[14] | b[15]) != 0 && one_of(bits, b[16]);
}

// Grey of 8 bits or colours of 24 or 32, left to right, and not interleaved.
bool is_common_tga(const Bytes& b) {
  const bool grey = (b[2] & 7) == 3 && b[16] == 8, colour = (b[2] & 7) == 2 && (b[16] == 24 || b[16] == 32);
  return is_tga(b) && b[1] == 0 && (grey || colour) && (b[17] & 0xd0) == 0;
}

bool ends_with(const std::string& path, std::string_view extension) {
  return path.size() >= extension.size() &&
         std::equal(extension.rbegin(), extension.rend(), path.rbegin(),
                    [](char a, char b) { return a == (b >= 'A' && b <= 'Z' ? b - 'A' + 'a' : b); });
}

// The first bytes of a picture; zeros when it has not that many or cannot be read.
Bytes beginning(const PictureFile& picture) {
  Bytes bytes{};
  if (picture.bytes) {
    if (picture.bytes->bytes.size() >= kLength) std::copy_n(picture.bytes->bytes.begin(), kLength, bytes.begin());
    return bytes;
  }
  const std::string& path = picture.path;
  if (!why_unreadable(path).empty()) return bytes;  // a pipe would be waited for
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return bytes;
  if (read(file, bytes.data(), kLength) != static_cast<ssize_t>(kLength)) bytes = {};
  close(file);
  return bytes;
}

}  // namespace

bool begins_like_a_picture(const PictureFile& file) {
  const Bytes b = beginning(file);
  return is_png(b) || is_jpg(b) || is_exr(b) || (ends_with(file.path, ".tga") && is_tga(b));
}

PictureKind kind_of_picture(const PictureFile& file) {
  const Bytes b = beginning(file);
  if (is_png(b)) return PictureKind::Png;
  if (is_jpg(b)) return PictureKind::Jpeg;
  return ends_with(file.path, ".tga") && is_common_tga(b) ? PictureKind::Tga : PictureKind::Other;
}

}  // namespace whit
