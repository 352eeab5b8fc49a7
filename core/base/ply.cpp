#include "core/base/ply.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <type_traits>

#include "core/base/limits.h"

namespace whit {
namespace {

enum class Format { Ascii, LittleEndian, BigEndian };
enum class Type { Int8, Uint8, Int16, Uint16, Int32, Uint32, Float32, Float64 };

struct Property {
  std::string name;
  Type type = Type::Float32;  ///< Of the value, or of a list's elements.
  bool is_list = false;
  Type count_type = Type::Uint8;
};

struct Element {
  std::string name;
  uint64_t count = 0;
  std::vector<Property> properties;

  int find(std::string_view property) const {
    for (size_t i = 0; i < properties.size(); ++i)
      if (properties[i].name == property) return static_cast<int>(i);
    return -1;
  }
};

struct Header {
  Format format = Format::Ascii;
  std::vector<Element> elements;
};

size_t size_of(Type t) {
  switch (t) {
    case Type::Int8:
    case Type::Uint8: return 1;
    case Type::Int16:
    case Type::Uint16: return 2;
    case Type::Int32:
    case Type::Uint32:
    case Type::Float32: return 4;
    case Type::Float64: return 8;
  }
  return 0;
}

bool is_integer(Type t) { return t != Type::Float32 && t != Type::Float64; }

std::optional<Type> type_named(std::string_view name) {
  static constexpr std::pair<std::string_view, Type> kNames[] = {
      {"char", Type::Int8},     {"int8", Type::Int8},       {"uchar", Type::Uint8},    {"uint8", Type::Uint8},
      {"short", Type::Int16},   {"int16", Type::Int16},     {"ushort", Type::Uint16},  {"uint16", Type::Uint16},
      {"int", Type::Int32},     {"int32", Type::Int32},     {"uint", Type::Uint32},    {"uint32", Type::Uint32},
      {"float", Type::Float32}, {"float32", Type::Float32}, {"double", Type::Float64}, {"float64", Type::Float64}};
  for (const auto& [n, t] : kNames)
    if (n == name) return t;
  return std::nullopt;
}

/// The words of a line, at most six (one more than any header line that matters has).
struct Words {
  std::array<std::string_view, 6> word;
  size_t count = 0;
  explicit Words(std::string_view line) {
    for (size_t i = 0; i < line.size() && count < word.size();) {
      const size_t begin = line.find_first_not_of(" \t", i);
      if (begin == line.npos) return;
      i = std::min(line.find_first_of(" \t", begin), line.size());
      word[count++] = line.substr(begin, i - begin);
    }
  }
  std::string_view operator[](size_t i) const { return word[i]; }
};

std::string in_quotes(std::string_view text) {
  return '"' + std::string(text.substr(0, 40)) + (text.size() > 40 ? "...\"" : "\"");
}

/// Takes one line, without its end (\n, \r\n or \r), off the front of `rest`; nullopt when none is complete.
std::optional<std::string_view> take_line(std::string_view& rest) {
  const size_t end = rest.find_first_of("\r\n");
  if (end == rest.npos) return std::nullopt;
  const std::string_view line = rest.substr(0, end);
  rest.remove_prefix(end + (rest[end] == '\r' && end + 1 < rest.size() && rest[end + 1] == '\n' ? 2 : 1));
  return line;
}

std::string parse_format(const Words& w, Header& header) {
  if (w.count < 3) return "PLY header has a \"format\" line without format and version";
  if (w[1] == "ascii") header.format = Format::Ascii;
  else if (w[1] == "binary_little_endian") header.format = Format::LittleEndian;
  else if (w[1] == "binary_big_endian") header.format = Format::BigEndian;
  else return "PLY format is unknown: " + in_quotes(w[1]);
  return w[2] == "1.0" ? "" : "PLY version is unknown: " + in_quotes(w[2]);
}

std::string parse_element(const Words& w, Header& header) {
  Element e;
  if (w.count != 3) return "PLY header has an \"element\" line without name and count";
  const auto [end, code] = std::from_chars(w[2].data(), w[2].data() + w[2].size(), e.count);
  if (code != std::errc() || end != w[2].data() + w[2].size())
    return "PLY element count is no number: " + in_quotes(w[2]);
  e.name = w[1];
  header.elements.push_back(std::move(e));
  return {};
}

std::string parse_property(const Words& w, Header& header) {
  if (header.elements.empty()) return "PLY header has a property before the first element";
  Property p;
  p.is_list = w.count > 1 && w[1] == "list";
  if (w.count != (p.is_list ? 5u : 3u)) return "PLY header has an incomplete \"property\" line";
  if (p.is_list) {
    const auto type = type_named(w[2]);
    if (!type || !is_integer(*type)) return "PLY type of a list's length is unknown: " + in_quotes(w[2]);
    p.count_type = *type;
  }
  const std::string_view type_name = w[p.is_list ? 3 : 1];
  const auto type = type_named(type_name);
  if (!type) return "PLY property type is unknown: " + in_quotes(type_name);
  p.type = *type;
  p.name = w[p.is_list ? 4 : 2];
  header.elements.back().properties.push_back(std::move(p));
  return {};
}

/// Parses the header and leaves `rest` at the first byte of the data.
std::string parse_header(std::string_view& rest, Header& header) {
  std::string_view head = rest.substr(0, kPlyHeaderBytes.most);
  const bool all = head.size() == rest.size();
  const auto magic = take_line(head);
  if (!magic || *magic != "ply") return "not a PLY file: it does not begin with \"ply\"";
  bool has_format = false;
  for (;;) {
    const auto line = take_line(head);
    if (!line && !all) return "the header of the PLY file has no end: " + more_bytes_than(kPlyHeaderBytes);
    if (!line) return "PLY header ends early";
    const Words w(*line);
    std::string error;
    if (w.count == 0 || w[0] == "comment" || w[0] == "obj_info") continue;
    if (w[0] == "end_header") break;
    if (w[0] == "format") error = parse_format(w, header), has_format = true;
    else if (w[0] == "element") error = parse_element(w, header);
    else if (w[0] == "property") error = parse_property(w, header);
    else error = "PLY header has an unknown line: " + in_quotes(*line);
    if (!error.empty()) return error;
  }
  rest.remove_prefix(static_cast<size_t>(head.data() - rest.data()));
  return has_format ? "" : "PLY header has no \"format\" line";
}

/// A value of type T from unaligned bytes.
template <class T, bool kSwap>
T load(const char* from) {
  std::array<char, sizeof(T)> bytes;
  std::memcpy(bytes.data(), from, sizeof(T));
  if constexpr (kSwap) std::reverse(bytes.begin(), bytes.end());
  return std::bit_cast<T>(bytes);
}

/// Calls body with a value of the C++ type that stands for t.
template <class Body>
auto with_type(Type t, const Body& body) {
  switch (t) {
    case Type::Int8: return body(int8_t{});
    case Type::Uint8: return body(uint8_t{});
    case Type::Int16: return body(int16_t{});
    case Type::Uint16: return body(uint16_t{});
    case Type::Int32: return body(int32_t{});
    case Type::Uint32: return body(uint32_t{});
    case Type::Float32: return body(float{});
    case Type::Float64: break;
  }
  return body(double{});
}

/// Reads values one after the other. A value that is not there or cannot be read makes failed() true and is 0.
class BinaryReader {
 public:
  BinaryReader(std::string_view data, bool swap) : data_(data), swap_(swap) {}
  double number(Type t) {
    return with_type(t, [&](auto zero) { return static_cast<double>(value<decltype(zero)>()); });
  }
  int64_t integer(Type t) {
    return with_type(t, [&](auto zero) { return static_cast<int64_t>(value<decltype(zero)>()); });
  }
  void skip(Type t, uint64_t n) {
    if (n > data_.size() / size_of(t)) failed_ = true;
    else data_.remove_prefix(n * size_of(t));
  }
  bool failed() const { return failed_; }
  std::string error() const { return "PLY data ends early"; }
  /// The least number of bytes a value of the type takes.
  static size_t least_size(Type t) { return size_of(t); }
  std::string_view& rest() { return data_; }

