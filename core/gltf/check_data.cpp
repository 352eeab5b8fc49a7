#include "core/gltf/check_data.h"

#include <fmt/format.h>

#include <array>
#include <bit>

namespace whit::gltf {
namespace {

using Need = Item::Need;

/// No file is longer: whole numbers up to here are exact in JSON.
constexpr uint64_t kMostBytes = uint64_t{1} << 53;
/// Of accessors that no bytes stand behind: a count alone must not take memory without end.
constexpr uint64_t kMostZeros = uint64_t{1} << 25;

constexpr const char* kMeshopt = "EXT_meshopt_compression";

size_t count_of(const Item& root, const char* key) {
  const auto found = root.value().find(key);
  return found != root.value().end() && found->is_array() ? found->size() : 0;
}

class DataReader {
 public:
  DataReader(const Item& root, const Document& document, const std::string& folder, const LoadOptions& options,
             Buffers& out)
      : root_(root), document_(document), folder_(folder), options_(options), out_(out) {}

  void read() {
    out_.buffers.resize(count_of(root_, "buffers"));
    lengths_.resize(out_.buffers.size());
    fallback_.resize(out_.buffers.size());
    out_.views.resize(count_of(root_, "bufferViews"));
    out_.accessors.resize(count_of(root_, "accessors"));
    root_.objects("buffers", [&](const Item& item, size_t i) { read_buffer(item, i); });
    root_.objects("bufferViews", [&](const Item& item, size_t i) { read_view(item, out_.views[i]); });
    out_.prepare();
    root_.objects("accessors", [&](const Item& item, size_t i) { read_accessor(item, out_.accessors[i]); });
  }

 private:
  void read_buffer(const Item& item, size_t i) {
    const auto length = item.integer("byteLength", 1, kMostBytes, Need::Required);
    item.object("extensions", [&](const Item& extensions) {
      extensions.object(kMeshopt, [&](const Item& meshopt) { fallback_[i] = meshopt.boolean("fallback"); });
    });
    if (!length) return;
    lengths_[i] = *length;
    Bytes& bytes = out_.buffers[i];
    if (item.has("uri")) read_resource(item, bytes);
    else if (i == 0 && document_.has_chunk) bytes = {document_.chunk, document_.file, document_.file};
    else if (!fallback_[i]) return item.error("has no \"uri\", and the file has no buffer inside of it");
    // Where there are none the reason has been said.
    if (bytes.owner && bytes.bytes.size() < *length) {
      item.error_at("byteLength", fmt::format("is {}, and there are {} bytes", *length, bytes.bytes.size()),
                    "the file is cut off: get or export it again");
      bytes = {};
    }
    if (bytes.owner) bytes.bytes = bytes.bytes.first(*length);
  }

  void read_resource(const Item& item, Bytes& out) {
    auto resource = resolve(item, "uri", folder_, options_);
    if (!resource) return;
    if (resource->data) {
      auto data = std::make_shared<const std::vector<uint8_t>>(std::move(*resource->data));
      out = {*data, data};
      return;
    }
    out_.files.push_back(resource->file);
    auto file = std::make_shared<const MappedFile>(resource->file);
    if (!file->error().empty()) {
      item.problems().file_error(item.place("uri"),
                                 fmt::format("cannot open {}: {}", shown_text(resource->file, 300), file->error()),
                                 "put the file where the model has it, or export it as a .glb, which is one file");
      return;
    }
    const std::string_view bytes = file->bytes();
    out = {{reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()}, file, file};
  }

  /// The buffer, offset and length of a view or of a compressed one. False when it is not within the buffer.
  bool read_range(const Item& item, int& buffer, uint64_t& offset, uint64_t& length) {
    buffer = item.index("buffer", {"buffers", out_.buffers.size()}, Need::Required);
    const auto from = item.has("byteOffset") ? item.integer("byteOffset", 0, kMostBytes) : 0;
    const auto size = item.integer("byteLength", 1, kMostBytes, Need::Required);
    if (buffer < 0 || !from || !size) return false;
    offset = *from, length = *size;
    const uint64_t end = lengths_[static_cast<size_t>(buffer)];
    if (end == 0 || offset + length <= end) return true;
    item.error(fmt::format("ends at byte {} of a buffer of {} bytes", offset + length, end));
    return false;
  }

