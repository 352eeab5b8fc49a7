// The encoders behind write_image(), a file for each library. They get pictures that are checked already.
#pragma once

#include <string>
#include <vector>

#include "core/image/atomic_file.h"
#include "core/image/write.h"

namespace whit {

/// A picture as the display formats store it.
struct DisplayPixels {
  int width = 0, height = 0;               ///< In pixels.
  int bits = 8;                            ///< Of a number: 8 or 16.
  std::vector<unsigned char> bytes;        ///< height x width x 3 numbers, top row first, in the machine's byte order.
  std::vector<OutputMetadata> metadata{};  ///< For the header, as far as the format has a place for it.
};

/// Writes ZIP-compressed scanlines, half or float, with the picture's layers, windows and metadata.
/// Throws std::exception with the library's reason; failures of the file itself are kept in `file`.
void write_exr(AtomicFile& file, const OutputImage& image, bool full_float);

/// The bytes of a PNG file. Throws std::runtime_error with the library's reason.
std::vector<unsigned char> encode_png(const DisplayPixels& pixels);

/// The bytes of a JPEG file, of 8 bits, for pages: write_image() knows more. Throws like encode_png().
std::vector<unsigned char> encode_jpeg(const DisplayPixels& pixels, int quality);

}  // namespace whit