 private:
  template <class T>
  T value() {
    if (data_.size() < sizeof(T)) {
      failed_ = true;
      return T{};
    }
    const T v = swap_ ? load<T, true>(data_.data()) : load<T, false>(data_.data());
    data_.remove_prefix(sizeof(T));
    return v;
  }
  std::string_view data_;
  bool swap_, failed_ = false;
};

class AsciiReader {
 public:
  explicit AsciiReader(std::string_view data) : data_(data) {}
  double number(Type) { return value<double>(); }
  int64_t integer(Type) { return value<int64_t>(); }
  void skip(Type, uint64_t n) {
    for (; n > 0 && !failed_; --n) {
      if (next_word().empty()) failed_ = true;
    }
  }
  bool failed() const { return failed_; }
  std::string error() const {
    return bad_.empty() ? "PLY data ends early" : "PLY data has no number in " + in_quotes(bad_);
  }
  static size_t least_size(Type) { return 1; }

 private:
  /// No number is as long; what is no text at all need not be read to its end.
  static constexpr size_t kLongestWord = 4096;

  static bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }
  std::string_view next_word() {
    size_t begin = 0;
    while (begin < data_.size() && is_space(data_[begin])) ++begin;
    size_t end = begin;
    while (end < data_.size() && end - begin < kLongestWord && !is_space(data_[end])) ++end;
    const std::string_view word = data_.substr(begin, end - begin);
    if (word.size() == kLongestWord) failed_ = true, bad_ = word;
    data_.remove_prefix(end);
    return word;
  }
  template <class T>
  T value() {
    std::string_view word = next_word();
    T v{};
    if (word.size() > 1 && word[0] == '+') word.remove_prefix(1);
    const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), v);
    if (code == std::errc() && end == word.data() + word.size()) return v;
    // A number too small for a double is 0; one too large is infinite, which the caller refuses.
    if constexpr (std::is_floating_point_v<T>) {
      if (code == std::errc::result_out_of_range) return std::strtod(std::string(word).c_str(), nullptr);
    }
    failed_ = true, bad_ = word;
    return T{};
  }
  std::string_view data_, bad_;
  bool failed_ = false;
};

