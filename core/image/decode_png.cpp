// PNG files: most textures are, and OpenImageIO takes longer to load than many of them to decode. Rows come out of deflate
// a few at a time and are made into pixels there; only of interlaced files there is a whole picture in memory.
#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "core/image/decode.h"
#include "core/image/png_filter.h"
#include "core/image/png_stream.h"

namespace whit {
namespace {

/// Rows of pixels as the file packs them, each `pixels` wide.
class PackedRows {
 public:
  PackedRows(PngStream& stream, int pixels, int rows)
      : stream_(stream), row_bytes_(stream.header.row_bytes(pixels)), left_(rows) {
    strip_.resize((row_bytes_ + 1) * rows_in_strip() + kPngFilterReadsOn);
    above_.resize(row_bytes_ + kPngFilterReadsOn);
    step_ = std::max(1, stream.header.numbers() * stream.header.bits / 8);
  }

  const uint8_t* next() {
    if (at_ == end_) refill();
    uint8_t* const row = strip_.data() + at_;
    if (!undo_png_filter(row[0], row + 1, last_ ? last_ : above_.data(), row_bytes_, step_))
      throw std::runtime_error("it has a filter that PNG does not have");
    last_ = row + 1;
    at_ += row_bytes_ + 1;
    return last_;
  }

 private:
  // As many as take the place of deflate's window four times over: each part makes it remember its window anew.
  size_t rows_in_strip() const {
    return std::min(static_cast<size_t>(left_), std::max(size_t{1}, (size_t{1} << 17) / (row_bytes_ + 1)));
  }

  void refill() {
    if (last_) std::memcpy(above_.data(), last_, row_bytes_);
    last_ = nullptr;
    const size_t rows = rows_in_strip();
    at_ = 0, end_ = rows * (row_bytes_ + 1);
    stream_.read(strip_.data(), end_);
    left_ -= static_cast<int>(rows);
  }

  PngStream& stream_;
  size_t row_bytes_;
  int left_, step_ = 1;
  std::vector<uint8_t> strip_, above_;  // of the row before the strip's, at first zeros
  size_t at_ = 0, end_ = 0;
  const uint8_t* last_ = nullptr;  // the row before, when it is in the strip
};

/// From packed pixels to numbers of 8 bits, or of 16 in the order of the file.
class Unpacker {
 public:
  explicit Unpacker(const PngStream& stream) : header_(stream.header) {
    for (size_t i = 0; i < 256; ++i) {
      std::copy_n(&stream.palette[3 * i], 3, &palette_[4 * i]);
      palette_[4 * i + 3] = stream.palette_alpha[i];
    }
    of_colour_ = stream.has_palette_alpha ? 4 : 3;
    clear_ = stream.clear;
    // Numbers of few bits stand for the same range as those of eight.
    const int most = (1 << std::min(header_.bits, 8)) - 1;
    for (int i = 0; i <= most; ++i) grey_[i] = static_cast<uint8_t>(i * 255 / most);
  }

  bool needed() const { return header_.bits < 8 || header_.colour == PngHeader::Palette || !clear_.empty(); }

  void unpack(const uint8_t* from, int pixels, uint8_t* to) const {
    const int bits = header_.bits;
    if (!clear_.empty()) return unpack_with_clear(from, pixels, to);
    if (bits > 8 || !needed()) {
      std::memcpy(to, from, header_.row_bytes(pixels));
      return;
    }
    const int mask = (1 << bits) - 1;
    for (int x = 0; x < pixels; ++x) {
      const int bit = x * bits, v = from[bit >> 3] >> (8 - bits - (bit & 7)) & mask;
      if (header_.colour == PngHeader::Palette) to = std::copy_n(&palette_[4 * v], of_colour_, to);
      else *to++ = grey_[v];
    }
  }

 private:
  // Numbers, and alpha that is 0 where they are those of the transparent colour.
  void unpack_with_clear(const uint8_t* from, int pixels, uint8_t* to) const {
    const int bits = header_.bits, numbers = header_.numbers(), bytes = bits / 8;
    for (int x = 0; x < pixels; ++x) {
      bool is_clear = true;
      for (int c = 0; c < numbers; ++c) {
        const int bit = x * bits;
        const int v = bytes == 0   ? from[bit >> 3] >> (8 - bits - (bit & 7)) & ((1 << bits) - 1)
                      : bytes == 1 ? from[numbers * x + c]
                                   : from[2 * (numbers * x + c)] << 8 | from[2 * (numbers * x + c) + 1];
        if (bytes == 0) *to++ = grey_[v];
        else to = std::copy_n(from + bytes * (numbers * x + c), bytes, to);
        is_clear = is_clear && v == clear_[static_cast<size_t>(c)];
      }
      to = std::fill_n(to, std::max(1, bytes), static_cast<uint8_t>(is_clear ? 0 : 255));
    }
  }

