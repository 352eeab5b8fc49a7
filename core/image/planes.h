// Pictures with all that is in them, each channel by itself: what comparing reads.
#pragma once

#include <string>
#include <vector>

#include "core/image/image.h"

namespace whit {

/// A picture in memory, by channels.
struct PicturePlanes : ImageInfo {
  std::vector<SampleFormat> formats;       ///< Of each channel in the file.
  std::vector<std::vector<float>> planes;  ///< One for each channel: width x height, top row first.
};

/// Reads all channels of all parts of a picture (see read_image()). Parts of an OpenEXR file must have one size and window.
/// A channel that several parts have is "PART.CHANNEL", except in the part that holds the picture itself: the one that is
/// called rgba, rgb, beauty, main, combined or C (any case; the first of these that there is). Their order does not matter.
/// Other files with several pictures are an error, as are deep ones.
Result<PicturePlanes> read_planes(const PictureFile& file);

}  // namespace whit