/// Where the vertex properties go: column -> (property index or -1).
struct VertexColumns {
  int position[3], normal[3], uv[2], uv1[2], color[4], tangent[3], sign;
  bool has_normals() const { return normal[0] >= 0; }
  bool has_uvs() const { return uv[0] >= 0; }

  VertexColumns(const Element& e, const MeshAttributes& wanted) : uv{-1, -1} {
    set(e, uv1, {"u1", "v1"}, wanted.uvs1), set(e, color, {"red", "green", "blue"}, wanted.colors);
    color[3] = color[0] >= 0 ? plain(e, "alpha") : -1;
    set(e, tangent, {"tx", "ty", "tz"}, true);
    sign = tangent[0] >= 0 ? plain(e, "tw") : -1;
    static constexpr const char *kP[] = {"x", "y", "z"}, *kN[] = {"nx", "ny", "nz"};
    static constexpr const char* kUv[][2] = {
        {"u", "v"}, {"s", "t"}, {"texture_u", "texture_v"}, {"texture_s", "texture_t"}};
    for (int i = 0; i < 3; ++i) position[i] = plain(e, kP[i]), normal[i] = plain(e, kN[i]);
    if (normal[1] < 0 || normal[2] < 0) normal[0] = -1;
    for (const auto& names : kUv) {
      if (has_uvs()) break;
      const int u = plain(e, names[0]), v = plain(e, names[1]);
      if (u >= 0 && v >= 0) uv[0] = u, uv[1] = v;
    }
  }

 private:
  /// All of them, or none.
  static void set(const Element& e, int* columns, std::initializer_list<const char*> names, bool wanted) {
    bool all = wanted;
    int* column = columns;
    for (const char* name : names) all = (*column++ = plain(e, name)) >= 0 && all;
    if (!all) std::fill(columns, column, -1);
  }
  static int plain(const Element& e, const char* name) {
    const int i = e.find(name);
    return i >= 0 && !e.properties[static_cast<size_t>(i)].is_list ? i : -1;
  }
};

/// The output array and offset of every property of the vertex element; at most one of the pointers is set.
struct Target {
  double* d = nullptr;
  float* f = nullptr;
  size_t stride = 0;
  void store(size_t i, double v) const {
    if (d) d[i * stride] = v;
    else if (f) f[i * stride] = static_cast<float>(v);
  }
};