  const PngHeader& header_;
  std::vector<int> clear_;
  std::array<uint8_t, 4 * 256> palette_;
  int of_colour_ = 3;  // numbers of a colour of the palette
  std::array<uint8_t, 256> grey_{};
};

// Four digits undo the rounding in the file: 45455 is meant to be 1 / 2.2.
std::string space_of_power(uint32_t power) {
  const std::string gamma = fmt::format("{:.4g}", 100000.0 / power);
  return gamma == "1" ? "linear" : "gamma=" + gamma;
}

class PngRows : public PictureRows {
 public:
  explicit PngRows(const PictureFile& file) : stream_(file), unpacker_(stream_) {
    set_info();
    if (std::string problem = size_problem(file, info); !problem.empty()) throw std::runtime_error(problem);
    pixel_bytes_ = static_cast<size_t>(info.channels) * (wide() ? 2 : 1);
  }

  const uint8_t* next_bytes() override {
    const uint8_t* row = stream_.header.interlaced ? next_of_whole() : next_of_stream();
    if (++row_ == info.height) stream_.finish();
    return row;
  }

  const float* next_floats() override {
    const uint8_t* row = next_bytes();
    floats_.resize(static_cast<size_t>(info.width) * info.channels);
    for (size_t i = 0; i < floats_.size(); ++i)
      floats_[i] = static_cast<float>(row[2 * i] << 8 | row[2 * i + 1]) / 65535;
    return floats_.data();
  }

  size_t memory() const override {
    const size_t row = info.width * pixel_bytes_, whole = stream_.header.interlaced ? row * info.height : 0;
    return PngStream::memory() + (size_t{1} << 17) + 8 * row + whole;
  }

 private:
  bool wide() const { return stream_.header.bits == 16; }

  void set_info() {
    const PngHeader& h = stream_.header;
    std::vector<std::string> channels{"R", "G", "B"};
    if (h.colour == PngHeader::Grey) channels = {"Y"};
    if (h.colour == PngHeader::GreyAlpha) channels = {"Y", "A"};
    if (h.colour == PngHeader::RgbAlpha || stream_.has_palette_alpha || !stream_.clear.empty()) channels.push_back("A");
    set_header(info, h.width, h.height, wide() ? SampleFormat::UInt16 : SampleFormat::UInt8, std::move(channels));
    if (stream_.power > 0) {
      info.metadata["oiio:ColorSpace"] = space_of_power(stream_.power);
      info.metadata["png:gAMA"] = std::to_string(stream_.power);
    }
  }

  const uint8_t* next_of_stream() {
    if (!packed_) packed_ = std::make_unique<PackedRows>(stream_, info.width, info.height);
    const uint8_t* const row = packed_->next();
    if (!unpacker_.needed()) return row;
    pixels_.resize(info.width * pixel_bytes_);
    unpacker_.unpack(row, info.width, pixels_.data());
    return pixels_.data();
  }

  const uint8_t* next_of_whole() {
    if (pixels_.empty()) read_whole();
    return pixels_.data() + static_cast<size_t>(row_) * info.width * pixel_bytes_;
  }

  // The seven pictures of Adam7, each made of pixels of the whole that lie apart.
  void read_whole() {
    pixels_.resize(static_cast<size_t>(info.width) * info.height * pixel_bytes_);
    constexpr struct {
      int x, y, dx, dy;
    } passes[] = {{0, 0, 8, 8}, {4, 0, 8, 8}, {0, 4, 4, 8}, {2, 0, 4, 4}, {0, 2, 2, 4}, {1, 0, 2, 2}, {0, 1, 1, 2}};
    std::vector<uint8_t> part;
    for (const auto& pass : passes) {
      const int width = (info.width - pass.x + pass.dx - 1) / pass.dx,
                height = (info.height - pass.y + pass.dy - 1) / pass.dy;
      if (width <= 0 || height <= 0) continue;
      PackedRows rows(stream_, width, height);
      part.resize(width * pixel_bytes_);
      for (int y = pass.y; y < info.height; y += pass.dy) {
        unpacker_.unpack(rows.next(), width, part.data());
        uint8_t* const to = pixels_.data() + (static_cast<size_t>(y) * info.width + pass.x) * pixel_bytes_;
        for (int x = 0; x < width; ++x)
          std::copy_n(&part[x * pixel_bytes_], pixel_bytes_, to + static_cast<size_t>(x) * pass.dx * pixel_bytes_);
      }
    }
  }

  PngStream stream_;
  Unpacker unpacker_;
  size_t pixel_bytes_ = 0;
  std::unique_ptr<PackedRows> packed_;
  std::vector<uint8_t> pixels_;  // the row, or the picture if it is interlaced
  std::vector<float> floats_;
  int row_ = 0;
};

}  // namespace

std::unique_ptr<PictureRows> open_png(const PictureFile& file) { return std::make_unique<PngRows>(file); }

}  // namespace whit
