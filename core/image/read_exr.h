// OpenEXR files with all their parts, for read_planes().
#pragma once

#include <string>

#include "core/image/planes.h"

namespace whit {

/// All channels of all parts. Throws std::exception with the reason, which does not name the file.
PicturePlanes read_exr_planes(const std::string& path);

}  // namespace whit
