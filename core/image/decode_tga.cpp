// The TGA files that nearly all are: grey or true colour, with or without run lengths. OpenImageIO reads them number by number.
// Source: Truevision TGA File Format Specification, version 2.0, 1991.
#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <vector>

#include "core/image/decode.h"

namespace whit {
namespace {

constexpr size_t kHeader = 18;

class TgaRows : public PictureRows {
 public:
  explicit TgaRows(const PictureFile& file) : file_(open_to_read(file)) {
    std::array<uint8_t, kHeader> h;
    read(h.data(), kHeader);
    runs_ = h[2] >= 8;
    pixel_ = h[16] / 8;
    bottom_first = (h[17] & 0x20) == 0;
    std::vector<std::string> channels{"R", "G", "B"};
    if (pixel_ == 1) channels = {"Y"};
    if (pixel_ == 4) channels.push_back("A");
    set_header(info, h[12] | h[13] << 8, h[14] | h[15] << 8, SampleFormat::UInt8, std::move(channels));
    if (std::string problem = size_problem(file, info); !problem.empty()) throw std::runtime_error(problem);
    if (std::fseek(file_.get(), h[0], SEEK_CUR) != 0) throw std::runtime_error(std::strerror(errno));
    row_.resize(static_cast<size_t>(info.width) * pixel_);
  }

  const uint8_t* next_bytes() override {
    if (runs_) read_runs();
    else read(row_.data(), row_.size());
    // The file has blue first.
    if (pixel_ >= 3)
      for (size_t i = 0; i < row_.size(); i += pixel_) std::swap(row_[i], row_[i + 2]);
    return row_.data();
  }

  const float* next_floats() override { throw std::logic_error("the picture has bytes"); }
  size_t memory() const override { return row_.size() + BUFSIZ; }

 private:
  void read(uint8_t* to, size_t n) {
    if (std::fread(to, 1, n, file_.get()) != n) throw std::runtime_error("the file ends early");
  }

  // Packets of pixels, or of one that is repeated; one may go on in the next row.
  void read_runs() {
    for (size_t at = 0; at < row_.size();) {
      if (left_ == 0) {
        uint8_t packet;
        read(&packet, 1);
        left_ = (packet & 0x7f) + 1;
        repeats_ = (packet & 0x80) != 0;
        if (repeats_) read(repeated_.data(), pixel_);
      }
      const size_t pixels = std::min(left_, (row_.size() - at) / pixel_), bytes = pixels * pixel_;
      if (repeats_) {
        for (size_t i = 0; i < bytes; i += pixel_) std::copy_n(repeated_.data(), pixel_, &row_[at + i]);
      } else {
        read(&row_[at], bytes);
      }
      at += bytes, left_ -= pixels;
    }
  }

  FilePtr file_;
  size_t pixel_ = 0;  // bytes
  bool runs_ = false, repeats_ = false;
  size_t left_ = 0;  // pixels of the packet
  std::array<uint8_t, 4> repeated_{};
  std::vector<uint8_t> row_;
};

}  // namespace

std::unique_ptr<PictureRows> open_tga(const PictureFile& file) { return std::make_unique<TgaRows>(file); }

}  // namespace whit
