// Whether a picture has stayed the same while it was read.
#pragma once

#include <string>

#include "core/base/file_state.h"
#include "core/base/mapped_picture.h"
#include "core/image/image.h"

namespace whit {

/// What a picture's file is; of bytes in memory nothing.
inline FileState state_of(const PictureFile& picture) { return picture.bytes ? FileState{} : file_state(picture.path); }

/// "", or what has happened to a picture since its file was `before`: what was read of it is of no use then.
inline std::string change_of(const PictureFile& picture, const FileState& before) {
  if (const auto* mapped = dynamic_cast<const MappedPicture*>(picture.bytes.get())) return mapped->problem();
  return state_of(picture) == before ? "" : kChangedWhileRead;
}

}  // namespace whit
