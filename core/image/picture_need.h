// How much memory pictures are going to take, told by their headers.
#pragma once

#include <optional>

#include "core/image/image.h"
#include "core/image/texture_store.h"
#include "core/plugin/memory_need.h"

namespace whit {

/// Of an image texture. Zeros where the file is none that can be read, and of small files of kinds that only
/// OpenImageIO knows: loading that takes longer than many a scene.
MemoryNeed texture_need(const TextureSpec& spec);

/// What is told of a picture before it is read.
struct PictureHeader {
  ImageInfo info;
  size_t reading = 0;  ///< Bytes that its reader takes beside the numbers that it gives.
};

/// The header of a picture, under the same conditions: nothing where it is not told.
std::optional<PictureHeader> quick_header(const PictureFile& file);

}  // namespace whit
