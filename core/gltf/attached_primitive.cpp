#include "core/gltf/attached_primitive.h"

#include <fmt/format.h>

namespace whit::gltf {

std::string AttachedPrimitive::read(MeshData& out) const {
  return read_primitive(*model_, primitive_, pose_, needs_, out);
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