  void read_view(const Item& item, BufferView& v) {
    const bool right = read_range(item, v.buffer, v.offset, v.length);
    const bool fallback = right && fallback_[static_cast<size_t>(v.buffer)];
    const bool has_bytes = right && out_.buffers[static_cast<size_t>(v.buffer)].owner;
    if (item.has("byteStride")) {
      const auto stride = item.integer("byteStride", 4, 252);
      if (stride && *stride % 4 != 0) {
        item.error_at("byteStride", fmt::format("must be a multiple of 4, and is {}", *stride));
      }
      v.stride = stride.value_or(0);
    }
    item.choice("target", std::vector<uint64_t>{34962, 34963});
    bool compressed = false;
    item.object("extensions", [&](const Item& extensions) {
      extensions.object(kMeshopt, [&](const Item& meshopt) { compressed = true, read_compression(meshopt, v); });
    });
    if (fallback && !has_bytes && !compressed) item.error_at("buffer", "names a buffer without bytes");
    if (!has_bytes) v.buffer = -1;
    // Nothing is read of what has none: why has been said.
    if (!right || (!has_bytes && !v.compression)) v.length = 0;
  }

  void read_compression(const Item& item, BufferView& v) {
    Compression c;
    if (!read_range(item, c.buffer, c.offset, c.length)) return;
    const auto stride = item.integer("byteStride", 1, 256, Need::Required);
    const auto count = item.integer("count", 1, kMostBytes, Need::Required);
    const int mode =
        item.choice("mode", std::vector<const char*>{"ATTRIBUTES", "TRIANGLES", "INDICES"}, Need::Required);
    const int filter =
        item.has("filter")
            ? item.choice("filter", std::vector<const char*>{"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"})
            : 0;
    if (!stride || !count || mode < 0 || filter < 0) return;
    c.stride = *stride, c.count = *count;
    c.mode = static_cast<Compression::Mode>(mode), c.filter = static_cast<Compression::Filter>(filter);
    if (!check_compression(item, c, v)) return;
    if (!out_.buffers[static_cast<size_t>(c.buffer)].owner) {
      if (fallback_[static_cast<size_t>(c.buffer)]) item.error_at("buffer", "names a buffer without bytes");
      return;
    }
    v.compression = c;
  }

  bool check_compression(const Item& item, const Compression& c, const BufferView& v) {
    const bool attributes = c.mode == Compression::Mode::Attributes;
    if (attributes ? c.stride % 4 != 0 : c.stride != 2 && c.stride != 4) {
      item.error_at("byteStride", attributes ? "must be a multiple of 4" : "must be 2 or 4");
      return false;
    }
    const bool stride_of_filter[] = {true, c.stride == 4 || c.stride == 8, c.stride == 8, c.stride % 4 == 0};
    if (!stride_of_filter[static_cast<size_t>(c.filter)] || (!attributes && c.filter != Compression::Filter::None)) {
      item.error_at("filter", "does not go with the mode and the byteStride");
      return false;
    }
    if (c.mode == Compression::Mode::Triangles && c.count % 3 != 0)
      return item.error_at("count", "must be a multiple of 3"), false;
    // The densest code is two bits for sixteen bytes, which a byte of each of sixteen elements are.
    constexpr uint64_t kMostDense = 80, kSlack = 65536;
    if (c.count > (c.length * kMostDense + kSlack) / c.stride) {
      item.error_at("count", fmt::format("is {}, which {} compressed bytes cannot hold", c.count, c.length));
      return false;
    }
    if (v.length != 0 && c.count * c.stride != v.length) {
      item.error(fmt::format("is {} bytes when decompressed, and the buffer view is {}", c.count * c.stride, v.length));
      return false;
    }
    return true;
  }

  void read_accessor(const Item& item, Accessor& a) {
    static constexpr std::array<std::pair<int, int>, 7> kShapes{
        {{1, 1}, {2, 1}, {3, 1}, {4, 1}, {2, 2}, {3, 3}, {4, 4}}};
    const int component =
        item.choice("componentType", std::vector<uint64_t>{5120, 5121, 5122, 5123, 5125, 5126}, Need::Required);
    const int type = item.choice(
        "type", std::vector<const char*>{"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"}, Need::Required);
    const auto count = item.integer("count", 1, kMostBytes, Need::Required);
    const auto offset = item.has("byteOffset") ? item.integer("byteOffset", 0, kMostBytes) : 0;
    a.view = item.index("bufferView", {"bufferViews", out_.views.size()});
    a.normalized = item.boolean("normalized");
    if (component < 0 || type < 0 || !count || !offset) {
      a.view = -1;
      return;
    }
    a.component = static_cast<Component>(component);
    std::tie(a.rows, a.columns) = kShapes[static_cast<size_t>(type)];
    for (const char* limit : {"min", "max"}) item.numbers(limit, static_cast<size_t>(a.numbers()));
    if (a.normalized && (a.component == Component::Float || a.component == Component::Uint32)) {
      item.error_at("normalized", "must not be true of numbers of this componentType");
    }
    if (a.view < 0 && *count > kMostZeros / static_cast<uint64_t>(a.numbers())) {
      item.error_at("count", fmt::format("is {}, of an accessor without a bufferView; {} numbers are read at most",
                                         *count, kMostZeros));
      return;
    }
    a.offset = *offset;
    if (a.view >= 0 && !check_range(item, a, *count)) a.view = -1;
    else a.count = *count;
    if (a.count == 0) return;
    item.object("sparse", [&](const Item& sparse) { read_sparse(sparse, a); });
  }

