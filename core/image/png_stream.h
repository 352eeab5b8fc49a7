// What is inside the chunks of a PNG file: its header, its palette, and the numbers of its rows as they come out of
// deflate. ISA-L does that, in half of zlib's time, which is most of what reading a texture takes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <vector>

#include "core/image/image.h"

struct inflate_state;

namespace whit {

/// The chunk IHDR.
struct PngHeader {
  int width = 0, height = 0;
  int bits = 8;  ///< Of one number.
  enum Colour : uint8_t { Grey = 0, Rgb = 2, Palette = 3, GreyAlpha = 4, RgbAlpha = 6 } colour = Grey;
  bool interlaced = false;

  /// Numbers of a pixel, as the file has them.
  int numbers() const;
  /// Bytes of so many pixels side by side.
  size_t row_bytes(int pixels) const { return (static_cast<size_t>(pixels) * numbers() * bits + 7) / 8; }
};

/// An open file, read up to its pixels. Throws std::runtime_error with the reason.
class PngStream {
 public:
  explicit PngStream(const PictureFile& picture);
  ~PngStream();

  /// The next `n` bytes of the rows, each row behind the number of its filter.
  void read(uint8_t* to, size_t n);

  /// To be called when all rows are read: whether what they came from is undamaged.
  void finish();

  static size_t memory();

  PngHeader header;
  std::array<uint8_t, 3 * 256> palette{};    ///< Colours; black where the file has none.
  std::array<uint8_t, 256> palette_alpha{};  ///< Of the colours, where `has_palette_alpha`.
  bool has_palette_alpha = false;
  uint32_t power = 0;      ///< That made numbers of light, 100000 times (gAMA), where that is all the file says; or 0.
  std::vector<int> clear;  ///< The numbers of the pixels that are transparent, where others are not; or empty.

 private:
  struct Chunk {
    uint32_t length = 0;
    std::array<uint8_t, 4> type{};
  };
  void read_file(uint8_t* to, size_t n);
  std::vector<uint8_t> small_chunk(const Chunk& chunk, size_t most);
  Chunk begin_chunk();
  void end_chunk();
  void skip_chunk(const Chunk& chunk);
  void read_header();
  void find_pixels();
  bool refill();

  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
  std::unique_ptr<inflate_state> inflate_;
  std::vector<uint8_t> buffer_;
  uint32_t left_ = 0;  // of the chunk of pixels
  uint32_t crc_ = 0;   // of the chunk so far
};

}  // namespace whit
