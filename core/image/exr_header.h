// Headers of OpenEXR files that lie.
#pragma once

#include <string>

#include "core/image/image.h"

namespace whit {

/// Which entry of an OpenEXR file's headers claims to be longer than the file, or "": OpenEXR makes room for all that an
/// entry claims, and fills it with zeros, before it reads the first byte. "" too for other files and for headers that are
/// cut off, which readers notice by themselves. Throws the reason when the file cannot be opened.
/// Source: OpenEXR File Layout, openexr.com, section "Header".
std::string exr_header_problem(const PictureFile& file);

}  // namespace whit
