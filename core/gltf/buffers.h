// The bytes of a model and how its accessors lie in them. All of it was checked when the model was loaded: every accessor
// lies within its buffer view, and every buffer view within its buffer.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/gltf/check.h"
#include "core/gltf/document.h"
#include "core/gltf/model.h"

namespace whit::gltf {

/// Bytes and what keeps them.
struct Bytes {
  std::span<const uint8_t> bytes;
  std::shared_ptr<const void> owner;
  std::shared_ptr<const MappedFile> file = nullptr;  ///< Where they lie in one.
};

enum class Component { Int8, Uint8, Int16, Uint16, Uint32, Float };
size_t size_of(Component c);

/// EXT_meshopt_compression, of a buffer view: it is the result.
struct Compression {
  int buffer = -1;
  uint64_t offset = 0, length = 0;
  uint64_t stride = 0, count = 0;
  enum class Mode { Attributes, Triangles, Indices } mode = Mode::Attributes;
  enum class Filter { None, Octahedral, Quaternion, Exponential } filter = Filter::None;
};

struct BufferView {
  int buffer = -1;  ///< Or -1 where the bytes are only there compressed.
  uint64_t offset = 0, length = 0;
  uint64_t stride = 0;  ///< 0: elements follow each other.
  std::optional<Compression> compression;
};

/// The elements of an accessor that are not those of its buffer view.
struct Sparse {
  uint64_t count = 0;
  int index_view = -1, value_view = -1;
  uint64_t index_offset = 0, value_offset = 0;
  Component index_type = Component::Uint32;
};

struct Accessor {
  int view = -1;  ///< -1: all numbers are 0, but for the sparse ones.
  uint64_t offset = 0, count = 0;
  Component component = Component::Float;
  int rows = 1, columns = 1;  ///< A vector has one column.
  bool normalized = false;
  std::optional<Sparse> sparse;
  int numbers() const { return rows * columns; }
  /// Columns of matrices begin at multiples of four bytes.
  size_t column_size() const {
    const size_t size = static_cast<size_t>(rows) * size_of(component);
    return columns > 1 ? (size + 3) / 4 * 4 : size;
  }
  size_t element_size() const {
    return column_size() * static_cast<size_t>(columns - 1) + static_cast<size_t>(rows) * size_of(component);
  }
};

class Buffers {
 public:
  std::vector<Bytes> buffers;
  std::vector<BufferView> views;
  std::vector<Accessor> accessors;
  std::vector<std::string> files;  ///< Of buffers outside of the model's own.

  /// "", or what has happened to the files since they were opened: "model.bin: it changed while it was read". To be asked
  /// when something was read of them.
  std::string problem() const;

  /// Makes room for what is decompressed; when all views are there.
  void prepare() { decoded_ = std::make_unique<Decoded[]>(views.size()); }
  /// The bytes of a view, decompressed when asked for the first time. Returns "", or what is wrong. Thread-safe.
  std::string view(int view, std::span<const uint8_t>& out) const;
  /// The same with what keeps them.
  Bytes plain_view(int view) const;

 private:
  /// Of a compressed view.
  struct Decoded {
    std::once_flag once;
    std::string error;
    std::vector<uint8_t> bytes;
  };
  std::unique_ptr<Decoded[]> decoded_;
};

/// What is wrong with the indices of sparse elements, or "": they must increase and name elements.
std::string sparse_problem(const Accessor& a, const Sparse& s, std::span<const uint8_t> indices);

/// Decodes base64; nullopt when it is not.
std::optional<std::vector<uint8_t>> decode_base64(std::string_view text);

/// A URI of the file: data, or a file.
struct Resource {
  std::optional<std::vector<uint8_t>> data;
  std::string mime_type;  ///< Of data.
  std::string file;       ///< Absolute.
};

/// Resolves the URI that is an item's member. Reports what is wrong, as a file outside of the folder.
std::optional<Resource> resolve(const Item& item, const char* key, const std::string& folder,
                                const LoadOptions& options);

/// Decodes EXT_meshopt_compression. `out` has room for count * stride bytes. Returns "", or what is wrong.
std::string decompress(const Compression& c, std::span<const uint8_t> bytes, std::vector<uint8_t>& out);

}  // namespace whit::gltf