std::vector<Target> vertex_targets(const Element& e, const VertexColumns& columns, PlyMesh& out) {
  std::vector<Target> targets(e.properties.size());
  for (size_t i = 0; i < 3; ++i) {
    targets[static_cast<size_t>(columns.position[i])] = {out.positions.data() + i, nullptr, 3};
    if (columns.has_normals()) targets[static_cast<size_t>(columns.normal[i])] = {nullptr, out.normals.data() + i, 3};
  }
  for (size_t i = 0; i < 2 && columns.has_uvs(); ++i) {
    targets[static_cast<size_t>(columns.uv[i])] = {nullptr, out.uvs.data() + i, 2};
  }
  const auto aim = [&](const int* column, size_t n, std::vector<float>& to) {
    for (size_t i = 0; i < n && !to.empty(); ++i)
      if (column[i] >= 0) targets[static_cast<size_t>(column[i])] = {nullptr, to.data() + i, n};
  };
  aim(columns.uv1, 2, out.uvs1), aim(columns.color, 4, out.colors);
  aim(columns.tangent, 3, out.tangents), aim(&columns.sign, 1, out.bitangent_signs);
  return targets;
}

/// Makes parts of 1 of colours that are stored as integers.
void scale_colors(const Element& e, const VertexColumns& columns, std::vector<float>& colors) {
  for (size_t c = 0; c < 4 && !colors.empty(); ++c) {
    if (columns.color[c] < 0) continue;
    const Type type = e.properties[static_cast<size_t>(columns.color[c])].type;
    if (!is_integer(type)) continue;
    const float most =
        with_type(type, [](auto zero) { return static_cast<float>(std::numeric_limits<decltype(zero)>::max()); });
    for (size_t i = c; i < colors.size(); i += 4) colors[i] /= most;
  }
}

/// Copies one property of `n` records that lie `record` bytes apart.
template <bool kSwap>
void gather(const char* from, size_t record, size_t n, Type type, const Target& to) {
  with_type(type, [&](auto zero) {
    using T = decltype(zero);
    if (to.d) {
      for (size_t i = 0; i < n; ++i) to.d[i * to.stride] = static_cast<double>(load<T, kSwap>(from + i * record));
    } else {
      for (size_t i = 0; i < n; ++i) to.f[i * to.stride] = static_cast<float>(load<T, kSwap>(from + i * record));
    }
  });
}

/// The fast way through binary vertices, which have no lists: property by property over blocks that stay in cache.
template <bool kSwap>
void gather_vertices(const char* from, const Element& e, size_t record, const std::vector<Target>& targets) {
  constexpr size_t kBlock = 1024;
  for (size_t first = 0; first < e.count; first += kBlock) {
    const size_t n = std::min<size_t>(kBlock, e.count - first);
    size_t offset = 0;
    for (size_t k = 0; k < targets.size(); ++k) {
      Target to = targets[k];
      if (to.d) to.d += first * to.stride;
      if (to.f) to.f += first * to.stride;
      if (to.d || to.f) gather<kSwap>(from + first * record + offset, record, n, e.properties[k].type, to);
      offset += size_of(e.properties[k].type);
    }
  }
}

bool has_lists(const Element& e) {
  return std::any_of(e.properties.begin(), e.properties.end(), [](const Property& p) { return p.is_list; });
}

/// Skips one property of one record, whatever it is.
template <class Reader>
void skip_property(Reader& reader, const Property& p) {
  uint64_t n = 1;
  if (p.is_list) {
    const int64_t count = reader.integer(p.count_type);
    n = count > 0 ? static_cast<uint64_t>(count) : 0;
  }
  reader.skip(p.type, n);
}

/// Reads the data of a file, element by element in the header's order.
template <class Reader>
class MeshReader {
 public:
  MeshReader(const Header& header, const MeshAttributes& wanted, std::string_view data, Reader reader, PlyMesh& out)
      : header_(header), wanted_(wanted), left_(data.size()), reader_(std::move(reader)), out_(out) {}

