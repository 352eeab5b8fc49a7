#include "core/image/image.h"

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <exception>
#include <filesystem>
#include <memory>

namespace whit {
namespace {

using InputPtr = std::unique_ptr<OIIO::ImageInput>;

std::string read_error(const std::string& path, std::string reason) {
  while (!reason.empty() && (reason.back() == '\n' || reason.back() == '.')) reason.pop_back();
  if (reason.empty()) reason = "not a picture in a known format";
  return fmt::format("cannot read image \"{}\": {}", path, reason);
}

// Why a path cannot be a picture at all, or "": OpenImageIO's own texts for these name formats, not reasons.
std::string file_problem(const std::string& path) {
  std::error_code ec;
  const auto status = std::filesystem::status(path, ec);
  if (!std::filesystem::exists(status)) return "no such file";
  if (std::filesystem::is_directory(status)) return "it is a folder";
  if (std::FILE* file = std::fopen(path.c_str(), "rb")) {
    const bool empty = std::fgetc(file) == EOF;
    std::fclose(file);
    return empty ? "the file is empty" : "";
  }
  return std::strerror(errno);
}

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

// A header may lie, and allocating what it claims can take the machine down. No format in use packs
// a picture tighter than this.
constexpr double kMostBytesPerFileByte = 40000;

std::string header_problem(const std::string& path, const OIIO::ImageSpec& spec) {
  if (spec.width <= 0 || spec.height <= 0 || spec.nchannels <= 0) return "it has no pixels";
  if (spec.depth > 1) return "it is a volume, not a picture";
  if (spec.deep) return "deep pictures are not supported";
  const double bytes = 4.0 * spec.width * spec.height * spec.nchannels;
  std::error_code ec;
  const auto size = std::filesystem::file_size(path, ec);
  if (bytes > double(1 << 26) && !ec && bytes > kMostBytesPerFileByte * static_cast<double>(size))
    return fmt::format("the header claims {} x {} pixels, but the file has only {} bytes", spec.width, spec.height,
                       size);
  return "";
}

// OpenImageIO multiplies by 1/255, which is an ulp off for some bytes; the quotient is what pbrt-v3 computes.
void divide_exactly(const OIIO::ImageSpec& spec, std::vector<float>& pixels) {
  const float most = spec.format == OIIO::TypeDesc::UINT8 ? 255 : spec.format == OIIO::TypeDesc::UINT16 ? 65535 : 0;
  if (most == 0 || !spec.channelformats.empty()) return;
  for (float& v : pixels) v = std::nearbyint(v * most) / most;
}

// Opens a file and copies its header; `error` stays empty on success.
InputPtr open_image(const std::string& path, ImageInfo& info, std::string& error) {
  if (std::string problem = file_problem(path); !problem.empty()) {
    error = read_error(path, problem);
    return nullptr;
  }
  OIIO::ImageSpec config;
  config.attribute("oiio:UnassociatedAlpha", 1);  // pbrt ignores alpha: colour must not be multiplied by it
  InputPtr input = OIIO::ImageInput::open(path, &config);
  if (!input) {
    error = read_error(path, OIIO::geterror());
    return nullptr;
  }
  if (std::string problem = header_problem(path, input->spec()); !problem.empty()) {
    error = read_error(path, problem);
    return nullptr;
  }
  copy_header(input->spec(), info);
  return input;
}

}  // namespace

int ImageInfo::channel(const std::string& name) const {
  for (size_t c = 0; c < channel_names.size(); ++c)
    if (channel_names[c] == name) return static_cast<int>(c);
  return -1;
}

std::vector<int> ImageInfo::rgb_channels() const {
  const std::vector<int> named{channel("R"), channel("G"), channel("B")};
  if (named[0] >= 0 && named[1] >= 0 && named[2] >= 0) return named;
  if (channels >= 3) return {0, 1, 2};
  return {0, 0, 0};
}

Result<ImageInfo> probe_image(const std::string& path) {
  Result<ImageInfo> result;
  try {
    open_image(path, result.value, result.error);
  } catch (const std::exception& e) { result.error = read_error(path, e.what()); }
  return result;
}

Result<Image> read_image(const std::string& path) {
  Result<Image> result;
  Image& image = result.value;
  try {
    InputPtr input = open_image(path, image, result.error);
    if (!input) return result;
    image.pixels.resize(static_cast<size_t>(image.width) * image.height * image.channels);
    if (!input->read_image(0, 0, 0, image.channels, OIIO::TypeDesc::FLOAT, image.pixels.data()))
      result.error = read_error(path, input->geterror());
    divide_exactly(input->spec(), image.pixels);
  } catch (const std::bad_alloc&) {
    result.error = read_error(path, "not enough memory");
  } catch (const std::exception& e) { result.error = read_error(path, e.what()); }
  if (!result.ok()) image.pixels.clear();
  return result;
}

}  // namespace whit
