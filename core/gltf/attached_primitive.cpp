#include "core/gltf/attached_primitive.h"

#include <fmt/format.h>

#include "core/gltf/accessor.h"

namespace whit::gltf {

std::string AttachedPrimitive::read(MeshData& out) const {
  return read_primitive(*model_, primitive_, pose_, needs_, out);
}

/// Vertices that tangents are made for may not be shared, which is not known before.
MemoryNeed AttachedPrimitive::memory_need(const MeshAttributes& attributes) const {
  const Attributes& a = primitive_.attributes;
  if (primitive_.mode == Primitive::Mode::Points || primitive_.mode == Primitive::Mode::Lines || a.position < 0)
    return {};
  const uint64_t vertices = element_count(*model_, a.position);
  const uint64_t corners = primitive_.indices >= 0 ? element_count(*model_, primitive_.indices) : vertices;
  const bool is_list = primitive_.mode == Primitive::Mode::Triangles || primitive_.draco;
  const bool normals = a.normal >= 0 || needs_.tangents;
  MemoryNeed need{.vertices = vertices, .triangles = is_list ? corners / 3 : corners};
  need.floats = (normals ? 3 : 0) + (needs_.tangents ? 4 : 0) + (needs_.uv0 && a.uv[0] >= 0 ? 2 : 0) +
                (needs_.uv1 && attributes.uvs1 && a.uv[1] >= 0 ? 2 : 0) +
                (needs_.colors && attributes.colors && a.color >= 0 ? 4 : 0);
  // About 12 bytes for a vertex's place and 4 for each float and index.
  need.mapped = vertices * (12 + 4 * need.floats) + 4 * corners;
  need.making = 4 * corners;
  return need;
}

/// The model itself is named by where it is, for it is kept as long as this is.
std::string AttachedPrimitive::identity() const {
  std::string out;
  const auto add = [&out](const void* bytes, size_t count) { out.append(static_cast<const char*>(bytes), count); };
  const void* const named[] = {model_.get(), &primitive_};
  add(named, sizeof named);
  out += fmt::format("{}{}{}{}{} {}:", needs_.tangents, needs_.uv0, needs_.uv1, needs_.colors, needs_.tangent_uv_set,
                     pose_.weights.size());
  add(pose_.weights.data(), pose_.weights.size() * sizeof(double));
  for (const Mat4d& joint : pose_.joints) add(&joint, sizeof joint);
  return out;
}

MeshNeeds needs_of(const Model& model, int index, bool other) {
  MeshNeeds needs;
  needs.uv0 = true;
  needs.uv1 = other;
  const Material material = index < 0 ? Material() : model.materials[static_cast<size_t>(index)];
  needs.tangents = material.normal_texture || material.anisotropy > 0;
  needs.tangent_uv_set = material.normal_texture ? material.normal_texture.uv_set : material.anisotropy_texture.uv_set;
  needs.colors = true;
  for (const TextureUse* use :
       {&material.base_color_texture, &material.metallic_roughness_texture, &material.normal_texture,
        &material.emissive_texture, &material.transmission_texture, &material.specular_texture,
        &material.specular_color_texture, &material.clearcoat_texture, &material.clearcoat_roughness_texture,
        &material.sheen_color_texture, &material.sheen_roughness_texture, &material.anisotropy_texture}) {
    needs.uv1 |= *use && use->uv_set == 1;
  }
  return needs;
}

}  // namespace whit::gltf
