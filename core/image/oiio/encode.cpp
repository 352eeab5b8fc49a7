// TGA, JPEG and TIFF through OpenImageIO, into memory.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <stdexcept>

#include "core/image/oiio/functions.h"

namespace whit {
namespace {

OIIO::ImageSpec file_spec(const DisplayPixels& pixels, const std::string& format, int jpeg_quality) {
  const bool tiff = format == "tif" || format == "tiff";
  const OIIO::TypeDesc type = tiff && pixels.bits == 16 ? OIIO::TypeDesc::UINT16 : OIIO::TypeDesc::UINT8;
  OIIO::ImageSpec spec(pixels.width, pixels.height, 3, type);
  if (tiff) {
    // No colour space: it goes into an EXIF directory, which OpenImageIO 2.4 cannot write through a proxy (the file
    // comes out unreadable). An empty date, because the time of day would make equal pictures differ.
    spec.attribute("compression", "zip");
    spec.attribute("DateTime", "");
  } else {
    spec.attribute("oiio:ColorSpace", "sRGB");
  }
  if (format[0] == 'j') spec.attribute("compression", fmt::format("jpeg:{}", jpeg_quality));
  if (format == "tga") return spec;  // its few fields would hold half of the metadata, and a false version
  for (const OutputMetadata& m : pixels.metadata)
    std::visit([&](const auto& value) { spec.attribute(m.name, value); }, m.value);
  return spec;
}

}  // namespace

std::vector<unsigned char> oiio_encode(const DisplayPixels& pixels, const std::string& format, int jpeg_quality) {
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  const auto output = OIIO::ImageOutput::create(format);
  if (!output || !output->supports("ioproxy")) throw std::runtime_error("this OpenImageIO cannot write the format");
  output->set_ioproxy(&memory);
  const OIIO::ImageSpec spec = file_spec(pixels, format, jpeg_quality);
  if (!output->open("picture." + format, spec) || !output->write_image(spec.format, pixels.bytes.data()) ||
      !output->close())
    throw std::runtime_error(output->geterror());
  return bytes;
}

}  // namespace whit
