// WebP pictures. OpenImageIO's reader gives colours multiplied by alpha in 8 bits, whatever it is asked for: what is
// transparent would be black, and bleed into what is not.
#include <webp/decode.h>

#include <array>
#include <cstdio>
#include <cstring>
#include <new>
#include <stdexcept>

#include "core/image/decode.h"
#include "core/image/oiio/functions.h"

namespace whit {
namespace {

std::vector<uint8_t> all_of(const PictureFile& picture) {
  const FilePtr file = open_to_read(picture);
  std::vector<uint8_t> bytes;
  constexpr size_t kPiece = size_t{1} << 16;
  for (size_t got = kPiece; got == kPiece;) {
    const size_t at = bytes.size();
    bytes.resize(at + kPiece);
    got = std::fread(bytes.data() + at, 1, kPiece, file.get());
    bytes.resize(at + got);
  }
  return bytes;
}

[[noreturn]] void fail(VP8StatusCode status) {
  if (status == VP8_STATUS_OUT_OF_MEMORY) throw std::bad_alloc();
  throw std::runtime_error(status == VP8_STATUS_NOT_ENOUGH_DATA ? "the file ends early" : "it is a damaged WebP file");
}

// The library decodes all of a picture at once.
class WebpRows : public PictureRows {
 public:
  explicit WebpRows(const PictureFile& file) : file_(all_of(file)) {
    WebPBitstreamFeatures features;
    if (const VP8StatusCode status = WebPGetFeatures(file_.data(), file_.size(), &features); status != VP8_STATUS_OK)
      fail(status);
    if (features.has_animation) throw std::runtime_error("it is an animation, not a picture");
    std::vector<std::string> channels{"R", "G", "B"};
    if (features.has_alpha) channels.push_back("A");
    set_header(info, features.width, features.height, SampleFormat::UInt8, std::move(channels));
    if (std::string problem = size_problem(file, info); !problem.empty()) throw std::runtime_error(problem);
  }

  const uint8_t* next_bytes() override {
    const size_t row = static_cast<size_t>(info.width) * info.channels;
    if (pixels_.empty()) decode(row);
    return pixels_.data() + row * y_++;
  }

  const float* next_floats() override { throw std::logic_error("the picture has bytes"); }

  size_t memory() const override {
    return file_.size() + 2 * static_cast<size_t>(info.width) * info.height * info.channels;
  }

 private:
  void decode(size_t row) {
    pixels_.resize(row * info.height);
    WebPDecoderConfig config;
    WebPInitDecoderConfig(&config);
    config.output.colorspace = info.channels == 4 ? MODE_RGBA : MODE_RGB;
    config.output.is_external_memory = 1;
    config.output.u.RGBA = {pixels_.data(), static_cast<int>(row), pixels_.size()};
    if (const VP8StatusCode status = WebPDecode(file_.data(), file_.size(), &config); status != VP8_STATUS_OK)
      fail(status);
    file_ = {};
  }

  std::vector<uint8_t> file_, pixels_;
  size_t y_ = 0;
};

}  // namespace

bool is_webp(const PictureFile& picture) {
  std::array<char, 12> b{};
  const FilePtr file = open_to_read(picture);
  return std::fread(b.data(), 1, b.size(), file.get()) == b.size() && std::memcmp(b.data(), "RIFF", 4) == 0 &&
         std::memcmp(b.data() + 8, "WEBP", 4) == 0;
}

std::unique_ptr<PictureRows> open_webp(const PictureFile& file) { return std::make_unique<WebpRows>(file); }

}  // namespace whit
