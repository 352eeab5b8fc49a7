#include "core/base/ply_write.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <iterator>
#include <string_view>
#include <vector>

namespace whit {
namespace {

template <class T>
char* put(char* at, T value) {
  std::memcpy(at, &value, sizeof value);
  return at + sizeof value;
}

void declare(std::string& header, const char* type, std::string_view names) {
  while (!names.empty()) {
    const size_t length = std::min(names.find(' '), names.size());
    header.append("property ").append(type).append(" ").append(names.substr(0, length)).append("\n");
    names.remove_prefix(std::min(length + 1, names.size()));
  }
}

}  // namespace

std::string write_ply(std::span<const double> positions, bool doubles, std::span<const PlyColumns> columns,
                      std::span<const uint32_t> indices) {
  std::vector<PlyColumns> given;
  std::copy_if(columns.begin(), columns.end(), std::back_inserter(given),
               [](const PlyColumns& c) { return !c.values.empty(); });
  const size_t vertices = positions.size() / 3, faces = indices.size() / 3;
  std::string out = "ply\nformat binary_";
  out.append(std::endian::native == std::endian::little ? "little" : "big").append("_endian 1.0\nelement vertex ");
  out.append(std::to_string(vertices)).append("\n");
  declare(out, doubles ? "double" : "float", "x y z");
  size_t vertex_bytes = 3 * (doubles ? sizeof(double) : sizeof(float));
  for (const PlyColumns& c : given) {
    declare(out, "float", c.properties);
    vertex_bytes += c.count * sizeof(float);
  }
  out.append("element face ").append(std::to_string(faces));
  out.append("\nproperty list uint8 int vertex_indices\nend_header\n");
  const size_t head = out.size();
  out.resize(head + vertices * vertex_bytes + faces * (1 + 3 * sizeof(int32_t)));
  char* at = out.data() + head;
  for (size_t v = 0; v < vertices; ++v) {
    for (const double x : positions.subspan(3 * v, 3)) at = doubles ? put(at, x) : put(at, static_cast<float>(x));
    for (const PlyColumns& c : given) {
      for (const float x : c.values.subspan(c.count * v, c.count)) at = put(at, x);
    }
  }
  for (size_t f = 0; f < faces; ++f) {
    at = put(at, uint8_t{3});
    for (const uint32_t i : indices.subspan(3 * f, 3)) at = put(at, static_cast<int32_t>(i));
  }
  return out;
}

}  // namespace whit
