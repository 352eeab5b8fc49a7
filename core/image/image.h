// Reading pictures of any kind that is known, as plain arrays of floats, top row first.
//
// Nothing is decoded: the numbers are the file's, integers divided by their maximum, so an 8-bit sRGB value
// 188 is 188/255 = 0.737. Alpha is never multiplied into the colour.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/base/attachment.h"

namespace whit {

/// A value, or the text that says why there is none. `error` is empty when `value` is good.
template <class T>
struct Result {
  T value{};
  std::string error;
  bool out_of_memory = false;  ///< The error is for lack of memory.
  bool ok() const { return error.empty(); }
};

/// Where a picture is: a file, or the bytes of one in memory. Paths turn into one by themselves.
struct PictureFile {
  std::string path;                           ///< Of bytes in memory their name, which is for messages.
  std::shared_ptr<const PictureBytes> bytes;  ///< Null when it is a file.
  PictureFile(std::string file) : path(std::move(file)) {}
  PictureFile(const char* file) : path(file) {}
  PictureFile(std::shared_ptr<const PictureBytes> in_memory) : path(in_memory->name), bytes(std::move(in_memory)) {}
};

/// How a file stores its numbers; of several kinds in one file, the most precise.
enum class SampleFormat : uint8_t { UInt8, UInt16, Half, Float };

/// What the header of a picture says.
struct ImageInfo {
  int width = 0, height = 0;                    ///< Size of the data window in pixels.
  int channels = 0;                             ///< Numbers per pixel.
  int x = 0, y = 0;                             ///< Upper left corner of the data window.
  int full_x = 0, full_y = 0;                   ///< Upper left corner of the display window.
  int full_width = 0, full_height = 0;          ///< Size of the display window.
  SampleFormat format = SampleFormat::Float;    ///< What the file stores.
  std::vector<std::string> channel_names;       ///< "R", "G", "B", "Albedo.R", ...: one per channel.
  std::map<std::string, std::string> metadata;  ///< The header's other entries, as text.

  /// The index of the channel with that name (case matters), -1 when there is none.
  int channel(const std::string& name) const;

  /// The channels that make the colour: R, G, B by name; else the first three; else the first three times
  /// over (grey, with or without alpha). Always three indices into a picture with at least one channel.
  std::vector<int> rgb_channels() const;

  /// The channel that is alpha, -1 when there is none.
  int alpha_channel() const { return channel("A"); }
};

/// A picture in memory.
template <class Number>
struct PixelArray : ImageInfo {
  std::vector<Number> pixels;  ///< height x width x channels, row by row, top row first, channels innermost.

  const Number* pixel(int column, int row) const {
    return pixels.data() + (static_cast<size_t>(row) * width + column) * channels;
  }
};
using Image = PixelArray<float>;
using ByteImage = PixelArray<uint8_t>;

/// Reads the header only: cheap, nothing is decoded. The error names the file and the reason.
Result<ImageInfo> probe_image(const PictureFile& file);

/// Reads a picture (exr tga png pfm jpg tiff hdr and whatever else OpenImageIO reads; the contents decide,
/// not the extension). All channels, raw: no gamma decoding, no premultiplication, no tone mapping. A header
/// that claims far more pixels than the file can hold is an error. The error names the file and the reason.
Result<Image> read_image(const PictureFile& file);

}  // namespace whit
