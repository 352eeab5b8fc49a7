#include "core/image/image.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "core/image/oiio/module.h"
#include "core/image/signature.h"

namespace whit {
namespace {

std::string read_error(const std::string& path, std::string reason) {
  while (!reason.empty() && (reason.back() == '\n' || reason.back() == '.')) reason.pop_back();
  if (reason.empty()) reason = "not a picture in a known format";
  return fmt::format("cannot read image \"{}\": {}", path, reason);
}

// Why a path cannot be a picture at all, or "": OpenImageIO's own texts for these name formats, not reasons.
std::string file_problem(const std::string& path) {
  std::error_code ec;
  const auto status = std::filesystem::status(path, ec);
  if (!std::filesystem::exists(status)) return "no such file";
  if (std::filesystem::is_directory(status)) return "it is a folder";
  if (std::FILE* file = std::fopen(path.c_str(), "rb")) {
    const bool empty = std::fgetc(file) == EOF;
    std::fclose(file);
    return empty ? "the file is empty" : "";
  }
  return std::strerror(errno);
}

const PictureReader& reader_of(const std::string& path) { return begins_like_a_png(path) ? kPngReader : oiio().reader; }

// What `read` makes of a file, or an error that names it.
template <class T>
Result<T> read_file(const std::string& path, T (*PictureReader::*read)(const std::string&)) {
  try {
    if (std::string problem = file_problem(path); !problem.empty()) return {{}, read_error(path, problem)};
    return {(reader_of(path).*read)(path), ""};
  } catch (const std::bad_alloc&) {
    return {{}, read_error(path, "not enough memory")};
  } catch (const std::exception& e) { return {{}, read_error(path, e.what())}; }
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

Result<ImageInfo> probe_image(const std::string& path) { return read_file(path, &PictureReader::probe); }

Result<Image> read_image(const std::string& path) { return read_file(path, &PictureReader::read); }

Result<ByteImage> read_byte_image(const std::string& path) { return read_file(path, &PictureReader::read_bytes); }

}  // namespace whit
