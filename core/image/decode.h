// The decoders behind open_picture(): one each for the kinds that most textures are, so that OpenImageIO
// (core/image/oiio/module.h) need not be there, and that for everything else.
#pragma once

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/image/picture_rows.h"

namespace whit {

/// Open a picture of that kind.
std::unique_ptr<PictureRows> open_png(const PictureFile& file);
std::unique_ptr<PictureRows> open_jpeg(const PictureFile& file);
std::unique_ptr<PictureRows> open_tga(const PictureFile& file);

/// Opens a picture of any kind that is known.
std::unique_ptr<PictureRows> open_picture(const PictureFile& file);

/// The error for users, which names the file, when opening or reading it has thrown `e`.
std::string picture_error(const std::string& path, const std::exception& e);
/// Whether that was for lack of memory.
bool is_out_of_memory(const std::exception& e);

/// A file that is closed when its owner goes.
using FilePtr = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

/// Opens a picture to be read; throws the reason why not. The bytes in memory must stay there meanwhile.
inline FilePtr open_to_read(const PictureFile& picture) {
  const auto memory = [&](std::span<const uint8_t> bytes) {
    return ::fmemopen(const_cast<uint8_t*>(bytes.data()), bytes.size(), "rb");
  };
  FilePtr file(picture.bytes ? memory(picture.bytes->bytes) : std::fopen(picture.path.c_str(), "rb"), std::fclose);
  if (!file) throw std::runtime_error(std::strerror(errno));
  return file;
}

/// Fills in the header of a picture that is all of its window. On sRGB's scale, as OpenImageIO has it of these formats
/// where a file says nothing else.
inline void set_header(ImageInfo& info, int width, int height, SampleFormat format, std::vector<std::string> channels) {
  info.width = info.full_width = width;
  info.height = info.full_height = height;
  info.format = format;
  info.channels = static_cast<int>(channels.size());
  info.channel_names = std::move(channels);
  info.metadata["oiio:ColorSpace"] = "sRGB";
}

/// Why a header cannot be true, or "": a header may lie, and allocating what it claims can take the machine down.
inline std::string size_problem(const PictureFile& file, const ImageInfo& info) {
  // No format in use packs a picture tighter than this.
  constexpr double kMostBytesPerFileByte = 40000;
  const double bytes = 4.0 * info.width * info.height * info.channels;
  std::error_code ec;
  const auto size = file.bytes ? file.bytes->bytes.size() : std::filesystem::file_size(file.path, ec);
  if (bytes <= double(1 << 26) || ec || bytes <= kMostBytesPerFileByte * static_cast<double>(size)) return "";
  return fmt::format("the header claims {} x {} pixels, but the file has only {} bytes", info.width, info.height, size);
}

}  // namespace whit
