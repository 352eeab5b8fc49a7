// PNG files, decoded by libspng: most textures are, and OpenImageIO takes longer to load than many of them to decode.
#include <spng.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <stdexcept>

#include "core/image/decode.h"

namespace whit {
namespace {

void check(int error) {
  if (error != 0) throw std::runtime_error(spng_strerror(error));
}

/// An open file, its header read.
class PngFile {
 public:
  explicit PngFile(const std::string& path)
      : file_(std::fopen(path.c_str(), "rb"), std::fclose), png_(spng_ctx_new(0), spng_ctx_free) {
    if (!file_) throw std::runtime_error(std::strerror(errno));
    check(spng_set_png_file(png_.get(), file_.get()));
    check(spng_get_ihdr(png_.get(), &header_));
    set_info();
    if (std::string problem = size_problem(path, info); !problem.empty()) throw std::runtime_error(problem);
  }

  /// The picture as the file has it, with palettes and numbers of less than 8 bits expanded; 16 bits in native order.
  template <class Number>
  std::vector<Number> decode() {
    size_t bytes = 0;
    check(spng_decoded_image_size(png_.get(), format_, &bytes));
    std::vector<Number> pixels(bytes / sizeof(Number));
    check(spng_decode_image(png_.get(), pixels.data(), bytes, format_, 0));
    return pixels;
  }

  ImageInfo info;

 private:
  void set_info() {
    const bool wide = header_.bit_depth == 16;
    info.width = info.full_width = static_cast<int>(header_.width);
    info.height = info.full_height = static_cast<int>(header_.height);
    info.format = wide ? SampleFormat::UInt16 : SampleFormat::UInt8;
    info.metadata["oiio:ColorSpace"] = "sRGB";  // as OpenImageIO has it, and the format where a file says nothing else
    const auto layout = [&](std::vector<std::string> names, spng_format narrow) {
      info.channels = static_cast<int>(names.size());
      info.channel_names = std::move(names);
      format_ = wide ? SPNG_FMT_PNG : narrow;
    };
    switch (header_.color_type) {
      case SPNG_COLOR_TYPE_GRAYSCALE: layout({"Y"}, SPNG_FMT_G8); break;
      case SPNG_COLOR_TYPE_GRAYSCALE_ALPHA: layout({"Y", "A"}, SPNG_FMT_PNG); break;
      case SPNG_COLOR_TYPE_TRUECOLOR_ALPHA: layout({"R", "G", "B", "A"}, SPNG_FMT_RGBA8); break;
      default: layout({"R", "G", "B"}, SPNG_FMT_RGB8); break;
    }
  }

  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
  std::unique_ptr<spng_ctx, void (*)(spng_ctx*)> png_;
  spng_ihdr header_{};
  int format_ = SPNG_FMT_PNG;
};

template <class Number>
std::vector<float> scaled(const std::vector<Number>& numbers) {
  std::vector<float> out(numbers.size());
  constexpr float kMost = static_cast<Number>(~Number{0});
  for (size_t i = 0; i < numbers.size(); ++i) out[i] = static_cast<float>(numbers[i]) / kMost;
  return out;
}

ImageInfo probe(const std::string& path) { return PngFile(path).info; }

Image read(const std::string& path) {
  PngFile file(path);
  const bool wide = file.info.format == SampleFormat::UInt16;
  Image image;
  static_cast<ImageInfo&>(image) = file.info;
  image.pixels = wide ? scaled(file.decode<uint16_t>()) : scaled(file.decode<uint8_t>());
  return image;
}

ByteImage read_bytes(const std::string& path) {
  PngFile file(path);
  if (file.info.format != SampleFormat::UInt8) throw std::runtime_error("its numbers have more than 8 bits");
  ByteImage image;
  static_cast<ImageInfo&>(image) = file.info;
  image.pixels = file.decode<uint8_t>();
  return image;
}

}  // namespace

const PictureReader kPngReader{probe, read, read_bytes};

}  // namespace whit