  /// Whether `count` elements of an accessor lie within its view, where they may.
  bool check_range(const Item& item, const Accessor& a, uint64_t count) {
    const BufferView& v = out_.views[static_cast<size_t>(a.view)];
    if (v.length == 0) return false;
    const uint64_t size = a.element_size(), stride = v.stride != 0 ? v.stride : size;
    if (stride < size)
      return item.error(fmt::format("has elements of {} bytes at a byteStride of {}", size, stride)), false;
    const uint64_t unit = size_of(a.component);
    // What is compressed lies where its decoder puts it.
    const uint64_t at = (v.compression ? 0 : v.offset) + a.offset;
    if (a.offset % unit != 0 || at % unit != 0) {
      item.error_at("byteOffset",
                    fmt::format("makes its numbers begin at byte {}, which is not a multiple of {}", at, unit));
      return false;
    }
    if (a.offset + size > v.length || (count - 1) > (v.length - a.offset - size) / stride) {
      item.error(
          fmt::format("has {} elements of {} bytes at a stride of {} from byte {} on, and its buffer view {} bytes",
                      count, size, stride, a.offset, v.length));
      return false;
    }
    return true;
  }

  void read_sparse(const Item& item, Accessor& a) {
    Sparse s;
    const auto count = item.integer("count", 1, std::max<uint64_t>(a.count, 1), Need::Required);
    if (!item.has("indices")) item.error_at("indices", "is missing");
    if (!item.has("values")) item.error_at("values", "is missing");
    bool right = count.has_value();
    const auto read_part = [&](const Item& part, Accessor as, int& view, uint64_t& offset) {
      view = part.index("bufferView", {"bufferViews", out_.views.size()}, Need::Required);
      const auto from = part.has("byteOffset") ? part.integer("byteOffset", 0, kMostBytes) : 0;
      if (view < 0 || !from || !count) return right = false;
      as.view = view, as.offset = offset = *from;
      if (!check_range(part, as, *count)) right = false;
      return right;
    };
    item.object("indices", [&](const Item& part) {
      const int type = part.choice("componentType", std::vector<uint64_t>{5121, 5123, 5125}, Need::Required);
      static constexpr Component kTypes[] = {Component::Uint8, Component::Uint16, Component::Uint32};
      if (type < 0) right = false;
      else s.index_type = kTypes[type];
      Accessor as;
      as.component = s.index_type;
      read_part(part, as, s.index_view, s.index_offset);
    });
    item.object("values", [&](const Item& part) { read_part(part, a, s.value_view, s.value_offset); });
    if (!right || s.index_view < 0 || s.value_view < 0) return;
    s.count = *count;
    check_sparse_indices(item, a, s);
    a.sparse = s;
  }

  /// They increase, and stay below the accessor's count. Compressed ones are looked at when decompressed.
  void check_sparse_indices(const Item& item, const Accessor& a, const Sparse& s) {
    if (out_.views[static_cast<size_t>(s.index_view)].compression) return;
    const std::string wrong = sparse_problem(a, s, out_.plain_view(s.index_view).bytes);
    if (!wrong.empty()) item.error_at("indices", wrong);
  }

  const Item& root_;
  const Document& document_;
  const std::string& folder_;
  const LoadOptions& options_;
  Buffers& out_;
  std::vector<uint64_t> lengths_;  ///< Of the buffers; 0 where it is not known.
  std::vector<bool> fallback_;     ///< Buffers whose bytes are only there compressed.
};

}  // namespace

void read_data(const Item& root, const Document& document, const std::string& folder, const LoadOptions& options,
               Buffers& out) {
  DataReader(root, document, folder, options, out).read();
}

}  // namespace whit::gltf
