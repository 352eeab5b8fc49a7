#include <OpenEXR/ImfTestFile.h>
#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "core/base/limits.h"
#include "core/image/decode.h"
#include "core/image/picture_change.h"
#include "core/image/planes.h"
#include "core/image/read_exr.h"
#include "core/plugin/memory_limit.h"

namespace whit {
namespace {

// One row, channel by channel, to its place in the planes.
template <class Number, class Of>
void spread_row(const Number* from, int channels, size_t width, size_t at, std::vector<std::vector<float>>& planes,
                const Of& of) {
  for (int c = 0; c < channels; ++c) {
    float* const to = planes[static_cast<size_t>(c)].data() + at;
    for (size_t x = 0; x < width; ++x) to[x] = of(from[x * static_cast<size_t>(channels) + static_cast<size_t>(c)]);
  }
}

PicturePlanes read_rows(const PictureFile& file) {
  const std::unique_ptr<PictureRows> rows = open_picture(file);
  PicturePlanes picture;
  static_cast<ImageInfo&>(picture) = rows->info;
  const auto width = static_cast<size_t>(picture.width);
  need_memory(rows->memory() +
                  sizeof(float) * width * static_cast<size_t>(picture.height) * static_cast<size_t>(picture.channels),
              fmt::format("reading all of its {} x {} pixels", picture.width, picture.height));
  picture.formats.assign(static_cast<size_t>(picture.channels), picture.format);
  picture.planes.assign(picture.formats.size(), std::vector<float>(width * static_cast<size_t>(picture.height)));
  for (int y = 0; y < picture.height; ++y) {
    const size_t at = width * static_cast<size_t>(rows->bottom_first ? picture.height - 1 - y : y);
    if (picture.format == SampleFormat::UInt8)
      spread_row(rows->next_bytes(), picture.channels, width, at, picture.planes,
                 [](uint8_t v) { return static_cast<float>(v) / 255; });
    else spread_row(rows->next_floats(), picture.channels, width, at, picture.planes, [](float v) { return v; });
  }
  if (rows->has_more_pictures()) throw std::runtime_error("it holds several pictures, and which is meant is not known");
  return picture;
}

}  // namespace

Result<PicturePlanes> read_planes(const PictureFile& file) {
  const FileState before = state_of(file);
  Result<PicturePlanes> result;
  try {
    // A pipe would be waited for.
    const bool on_disk = !file.bytes && why_unreadable(file.path).empty();
    result.value = on_disk && Imf::isOpenExrFile(file.path.c_str()) ? read_exr_planes(file.path) : read_rows(file);
  } catch (const std::exception& e) {
    result.error = picture_error(file.path, e), result.out_of_memory = is_out_of_memory(e);
  }
  if (const std::string change = change_of(file, before); !change.empty())
    result.error = picture_error(file.path, std::runtime_error(change));
  return result;
}

}  // namespace whit