  std::string read() {
    if (std::string error = check_sizes(); !error.empty()) return error;
    for (const Element& e : header_.elements) {
      std::string error;
      if (e.name == "vertex") {
        const VertexColumns columns(e, wanted_);
        error = read_vertices(e, columns);
        scale_colors(e, columns, out_.colors);
      } else if (e.name == "face") error = read_faces(e);
      else skip_element(e);
      if (error.empty() && reader_.failed()) error = reader_.error();
      if (!error.empty()) return error;
    }
    return {};
  }

 private:
  static constexpr bool kBinary = std::is_same_v<Reader, BinaryReader>;

  /// The file must be able to hold what the header promises, each list being empty.
  std::string check_sizes() const {
    uint64_t left = left_;
    for (const Element& e : header_.elements) {
      uint64_t record = 0;
      for (const Property& p : e.properties) record += Reader::least_size(p.is_list ? p.count_type : p.type);
      // In ascii a separator follows every value but the last of the file.
      if (!kBinary) record *= 2;
      if (record == 0 && e.count > 0) return "PLY element " + in_quotes(e.name) + " has no properties";
      const uint64_t room = kBinary ? left : left + 1;
      if (record > 0 && e.count > room / record) {
        return "PLY header promises more than the file holds: " + std::to_string(e.count) + " of " + in_quotes(e.name);
      }
      left -= std::min(left, record * e.count);
    }
    return {};
  }

  void skip_element(const Element& e) {
    for (uint64_t i = 0; i < e.count && !reader_.failed(); ++i)
      for (const Property& p : e.properties) skip_property(reader_, p);
  }

  std::string read_vertices(const Element& e, const VertexColumns& columns) {
    out_.positions.resize(3 * e.count);
    if (columns.has_normals()) out_.normals.resize(3 * e.count);
    if (columns.has_uvs()) out_.uvs.resize(2 * e.count);
    if (columns.uv1[0] >= 0) out_.uvs1.resize(2 * e.count);
    if (columns.color[0] >= 0) out_.colors.assign(4 * e.count, 1.0f);
    if (columns.tangent[0] >= 0) out_.tangents.resize(3 * e.count);
    if (columns.sign >= 0) out_.bitangent_signs.resize(e.count);
    const std::vector<Target> targets = vertex_targets(e, columns, out_);
    if constexpr (kBinary) {
      if (!has_lists(e)) return read_packed_vertices(e, targets);
    }
    for (size_t i = 0; i < e.count && !reader_.failed(); ++i) {
      for (size_t k = 0; k < e.properties.size(); ++k) {
        const Property& p = e.properties[k];
        if (p.is_list) skip_property(reader_, p);
        else targets[k].store(i, reader_.number(p.type));
      }
    }
    return {};
  }

  std::string read_packed_vertices(const Element& e, const std::vector<Target>& targets) {
    size_t record = 0;
    for (const Property& p : e.properties) record += size_of(p.type);
    std::string_view& rest = reader_.rest();
    if (e.count > rest.size() / record) return "PLY data ends early";
    const bool swap = (header_.format == Format::BigEndian) == (std::endian::native == std::endian::little);
    if (swap) gather_vertices<true>(rest.data(), e, record, targets);
    else gather_vertices<false>(rest.data(), e, record, targets);
    rest.remove_prefix(record * e.count);
    return {};
  }

  std::string read_faces(const Element& e) {
    int list = e.find("vertex_indices");
    if (list < 0) list = e.find("vertex_index");
    const Property& p = e.properties[static_cast<size_t>(list)];
    // Triangles take at least this much of the file, so the guess cannot exceed a few times its size.
    const size_t triangle = Reader::least_size(p.count_type) + 3 * Reader::least_size(p.type);
    out_.indices.reserve(3 * std::min<size_t>(e.count, left_ / triangle + 1));
    if constexpr (kBinary) {
      const bool native = (header_.format == Format::LittleEndian) == (std::endian::native == std::endian::little);
      if (native && e.properties.size() == 1 && size_of(p.count_type) == 1 &&
          (p.type == Type::Int32 || p.type == Type::Uint32)) {
        return read_common_faces(e);
      }
    }
    for (uint64_t i = 0; i < e.count && !reader_.failed(); ++i) {
      for (size_t k = 0; k < e.properties.size(); ++k) {
        if (static_cast<int>(k) == list) read_face(p);
        else skip_property(reader_, e.properties[k]);
      }
    }
    return {};
  }

