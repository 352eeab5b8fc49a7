// Reading through OpenImageIO.
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <type_traits>

#include "core/image/decode.h"
#include "core/image/oiio/functions.h"

namespace whit {
namespace {

SampleFormat sample_format(const OIIO::ImageSpec& spec) {
  SampleFormat most = SampleFormat::UInt8;
  for (int c = 0; c < spec.nchannels; ++c) {
    SampleFormat f = SampleFormat::Float;
    switch (spec.channelformat(c).basetype) {
      case OIIO::TypeDesc::UINT8: f = SampleFormat::UInt8; break;
      case OIIO::TypeDesc::INT8:
      case OIIO::TypeDesc::UINT16:
      case OIIO::TypeDesc::INT16: f = SampleFormat::UInt16; break;
      case OIIO::TypeDesc::HALF: f = SampleFormat::Half; break;
      default: break;
    }
    most = std::max(most, f);
  }
  return most;
}

void copy_header(const OIIO::ImageSpec& spec, ImageInfo& info) {
  info.width = spec.width;
  info.height = spec.height;
  info.channels = spec.nchannels;
  info.x = spec.x;
  info.y = spec.y;
  info.full_x = spec.full_x;
  info.full_y = spec.full_y;
  info.full_width = spec.full_width;
  info.full_height = spec.full_height;
  info.format = sample_format(spec);
  info.channel_names.assign(spec.channelnames.begin(), spec.channelnames.end());
  info.channel_names.resize(static_cast<size_t>(spec.nchannels));
  for (const auto& attribute : spec.extra_attribs) info.metadata[attribute.name().string()] = attribute.get_string();
}

// OpenImageIO may have a line for each row of the picture.
std::string pixel_problem(const std::string& text) {
  return fmt::format("its pixels are cut off or damaged: {}", text.substr(0, text.find('\n')));
}

std::string header_problem(const OIIO::ImageSpec& spec) {
  if (spec.width <= 0 || spec.height <= 0 || spec.nchannels <= 0) return "it has no pixels";
  if (spec.depth > 1) return "it is a volume, not a picture";
  return spec.deep ? "deep pictures are not supported" : "";
}

// Bytes in memory as a file: not all of OpenImageIO's readers take them otherwise.
class NamelessFile {
 public:
  explicit NamelessFile(std::span<const uint8_t> bytes) : file_(::memfd_create("whit picture", MFD_CLOEXEC)) {
    if (file_ < 0) fail();
    while (!bytes.empty()) {
      const ssize_t n = ::write(file_, bytes.data(), bytes.size());
      if (n <= 0) fail();
      bytes = bytes.subspan(static_cast<size_t>(n));
    }
  }
  ~NamelessFile() { ::close(file_); }
  NamelessFile(const NamelessFile&) = delete;
  NamelessFile& operator=(const NamelessFile&) = delete;

  std::string path() const { return fmt::format("/proc/self/fd/{}", file_); }

 private:
  [[noreturn]] void fail() const {
    const int reason = errno;
    if (file_ >= 0) ::close(file_);
    throw std::runtime_error(std::strerror(reason));
  }
  int file_;
};

// Rows are asked for in strips: as many as a tile is high, or some MiB, so that OpenEXR, which packs up to 256 rows together,
// has something to do for all of its threads.
class OiioRows : public PictureRows {
 public:
  explicit OiioRows(const PictureFile& file) {
    if (file.bytes) nameless_ = std::make_unique<NamelessFile>(file.bytes->bytes);
    const std::string path = nameless_ ? nameless_->path() : file.path;
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);  // pbrt ignores alpha: colour must not be multiplied by it
    input_ = OIIO::ImageInput::open(path, &config);
    if (!input_) throw std::runtime_error(OIIO::geterror());
    const OIIO::ImageSpec& spec = input_->spec();
    if (std::string problem = header_problem(spec); !problem.empty()) throw std::runtime_error(problem);
    copy_header(spec, info);
    if (std::string problem = size_problem(file, info); !problem.empty()) throw std::runtime_error(problem);
    if (std::string problem = length_problem(file); !problem.empty()) throw std::runtime_error(problem);
    input_->geterror();  // of headers' entries that no pixel depends on
    row_ = static_cast<size_t>(info.width) * info.channels;
    const size_t rows = kStripBytes / (row_ * sizeof(float)) / 256 * 256;
    strip_height_ = spec.tile_width > 0 ? spec.tile_height : static_cast<int>(std::max(size_t{256}, rows));
    strip_height_ = std::min(info.height, strip_height_);
  }

  const uint8_t* next_bytes() override {
    if (bytes_.empty()) bytes_.resize(row_ * strip_height_);
    return next(bytes_, OIIO::TypeDesc::UINT8);
  }

  const float* next_floats() override {
    if (floats_.empty()) floats_.resize(row_ * strip_height_);
    return next(floats_, OIIO::TypeDesc::FLOAT);
  }

  size_t memory() const override {
    // Some of OpenImageIO's readers hold all of the file's numbers, or what they are made of.
    const OIIO::ImageSpec& spec = input_->spec();
    return spec.image_bytes(true) + row_ * strip_height_ * sizeof(float);
  }

  // The header's "oiio:subimages" is not there for pages of TIFF.
  bool has_more_pictures() override { return input_->seek_subimage(1, 0); }

 private:
  static constexpr size_t kStripBytes = size_t{16} << 20;

  template <class Number>
  const Number* next(std::vector<Number>& strip, OIIO::TypeDesc type) {
    const int in_strip = y_++ % strip_height_;
    if (in_strip == 0) read(strip, type, std::min(y_ - 1 + strip_height_, info.height));
    return strip.data() + row_ * in_strip;
  }

  template <class Number>
  void read(std::vector<Number>& strip, OIIO::TypeDesc type, int end) {
    const OIIO::ImageSpec& spec = input_->spec();
    const int x = spec.x, y = spec.y, first = y_ - 1;
    const bool good = spec.tile_width > 0 ? input_->read_tiles(0, 0, x, x + spec.width, y + first, y + end, spec.z,
                                                               spec.z + 1, 0, spec.nchannels, type, strip.data())
                                          : input_->read_scanlines(0, 0, y + first, y + end, spec.z, 0, spec.nchannels,
                                                                   type, strip.data());
    // The reader of TIFF says that all went well where strips of a file that is cut off are missing, but keeps the error.
    if (!good || input_->has_error()) throw std::runtime_error(pixel_problem(input_->geterror()));
    if constexpr (std::is_same_v<Number, float>) divide_exactly(strip);
  }

  // OpenImageIO multiplies by 1/65535, which is an ulp off for some numbers; the quotient is what pbrt-v3 computes.
  void divide_exactly(std::vector<float>& numbers) const {
    const OIIO::ImageSpec& spec = input_->spec();
    if (spec.format != OIIO::TypeDesc::UINT16 || !spec.channelformats.empty()) return;
    for (float& v : numbers) v = std::nearbyint(v * 65535) / 65535;
  }

  std::unique_ptr<NamelessFile> nameless_;  // as long as it is read
  std::unique_ptr<OIIO::ImageInput> input_;
  size_t row_ = 0;
  int strip_height_ = 1, y_ = 0;
  std::vector<uint8_t> bytes_;
  std::vector<float> floats_;
};

}  // namespace

std::unique_ptr<PictureRows> oiio_open(const PictureFile& file) {
  if (is_webp(file)) return open_webp(file);
  return std::make_unique<OiioRows>(file);
}

}  // namespace whit
