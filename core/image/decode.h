// The decoders behind read_image(): libspng for PNG, OpenImageIO (core/image/oiio/module.h) for everything else.
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <string>

#include "core/image/image.h"

namespace whit {

/// One decoder. All throw std::runtime_error with the reason, which does not name the file.
struct PictureReader {
  ImageInfo (*probe)(const std::string& path);
  Image (*read)(const std::string& path);
  ByteImage (*read_bytes)(const std::string& path);
};

/// Reads PNG files.
extern const PictureReader kPngReader;

/// Why a header cannot be true, or "": a header may lie, and allocating what it claims can take the machine down.
inline std::string size_problem(const std::string& path, const ImageInfo& info) {
  // No format in use packs a picture tighter than this.
  constexpr double kMostBytesPerFileByte = 40000;
  const double bytes = 4.0 * info.width * info.height * info.channels;
  std::error_code ec;
  const auto size = std::filesystem::file_size(path, ec);
  if (bytes <= double(1 << 26) || ec || bytes <= kMostBytesPerFileByte * static_cast<double>(size)) return "";
  return fmt::format("the header claims {} x {} pixels, but the file has only {} bytes", info.width, info.height, size);
}

}  // namespace whit
