// Reading through OpenImageIO.
#include <OpenImageIO/imageio.h>

#include <cmath>
#include <memory>
#include <stdexcept>

#include "core/image/oiio/functions.h"

namespace whit {
namespace {

using InputPtr = std::unique_ptr<OIIO::ImageInput>;

SampleFormat sample_format(const OIIO::ImageSpec& spec) {
  SampleFormat most = SampleFormat::UInt8;
  for (int c = 0; c < spec.nchannels; ++c) {
    SampleFormat f = SampleFormat::Float;
    switch (spec.channelformat(c).basetype) {
      case OIIO::TypeDesc::UINT8:
      case OIIO::TypeDesc::INT8: f = SampleFormat::UInt8; break;
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

std::string header_problem(const OIIO::ImageSpec& spec) {
  if (spec.width <= 0 || spec.height <= 0 || spec.nchannels <= 0) return "it has no pixels";
  if (spec.depth > 1) return "it is a volume, not a picture";
  return spec.deep ? "deep pictures are not supported" : "";
}

// OpenImageIO multiplies by 1/255, which is an ulp off for some bytes; the quotient is what pbrt-v3 computes.
void divide_exactly(const OIIO::ImageSpec& spec, std::vector<float>& pixels) {
  const float most = spec.format == OIIO::TypeDesc::UINT8 ? 255 : spec.format == OIIO::TypeDesc::UINT16 ? 65535 : 0;
  if (most == 0 || !spec.channelformats.empty()) return;
  for (float& v : pixels) v = std::nearbyint(v * most) / most;
}

// Throws what is wrong with a file that cannot be read; the caller adds which one.
InputPtr open_image(const std::string& path, ImageInfo& info) {
  OIIO::ImageSpec config;
  config.attribute("oiio:UnassociatedAlpha", 1);  // pbrt ignores alpha: colour must not be multiplied by it
  InputPtr input = OIIO::ImageInput::open(path, &config);
  if (!input) throw std::runtime_error(OIIO::geterror());
  if (std::string problem = header_problem(input->spec()); !problem.empty()) throw std::runtime_error(problem);
  copy_header(input->spec(), info);
  if (std::string problem = size_problem(path, info); !problem.empty()) throw std::runtime_error(problem);
  return input;
}

template <class Number>
InputPtr read_pixels(const std::string& path, OIIO::TypeDesc type, PixelArray<Number>& image) {
  InputPtr input = open_image(path, image);
  image.pixels.resize(static_cast<size_t>(image.width) * image.height * image.channels);
  if (!input->read_image(0, 0, 0, image.channels, type, image.pixels.data()))
    throw std::runtime_error(input->geterror());
  return input;
}

}  // namespace

ImageInfo oiio_probe(const std::string& path) {
  ImageInfo info;
  open_image(path, info);
  return info;
}

Image oiio_read(const std::string& path) {
  Image image;
  const InputPtr input = read_pixels(path, OIIO::TypeDesc::FLOAT, image);
  divide_exactly(input->spec(), image.pixels);
  return image;
}

ByteImage oiio_read_bytes(const std::string& path) {
  ByteImage image;
  read_pixels(path, OIIO::TypeDesc::UINT8, image);
  return image;
}

}  // namespace whit