  void read_face(const Property& p) {
    const int64_t corners = reader_.integer(p.count_type);
    if (corners != 3 && corners != 4) {
      ++out_.skipped_faces;
      return reader_.skip(p.type, corners > 0 ? static_cast<uint64_t>(corners) : 0);
    }
    int64_t v[4] = {};
    for (int64_t c = 0; c < corners; ++c) v[c] = reader_.integer(p.type);
    if (!reader_.failed()) add_face(v, corners == 4);
  }

  /// The fast way: one list of a byte and 32-bit integers of the machine's own byte order.
  std::string read_common_faces(const Element& e) {
    std::string_view& rest = reader_.rest();
    const char *at = rest.data(), *const end = at + rest.size();
    for (uint64_t i = 0; i < e.count; ++i) {
      if (at == end) return "PLY data ends early";
      const size_t corners = static_cast<unsigned char>(*at++), bytes = 4 * corners;
      if (static_cast<size_t>(end - at) < bytes) return "PLY data ends early";
      if (corners == 3 || corners == 4) {
        // Read as unsigned: a negative index becomes one that no vertex has.
        uint32_t v[4] = {};
        std::memcpy(v, at, bytes);
        add_face(v, corners == 4);
      } else {
        ++out_.skipped_faces;
      }
      at += bytes;
    }
    rest.remove_prefix(static_cast<size_t>(at - rest.data()));
    return {};
  }

  /// Indices that fit no vertex are kept as 0xffffffff, or as they are; check_indices() finds both.
  template <class Index>
  void add_face(const Index* v, bool quad) {
    const auto put = [&](Index i) {
      out_.indices.push_back(i < Index{0} || static_cast<uint64_t>(i) > kBad ? kBad : static_cast<uint32_t>(i));
    };
    put(v[0]), put(v[1]), put(v[2]);
    if (quad) put(v[3]), put(v[0]), put(v[2]);
  }

  static constexpr uint32_t kBad = 0xffffffffu;

  const Header& header_;
  const MeshAttributes wanted_;
  size_t left_;
  Reader reader_;
  PlyMesh& out_;
};

/// The element of that name; null when there is none, or more than one.
const Element* only_element(const Header& header, const char* name) {
  const Element* found = nullptr;
  size_t count = 0;
  for (const Element& e : header.elements)
    if (e.name == name) found = &e, ++count;
  return count == 1 ? found : nullptr;
}

/// True for a mesh without faces or vertices, as programs write it that export whatever is there, and for point clouds.
bool is_empty_mesh(const Header& header) {
  const auto none = [&](const char* name) {
    return std::all_of(header.elements.begin(), header.elements.end(),
                       [&](const Element& e) { return e.name != name || e.count == 0; });
  };
  return none("vertex") || none("face");
}

/// What the header must have for there to be a mesh.
std::string check_header(const Header& header) {
  const Element *vertex = only_element(header, "vertex"), *face = only_element(header, "face");
  if (!vertex) return "PLY file has several elements \"vertex\"";
  if (!face) return "PLY file has several elements \"face\"";
  const VertexColumns columns(*vertex, {});
  if (columns.position[0] < 0 || columns.position[1] < 0 || columns.position[2] < 0) {
    return "PLY vertices lack x, y or z";
  }
  if (vertex->count >= std::numeric_limits<uint32_t>::max()) return "PLY file has too many vertices";
  int list = face->find("vertex_indices");
  if (list < 0) list = face->find("vertex_index");
  if (list < 0) return "PLY faces lack \"vertex_indices\"";
  const Property& p = face->properties[static_cast<size_t>(list)];
  return p.is_list && is_integer(p.type) ? "" : "PLY \"" + p.name + "\" is not a list of integers";
}

