// KHR_draco_mesh_compression, through Draco.
#include <draco/compression/decode.h>
#include <draco/core/varint_decoding.h>
#include <draco/metadata/metadata_decoder.h>
#include <fmt/format.h>

#include <algorithm>
#include <exception>

#include "core/gltf/primitive_parts.h"

namespace whit::gltf {

struct DracoMesh::Decoded {
  std::unique_ptr<draco::Mesh> mesh;
};

DracoMesh::DracoMesh() : decoded_(std::make_unique<Decoded>()) {}
DracoMesh::~DracoMesh() = default;

namespace {

constexpr const char* kDamaged = "its bytes cannot be decoded";

/// Draco allocates what its header says before it looks whether the bytes can hold it. Returns "" when the header of a mesh
/// promises no more than `most` triangles and three vertices for each.
std::string check_header(std::span<const uint8_t> bytes, uint64_t most) {
  constexpr size_t kHeader = 11;
  if (bytes.size() < kHeader || std::string_view(reinterpret_cast<const char*>(bytes.data()), 5) != "DRACO")
    return kDamaged;
  // The extension wants this version of the format.
  if (bytes[5] != 2 || bytes[6] != 2)
    return fmt::format("its bytes have version {}.{}, and 2.2 is read", bytes[5], bytes[6]);
  const bool is_mesh = bytes[7] == 1, edge_breaker = bytes[8] == 1, has_metadata = (bytes[10] & 0x80) != 0;
  if (!is_mesh) return "is no mesh";
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()) + kHeader, bytes.size() - kHeader, 0x0202);
  draco::GeometryMetadata metadata;
  if (has_metadata && !draco::MetadataDecoder().DecodeGeometryMetadata(&buffer, &metadata)) return kDamaged;
  uint8_t traversal = 0;
  uint32_t first = 0, second = 0;
  if (edge_breaker && !buffer.Decode(&traversal)) return kDamaged;
  if (!draco::DecodeVarint(&first, &buffer) || !draco::DecodeVarint(&second, &buffer)) return kDamaged;
  const uint64_t vertices = edge_breaker ? first : second, triangles = edge_breaker ? second : first;
  if (triangles > most || vertices > most * 3)
    return fmt::format("has {} triangles and {} vertices, which is more than its accessors say", triangles, vertices);
  return {};
}

}  // namespace

std::string DracoMesh::decode(std::span<const uint8_t> bytes, uint64_t most_indices) {
  try {
    if (std::string error = check_header(bytes, most_indices / 3); !error.empty()) return error;
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    draco::Decoder decoder;
    auto mesh = decoder.DecodeMeshFromBuffer(&buffer);
    if (!mesh.ok()) return kDamaged;
    decoded_->mesh = std::move(mesh).value();
  } catch (const std::exception& e) { return fmt::format("{}: {}", kDamaged, e.what()); }
  return {};
}

std::vector<uint32_t> DracoMesh::indices() const {
  std::vector<uint32_t> out;
  out.reserve(size_t{decoded_->mesh->num_faces()} * 3);
  for (draco::FaceIndex f(0); f < decoded_->mesh->num_faces(); ++f)
    for (size_t k = 0; k < 3; ++k) out.push_back(decoded_->mesh->face(f)[k].value());
  return out;
}

std::string DracoMesh::read(int attribute, const Accessor& as, std::vector<float>& out) const {
  const draco::PointAttribute* from = decoded_->mesh->GetAttributeByUniqueId(static_cast<uint32_t>(attribute));
  const auto width = static_cast<size_t>(as.numbers());
  if (!from) return fmt::format("its bytes have no attribute {}", attribute);
  if (from->num_components() != static_cast<int>(width)) {
    return fmt::format("its attribute {} has {} numbers for each vertex, and its accessor {}", attribute,
                       from->num_components(), width);
  }
  const uint32_t points = decoded_->mesh->num_points();
  out.resize(points * width);
  for (draco::PointIndex p(0); p < points; ++p) {
    const draco::AttributeValueIndex at = from->mapped_index(p);
    if (at.value() >= from->size() ||
        !from->ConvertValue<float>(at, static_cast<int8_t>(width), out.data() + p.value() * width))
      return kDamaged;
  }
  // Integers that stand for fractions, where the bytes do not say so themselves.
  if (!as.normalized || from->normalized() || from->data_type() == draco::DT_FLOAT32) return {};
  const float scale = as.component == Component::Int8    ? 127
                      : as.component == Component::Uint8 ? 255
                      : as.component == Component::Int16 ? 32767
                                                         : 65535;
  for (float& number : out) number = std::max(number / scale, -1.0f);
  return {};
}

}  // namespace whit::gltf
