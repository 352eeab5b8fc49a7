// Pictures: where they are. None is decoded.
#include <fmt/format.h>

#include <algorithm>

#include "core/base/mapped_picture.h"
#include "core/base/plain_text.h"
#include "core/gltf/model_parts.h"

namespace whit::gltf {
namespace {

/// "png" of "image/png".
std::string extension_of_type(const std::string& mime_type) {
  static constexpr std::pair<const char*, const char*> kTypes[] = {{"image/png", "png"},
                                                                   {"image/jpeg", "jpg"},
                                                                   {"image/jpg", "jpg"},
                                                                   {"image/webp", "webp"},
                                                                   {"image/ktx2", "ktx2"}};
  for (const auto& [type, extension] : kTypes)
    if (mime_type == type) return extension;
  return {};
}

/// "jpg" of "wood.JPEG".
std::string extension_of_file(const std::string& file) {
  const size_t dot = file.find_last_of("./");
  if (dot == file.npos || file[dot] != '.') return {};
  const std::string out = lower_case(file.substr(dot + 1));
  return out == "jpeg" ? "jpg" : out == "png" || out == "jpg" || out == "webp" || out == "ktx2" ? out : std::string();
}

/// What the first bytes say, for files that say nothing else.
std::string extension_of_bytes(std::span<const uint8_t> bytes) {
  const std::string_view start(reinterpret_cast<const char*>(bytes.data()), std::min<size_t>(bytes.size(), 12));
  if (start.substr(0, 4) == "\x89PNG") return "png";
  if (start.substr(0, 3) == "\xff\xd8\xff") return "jpg";
  if (start.substr(0, 4) == "RIFF" && start.size() == 12 && start.substr(8) == "WEBP") return "webp";
  return start.size() > 6 && start.substr(1, 4) == "KTX " ? "ktx2" : "";
}

void read_image(const Item& item, const LoadOptions& options, const Buffers& buffers, const Model& model, Image& to) {
  to.name = item.text("name").value_or("");
  const std::string mime_type = item.text("mimeType").value_or("");
  to.extension = extension_of_type(mime_type);
  Bytes bytes;
  if (item.has("uri") == item.has("bufferView")) {
    return item.error(item.has("uri") ? "has both a \"uri\" and a \"bufferView\""
                                      : "has neither a \"uri\" nor a \"bufferView\"");
  }
  if (item.has("bufferView")) {
    const int view = item.index("bufferView", {"bufferViews", buffers.views.size()});
    if (view < 0) return;
    bytes = buffers.plain_view(view);
    if (buffers.views[static_cast<size_t>(view)].compression)
      return item.error_at("bufferView", "is compressed, which pictures cannot be");
  } else {
    auto resource = resolve(item, "uri", model.folder, options);
    if (!resource) return;
    if (!resource->data) {
      to.file = resource->file;
      if (to.extension.empty()) to.extension = extension_of_file(to.file);
      return;
    }
    auto data = std::make_shared<const std::vector<uint8_t>>(std::move(*resource->data));
    bytes = {*data, data};
    if (to.extension.empty()) to.extension = extension_of_type(resource->mime_type);
  }
  if (to.extension.empty()) to.extension = extension_of_bytes(bytes.bytes);
  std::shared_ptr<PictureBytes> inside = std::make_shared<PictureBytes>();
  if (bytes.file) inside = std::make_shared<MappedPicture>(bytes.file);
  inside->name = model.at(item.place());
  inside->bytes = bytes.bytes;
  inside->owner = bytes.owner;
  to.inside = std::move(inside);
}

}  // namespace

void read_images(const Item& root, const LoadOptions& options, const Buffers& buffers, Model& to) {
  root.objects("images", [&](const Item& item, size_t i) {
    to.images.resize(i + 1);
    read_image(item, options, buffers, to, to.images[i]);
  });
}

}  // namespace whit::gltf
