#include <fmt/format.h>

#include "core/gltf/model_parts.h"

namespace whit::gltf {
namespace {

using AttributeMap = std::map<std::string, int>;

int accessor_of(const AttributeMap& attributes, const std::string& name) {
  const auto found = attributes.find(name);
  return found == attributes.end() ? -1 : found->second;
}

Attributes attributes_of(const AttributeMap& from) {
  Attributes to;
  to.position = accessor_of(from, "POSITION");
  to.normal = accessor_of(from, "NORMAL");
  to.tangent = accessor_of(from, "TANGENT");
  to.uv = {accessor_of(from, "TEXCOORD_0"), accessor_of(from, "TEXCOORD_1")};
  to.color = accessor_of(from, "COLOR_0");
  for (int set = 0;; ++set) {
    const int joints = accessor_of(from, fmt::format("JOINTS_{}", set)),
              weights = accessor_of(from, fmt::format("WEIGHTS_{}", set));
    if (joints < 0 || weights < 0) return to;
    to.joints.push_back(joints), to.weights.push_back(weights);
  }
}

Primitive::Mode mode_of(int mode) {
  switch (mode) {
    case TINYGLTF_MODE_POINTS: return Primitive::Mode::Points;
    case TINYGLTF_MODE_LINE:
    case TINYGLTF_MODE_LINE_LOOP:
    case TINYGLTF_MODE_LINE_STRIP: return Primitive::Mode::Lines;
    case TINYGLTF_MODE_TRIANGLE_STRIP: return Primitive::Mode::Strip;
    case TINYGLTF_MODE_TRIANGLE_FAN: return Primitive::Mode::Fan;
    default: return Primitive::Mode::Triangles;
  }
}

/// KHR_materials_variants
std::vector<int> variants_of(const tinygltf::Primitive& from, size_t variants) {
  const tinygltf::Value* extension = member(from.extensions, "KHR_materials_variants");
  const tinygltf::Value* mappings = extension ? member(*extension, "mappings") : nullptr;
  if (!mappings) return {};
  std::vector<int> out(variants, -1);
  for (size_t i = 0; i < mappings->ArrayLen(); ++i) {
    const tinygltf::Value& mapping = mappings->Get(static_cast<int>(i));
    for (const double variant : numbers(mapping, "variants"))
      out[static_cast<size_t>(variant)] = integer(mapping, "material", -1);
  }
  return out;
}

/// KHR_draco_mesh_compression
std::optional<DracoPrimitive> draco_of(const tinygltf::Primitive& from) {
  const tinygltf::Value* extension = member(from.extensions, kDracoShown);
  const tinygltf::Value* ids = extension ? member(*extension, "attributes") : nullptr;
  if (!ids) return std::nullopt;
  DracoPrimitive to;
  to.view = integer(*extension, "bufferView", -1);
  for (const std::string& name : ids->Keys())
    to.attributes.emplace_back(accessor_of(from.attributes, name), integer(*ids, name.c_str(), -1));
  return to;
}

Primitive primitive_of(const tinygltf::Primitive& from, size_t variants) {
  Primitive to;
  to.mode = mode_of(from.mode);
  to.attributes = attributes_of(from.attributes);
  to.indices = from.indices, to.material = from.material;
  for (const AttributeMap& target : from.targets) {
    to.targets.push_back(
        {accessor_of(target, "POSITION"), accessor_of(target, "NORMAL"), accessor_of(target, "TANGENT")});
  }
  to.variant_material = variants_of(from, variants);
  to.draco = draco_of(from);
  return to;
}

}  // namespace

void convert_meshes(const tinygltf::Model& from, Model& to) {
  if (const tinygltf::Value* extension = member(from.extensions, "KHR_materials_variants")) {
    const tinygltf::Value* variants = member(*extension, "variants");
    for (size_t i = 0; variants && i < variants->ArrayLen(); ++i)
      to.variants.push_back(text(variants->Get(static_cast<int>(i)), "name"));
  }
  for (const tinygltf::Mesh& mesh : from.meshes) {
    Mesh& out = to.meshes.emplace_back();
    out.name = mesh.name;
    out.weights = mesh.weights;
    for (const tinygltf::Primitive& primitive : mesh.primitives) {
      out.primitives.push_back(primitive_of(primitive, to.variants.size()));
      out.primitives.back().place =
          fmt::format("/meshes/{}/primitives/{}", to.meshes.size() - 1, out.primitives.size() - 1);
    }
  }
}

}  // namespace whit::gltf
