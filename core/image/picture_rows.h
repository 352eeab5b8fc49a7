// A picture as it comes out of its file: one row after another, so that whoever wants less than all of it, or its means,
// need not have all of it in memory.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/image/image.h"

namespace whit {

/// An open picture. All functions throw std::runtime_error with the reason, which does not name the file.
class PictureRows {
 public:
  PictureRows() = default;
  virtual ~PictureRows() = default;
  PictureRows(const PictureRows&) = delete;
  PictureRows& operator=(const PictureRows&) = delete;

  /// The next row of a picture of 8-bit numbers (SampleFormat::UInt8): width x channels of them. It stays until the next
  /// call.
  virtual const uint8_t* next_bytes() = 0;

  /// The same of any other picture, integers divided by their maximum.
  virtual const float* next_floats() = 0;

  /// The most memory that reading takes.
  virtual size_t memory() const = 0;

  /// Whether the file holds other pictures behind this one, such as pages. Ends the reading of rows.
  virtual bool has_more_pictures() { return false; }

  ImageInfo info;             ///< What the header says; the picture has a pixel at least.
  bool bottom_first = false;  ///< The last row comes first, the first last.
};

}  // namespace whit
