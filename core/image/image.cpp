#include "core/image/image.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <new>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "core/base/file_state.h"
#include "core/base/limits.h"
#include "core/image/decode.h"
#include "core/image/exr_header.h"
#include "core/image/oiio/module.h"
#include "core/image/picture_change.h"
#include "core/image/signature.h"
#include "core/plugin/memory_limit.h"

namespace whit {
namespace {

// Of no format, as a file is of which nothing has been written yet. Readers of some formats would go through all of it.
bool begins_with_zeros(const std::string& path) {
  std::array<char, 64> head{};
  std::ifstream in(path, std::ios::binary);
  in.read(head.data(), head.size());
  return in.gcount() == head.size() && std::all_of(head.begin(), head.end(), [](char c) { return c == 0; });
}

// Why a path cannot be a picture at all, or "": OpenImageIO's own texts for these name formats, not reasons.
std::string file_problem(const PictureFile& picture) {
  if (picture.bytes) return picture.bytes->bytes.empty() ? "it has no bytes" : "";
  const FileState state = file_state(picture.path);
  if (!state.exists()) return "no such file";
  if (std::error_code ignored; std::filesystem::is_directory(picture.path, ignored)) return "it is a folder";
  const std::string problem = why_unreadable(picture.path);
  if (!problem.empty()) return problem;
  if (state.size == 0) return "the file is empty";
  return begins_with_zeros(picture.path) ? "not a picture in a known format: it begins with zeros" : "";
}

template <class T>
Result<T> failed(const PictureFile& file, const std::exception& e) {
  Result<T> result;
  result.error = picture_error(file.path, e);
  result.out_of_memory = is_out_of_memory(e);
  return result;
}

template <class T, class Take>
Result<T> taken(const PictureFile& file, const Take& take) {
  try {
    return {take(*open_picture(file)), ""};
  } catch (const std::exception& e) { return failed<T>(file, e); }
}

// What `take` makes of an open file, or an error that names it. A file that is being written looks like one that is
// damaged, or like none of both.
template <class T, class Take>
Result<T> from_file(const PictureFile& file, const Take& take) {
  const FileState before = state_of(file);
  Result<T> result = taken<T>(file, take);
  const std::string change = change_of(file, before);
  return change.empty() ? std::move(result) : failed<T>(file, std::runtime_error(change));
}

Image read_all(PictureRows& rows) {
  Image image;
  static_cast<ImageInfo&>(image) = rows.info;
  const size_t row = static_cast<size_t>(image.width) * image.channels;
  need_memory(rows.memory() + sizeof(float) * row * image.height,
              fmt::format("reading all of its {} x {} pixels", image.width, image.height));
  image.pixels.resize(row * image.height);
  for (int y = 0; y < image.height; ++y) {
    float* const to = image.pixels.data() + row * (rows.bottom_first ? image.height - 1 - y : y);
    if (image.format == SampleFormat::UInt8) {
      const uint8_t* const from = rows.next_bytes();
      std::transform(from, from + row, to, [](uint8_t v) { return static_cast<float>(v) / 255; });
    } else {
      std::copy_n(rows.next_floats(), row, to);
    }
  }
  return image;
}

}  // namespace

int ImageInfo::channel(const std::string& name) const {
  for (size_t c = 0; c < channel_names.size(); ++c)
    if (channel_names[c] == name) return static_cast<int>(c);
  return -1;
}

std::vector<int> ImageInfo::rgb_channels() const {
  const std::vector<int> named{channel("R"), channel("G"), channel("B")};
  if (named[0] >= 0 && named[1] >= 0 && named[2] >= 0) return named;
  if (channels >= 3) return {0, 1, 2};
  return {0, 0, 0};
}

std::unique_ptr<PictureRows> open_picture(const PictureFile& file) {
  if (const std::string problem = file_problem(file); !problem.empty()) throw std::runtime_error(problem);
  switch (kind_of_picture(file)) {
    case PictureKind::Png: return open_png(file);
    case PictureKind::Jpeg: return open_jpeg(file);
    case PictureKind::Tga: return open_tga(file);
    default: break;
  }
  if (const std::string problem = exr_header_problem(file); !problem.empty()) throw std::runtime_error(problem);
  return oiio().open(file);
}

std::string picture_error(const std::string& path, const std::exception& e) {
  const bool is_wordless = is_out_of_memory(e) && !dynamic_cast<const OutOfMemory*>(&e);
  std::string reason = is_wordless ? "not enough memory" : e.what();
  while (!reason.empty() && (reason.back() == '\n' || reason.back() == '.')) reason.pop_back();
  if (reason.empty()) reason = "not a picture in a known format";
  return fmt::format("cannot read image \"{}\": {}", path, reason);
}

bool is_out_of_memory(const std::exception& e) { return dynamic_cast<const std::bad_alloc*>(&e) != nullptr; }

Result<ImageInfo> probe_image(const PictureFile& file) {
  return from_file<ImageInfo>(file, [](const PictureRows& rows) { return rows.info; });
}

Result<Image> read_image(const PictureFile& file) { return from_file<Image>(file, read_all); }

}  // namespace whit
