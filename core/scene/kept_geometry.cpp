#include "core/scene/kept_geometry.h"

#include <cstring>
#include <string_view>
#include <type_traits>
#include <utility>

#include "core/base/file_state.h"

namespace whit {
namespace {

void append_bytes(std::string& key, const void* bytes, size_t count) {
  key.append(static_cast<const char*>(bytes), count);
}

template <class T>
void append_number(std::string& key, T number) {
  static_assert(std::is_arithmetic_v<T>);
  append_bytes(key, &number, sizeof number);
}

void append_text(std::string& key, std::string_view text) {
  append_number(key, text.size());
  key += text;
}

/// A name of a file stands for what is in it; another text stands for itself, for there is no file of that name.
void append_string(std::string& key, const std::string& text, const std::string& folder) {
  append_text(key, text);
  const FileState state = file_state(!text.empty() && text[0] == '/' ? text : folder + '/' + text);
  append_number(key, state.size);
  append_number(key, state.seconds);
  append_number(key, state.nanoseconds);
  append_number(key, state.inode);
}

/// Long lists of numbers by their hash and length: a key is compared far more often than made.
template <class T>
void append_list(std::string& key, const std::vector<T>& list) {
  const std::string_view bytes(reinterpret_cast<const char*>(list.data()), list.size() * sizeof(T));
  append_number(key, bytes.size());
  if (bytes.size() <= 64) key += bytes;
  else append_number(key, std::hash<std::string_view>()(bytes));
}

}  // namespace

void KeptGeometry::begin() {
  std::erase_if(meshes_, [](const auto& entry) { return !entry.second.used; });
  for (auto& entry : meshes_) entry.second.used = false;
  found_ = built_ = 0;
}

std::shared_ptr<const KeptMesh> KeptGeometry::find(const std::string& key) {
  const std::lock_guard lock(mutex_);
  const auto found = meshes_.find(key);
  if (found == meshes_.end()) return nullptr;
  found->second.used = true;
  ++found_;
  return found->second.mesh;
}

void KeptGeometry::put(const std::string& key, std::shared_ptr<const KeptMesh> mesh) {
  const std::lock_guard lock(mutex_);
  ++built_;
  meshes_[key] = {std::move(mesh), true};
}

std::string mesh_key(const ShapeDescription& shape, const std::string& folder, const MeshAttributes& attributes) {
  std::string key = shape.plugin;
  key += attributes.uvs1 ? '1' : '0';
  key += attributes.colors ? '1' : '0';
  if (shape.mesh) {
    const std::string identity = shape.mesh->identity();
    if (identity.empty()) return {};
    append_text(key, identity);
  }
  for (const Parameter& p : shape.params) {
    append_number(key, static_cast<uint8_t>(p.type));
    append_text(key, p.name);
    for (const std::string& text : p.strings()) append_string(key, text, folder);
    for (const TextureRef& texture : p.textures()) append_text(key, texture.name);
    append_list(key, p.numbers());
    append_list(key, p.integers());
    append_list(key, p.bools());
  }
  return key;
}

}  // namespace whit