/// Triangles that a face becomes, 1 or 2: of files whose faces come last, by the last of them; of others the more.
uint64_t triangles_of_face(const Header& header, std::string_view data) {
  const Element& face = header.elements.back();
  if (face.name != "face" || face.properties.size() != 1) return 2;
  const Property& p = face.properties[0];
  if (header.format != Format::Ascii) {
    // A file of quads is one of a corner more for each, whatever stands before.
    size_t record = 0;
    for (const Element& e : header.elements) {
      if (e.name == "face") continue;
      if (has_lists(e)) return 2;
      size_t bytes = 0;
      for (const Property& of : e.properties) bytes += size_of(of.type);
      record += bytes * e.count;
    }
    const size_t corners = 3 * size_of(p.type) + size_of(p.count_type);
    const double of_face =
        static_cast<double>(data.size() - std::min(data.size(), record)) / static_cast<double>(face.count);
    return of_face > static_cast<double>(corners) + 0.5 * static_cast<double>(size_of(p.type)) ? 2 : 1;
  }
  const size_t end = data.find_last_not_of(" \t\r\n"), begin = data.find_last_of("\r\n", end);
  return end != data.npos && begin != data.npos && Words(data.substr(begin + 1))[0] == "3" ? 1 : 2;
}

/// Makes 0 of what is NaN or infinite; returns how many there were.
size_t clear_bad_numbers(std::vector<float>& values) {
  // x * 0 is 0 for every finite x and NaN for the others.
  float sum = 0;
  for (const float v : values) sum += v * 0;
  if (sum == 0) return 0;
  const auto bad = [](float v) { return !std::isfinite(v); };
  const auto n = std::count_if(values.begin(), values.end(), bad);
  std::replace_if(values.begin(), values.end(), bad, 0.0f);
  return static_cast<size_t>(n);
}

std::string check_mesh(const PlyMesh& mesh) {
  const size_t vertices = mesh.positions.size() / 3;
  for (size_t i = 0; i < mesh.indices.size(); ++i) {
    if (mesh.indices[i] < vertices) continue;
    const auto shown = static_cast<int32_t>(mesh.indices[i]);
    return "PLY face refers to a vertex that does not exist: " +
           (shown < 0 ? std::string("a negative or huge number") : std::to_string(shown)) + "; the file has " +
           std::to_string(vertices) + " vertices";
  }
  return {};
}

}  // namespace

PlyCounts count_ply(std::string_view bytes, const MeshAttributes& wanted) {
  Header header;
  std::string_view data = bytes;
  if (!parse_header(data, header).empty() || is_empty_mesh(header) || !check_header(header).empty()) return {};
  const Element &vertex = *only_element(header, "vertex"), &face = *only_element(header, "face");
  const VertexColumns columns(vertex, wanted);
  PlyCounts counts{vertex.count, face.count, 0};
  counts.floats = (columns.has_normals() ? 3 : 0) + (columns.has_uvs() ? 2 : 0) + (columns.uv1[0] >= 0 ? 2 : 0) +
                  (columns.color[0] >= 0 ? 4 : 0) + (columns.tangent[0] >= 0 ? 3 : 0) + (columns.sign >= 0 ? 1 : 0);
  counts.triangles *= triangles_of_face(header, data);
  // What a file has no room for is not read.
  counts.vertices = std::min<uint64_t>(counts.vertices, data.size());
  counts.triangles = std::min<uint64_t>(counts.triangles, 2 * data.size());
  return counts;
}

std::string parse_ply(std::string_view bytes, PlyMesh& out, const MeshAttributes& wanted) {
  out = {};
  Header header;
  std::string error = parse_header(bytes, header);
  if (error.empty() && is_empty_mesh(header)) return {};
  if (error.empty()) error = check_header(header);
  if (!error.empty()) return error;
  if (header.format == Format::Ascii) {
    error = MeshReader(header, wanted, bytes, AsciiReader(bytes), out).read();
  } else {
    const bool swap = (header.format == Format::BigEndian) == (std::endian::native == std::endian::little);
    error = MeshReader(header, wanted, bytes, BinaryReader(bytes, swap), out).read();
  }
  for (std::vector<float>* values :
       {&out.normals, &out.uvs, &out.uvs1, &out.colors, &out.tangents, &out.bitangent_signs})
    out.bad_numbers += clear_bad_numbers(*values);
  return error.empty() ? check_mesh(out) : error;
}

}  // namespace whit
