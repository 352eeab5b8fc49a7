#include "core/image/picture_need.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfTestFile.h>
#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <filesystem>

#include "core/image/decode.h"
#include "core/image/exr_header.h"
#include "core/image/mipmap.h"
#include "core/image/signature.h"

namespace whit {
namespace {

/// Bytes of a file that nobody but OpenImageIO reads, from which on it may hold a picture that matters.
constexpr uint64_t kLeastOfOthers = uint64_t{256} << 10;

/// What its header says, without the channels' names.
ImageInfo exr_header(const std::string& path) {
  const Imf::InputFile file(path.c_str(), 0);
  const Imath::Box2i window = file.header().dataWindow();
  ImageInfo info;
  info.width = window.max.x - window.min.x + 1, info.height = window.max.y - window.min.y + 1;
  info.format = SampleFormat::Half;
  const Imf::ChannelList& channels = file.header().channels();
  for (auto c = channels.begin(); c != channels.end(); ++c) {
    info.channel_names.emplace_back(c.name());
    if (c.channel().type != Imf::HALF) info.format = SampleFormat::Float;
  }
  info.channels = static_cast<int>(info.channel_names.size());
  return info;
}

/// Of a PFM file, as maps of light often are: "PF", or "Pf" of grey ones, width and height. Nothing of other files.
std::optional<ImageInfo> pfm_header(const PictureFile& file) {
  const FilePtr open = open_to_read(file);
  char kind = 0;
  ImageInfo info;
  if (std::fscanf(open.get(), "P%c %d %d", &kind, &info.width, &info.height) != 3 || info.width <= 0 ||
      info.height <= 0 || (kind != 'F' && kind != 'f'))
    return std::nullopt;
  info.channel_names = kind == 'F' ? std::vector<std::string>{"R", "G", "B"} : std::vector<std::string>{"Y"};
  info.channels = static_cast<int>(info.channel_names.size());
  return info;
}

uint64_t size_of(const PictureFile& file) {
  std::error_code failed;
  if (file.bytes) return file.bytes->bytes.size();
  const auto size = std::filesystem::file_size(file.path, failed);
  return failed ? 0 : size;
}

}  // namespace

std::optional<PictureHeader> quick_header(const PictureFile& file) {
  try {
    if (size_of(file) == 0) return std::nullopt;
    if (kind_of_picture(file) != PictureKind::Other) {
      const auto rows = open_picture(file);
      return PictureHeader{rows->info, rows->memory()};
    }
    if (!exr_header_problem(file).empty()) return std::nullopt;
    if (!file.bytes && Imf::isOpenExrFile(file.path.c_str())) {
      // OpenImageIO hands out strips of 256 rows.
      PictureHeader header{exr_header(file.path), 0};
      const size_t row = sizeof(float) * static_cast<size_t>(header.info.width) * header.info.channels;
      header.reading = 2 * row * std::min<size_t>(256, header.info.height);
      return header;
    }
    if (std::optional<ImageInfo> info = pfm_header(file)) {
      const size_t bytes = sizeof(float) * static_cast<size_t>(info->width) * info->height * info->channels;
      return PictureHeader{std::move(*info), bytes};
    }
    if (size_of(file) < kLeastOfOthers) return std::nullopt;
    const auto rows = open_picture(file);
    return PictureHeader{rows->info, rows->memory()};
  } catch (const std::exception&) {
    return std::nullopt;  // Whoever reads it says why.
  }
}

MemoryNeed texture_need(const TextureSpec& spec) {
  const std::optional<PictureHeader> header =
      quick_header(spec.bytes ? PictureFile(spec.bytes) : PictureFile(spec.path));
  if (!header) return {};
  const MipMapOptions options{.single = spec.kind == TextureKind::Float,
                              .alpha = spec.channel == TextureChannel::Alpha,
                              .wrap = spec.wrap,
                              .scale = spec.scale};
  MemoryNeed need;
  need.texels = MipMap::bytes_of_levels(header->info, options, 0);
  need.making = header->reading + MipMap::bytes_to_read(header->info, options);
  need.picture =
      fmt::format("{}|{}|{}|{}|{}|{}", spec.path, static_cast<const void*>(spec.bytes.get()),
                  static_cast<int>(spec.kind), static_cast<int>(spec.channel), static_cast<int>(spec.wrap), spec.scale);
  return need;
}

}  // namespace whit
