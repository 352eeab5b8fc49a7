#include "core/plugin/mesh_ply.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace whit {
namespace {

template <class T>
char* put(char* at, T value) {
  std::memcpy(at, &value, sizeof value);
  return at + sizeof value;
}

/// Numbers of each vertex, as the header names them.
struct Attribute {
  const std::vector<float>& values;
  size_t count;  ///< For each vertex.
  const char* properties;
};

bool are_floats(std::span<const double> numbers) {
  return std::all_of(numbers.begin(), numbers.end(),
                     [](double x) { return static_cast<double>(static_cast<float>(x)) == x; });
}

}  // namespace

std::string mesh_as_ply(const MeshData& mesh) {
  const size_t vertices = mesh.positions.size() / 3, faces = mesh.indices.size() / 3;
  const bool doubles = !are_floats(mesh.positions);
  const std::string real = doubles ? "property double " : "property float ";
  std::string header = std::string("ply\nformat binary_") +
                       (std::endian::native == std::endian::little ? "little" : "big") +
                       "_endian 1.0\nelement vertex " + std::to_string(vertices) + "\n";
  for (const char* axis : {"x", "y", "z"}) header += real + axis + "\n";
  std::vector<Attribute> attributes;
  for (const Attribute& a : {Attribute{mesh.normals, 3, "nx ny nz"}, Attribute{mesh.uvs, 2, "u v"},
                             Attribute{mesh.uvs1, 2, "u1 v1"}, Attribute{mesh.colors, 4, "red green blue alpha"},
                             Attribute{mesh.tangents, 3, "tx ty tz"}, Attribute{mesh.bitangent_signs, 1, "tw"}}) {
    if (a.values.empty()) continue;
    attributes.push_back(a);
    for (const char* at = a.properties; *at;) {
      const size_t length = std::strcspn(at, " ");
      header.append("property float ").append(at, length).append("\n");
      at += length + (at[length] != 0 ? 1 : 0);
    }
  }
  header += "element face " + std::to_string(faces) + "\nproperty list uint8 int vertex_indices\nend_header\n";
  size_t vertex_bytes = 3 * (doubles ? sizeof(double) : sizeof(float));
  for (const Attribute& a : attributes) vertex_bytes += a.count * sizeof(float);
  std::string out = header;
  out.resize(header.size() + vertices * vertex_bytes + faces * (1 + 3 * sizeof(int32_t)));
  char* at = out.data() + header.size();
  for (size_t v = 0; v < vertices; ++v) {
    for (size_t k = 0; k < 3; ++k) {
      const double x = mesh.positions[3 * v + k];
      at = doubles ? put(at, x) : put(at, static_cast<float>(x));
    }
    for (const Attribute& a : attributes) {
      for (size_t k = 0; k < a.count; ++k) at = put(at, a.values[a.count * v + k]);
    }
  }
  for (size_t f = 0; f < faces; ++f) {
    at = put(at, uint8_t{3});
    for (size_t k = 0; k < 3; ++k) at = put(at, static_cast<int32_t>(mesh.indices[3 * f + k]));
  }
  return out;
}

}  // namespace whit
