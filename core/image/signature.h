// Whether a file is a picture, by a look at its first bytes.
#pragma once

#include <cstdint>

#include "core/image/image.h"

namespace whit {

/// True when the file begins as a sound png, jpg, exr or tga does, which is worth no more than that; false when it does
/// not, cannot be read, or may be a picture of another kind: then probe_image() knows. A scene has thousands of pictures,
/// and the libraries that know all kinds take longer to load than many a scene.
bool begins_like_a_picture(const PictureFile& file);

/// Kinds that have a reader of their own; of TGA only the common ones, of JPEG all.
enum class PictureKind : uint8_t { Png, Jpeg, Tga, Other };

/// What the file begins as.
PictureKind kind_of_picture(const PictureFile& file);

}  // namespace whit
