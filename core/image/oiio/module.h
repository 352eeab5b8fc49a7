// What whit asks of OpenImageIO. It lives in a module of its own, whit_oiio.so, which is loaded when first needed:
// Debian's OpenImageIO brings some 250 libraries along, and linking them takes longer than many a picture.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/image/encode.h"
#include "core/image/picture_rows.h"

namespace whit {

/// The module's functions.
struct Oiio {
  /// Opens a picture. Throws std::runtime_error with the reason, which does not name the file.
  std::unique_ptr<PictureRows> (*open)(const PictureFile& file);

  /// The bytes of a file of that kind: "tga", "jpg", "jpeg", "tif" or "tiff". Throws std::runtime_error with
  /// the reason.
  std::vector<unsigned char> (*encode)(const DisplayPixels& pixels, const std::string& format, int jpeg_quality);
};

/// The module, loaded by the first call of the process (any thread). Throws std::runtime_error when it is missing.
const Oiio& oiio();

}  // namespace whit
