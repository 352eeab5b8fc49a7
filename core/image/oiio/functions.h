// The functions of the module, for module.cpp to hand out; the table in module.h says what they do.
#pragma once

#include "core/image/oiio/module.h"

namespace whit {

std::unique_ptr<PictureRows> oiio_open(const PictureFile& file);
/// WebP, which OpenImageIO reads otherwise than needed, see webp.cpp.
bool is_webp(const PictureFile& picture);
std::unique_ptr<PictureRows> open_webp(const PictureFile& file);

/// That a file is shorter than its header says, where OpenImageIO does not notice (DPX), or "".
std::string length_problem(const PictureFile& picture);

std::vector<unsigned char> oiio_encode(const DisplayPixels& pixels, const std::string& format, int jpeg_quality);

}  // namespace whit
