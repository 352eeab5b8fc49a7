// Materials with their extensions, and textures.
#include "core/gltf/model_parts.h"

namespace whit::gltf {
namespace {

/// A texture with KHR_texture_transform, from tinygltf's kinds of texture information.
TextureUse use_of(int index, int uv_set, const tinygltf::Value* transform) {
  TextureUse to;
  to.texture = index, to.uv_set = uv_set;
  if (transform) {
    const std::vector<double> offset = numbers(*transform, "offset"), scale = numbers(*transform, "scale");
    if (offset.size() == 2) to.offset = {offset[0], offset[1]};
    if (scale.size() == 2) to.scale = {scale[0], scale[1]};
    to.rotation = number(*transform, "rotation", 0);
    to.uv_set = integer(*transform, "texCoord", uv_set);
  }
  // The check has warned of further sets.
  return to.uv_set > 1 ? TextureUse{} : to;
}

template <class Info>
TextureUse use_of(const Info& info) {
  return use_of(info.index, info.texCoord, member(info.extensions, "KHR_texture_transform"));
}

/// The same, of a member of an extension.
TextureUse use_of(const tinygltf::Value& extension, const char* key) {
  const tinygltf::Value* info = member(extension, key);
  if (!info) return {};
  const tinygltf::Value* extensions = member(*info, "extensions");
  return use_of(integer(*info, "index", -1), integer(*info, "texCoord", 0),
                extensions ? member(*extensions, "KHR_texture_transform") : nullptr);
}

Vec3d color(const tinygltf::Value& extension, const char* key, const Vec3d& otherwise) {
  const std::vector<double> c = numbers(extension, key);
  return c.size() == 3 ? Vec3d(c[0], c[1], c[2]) : otherwise;
}

void read_transmission(const tinygltf::ExtensionMap& extensions, Material& to) {
  if (const tinygltf::Value* e = member(extensions, "KHR_materials_transmission")) {
    to.transmission = number(*e, "transmissionFactor", 0);
    to.transmission_texture = use_of(*e, "transmissionTexture");
  }
  if (const tinygltf::Value* e = member(extensions, "KHR_materials_volume")) {
    to.has_volume = true;
    to.thickness = number(*e, "thicknessFactor", 0);
    if (member(*e, "attenuationDistance")) to.attenuation_distance = number(*e, "attenuationDistance", 0);
  }
  if (const tinygltf::Value* e = member(extensions, "KHR_materials_ior")) to.ior = number(*e, "ior", 1.5);
}

void read_layers(const tinygltf::ExtensionMap& extensions, Material& to) {
  if (const tinygltf::Value* e = member(extensions, "KHR_materials_specular")) {
    to.specular = number(*e, "specularFactor", 1);
    to.specular_texture = use_of(*e, "specularTexture");
    to.specular_color = color(*e, "specularColorFactor", {1, 1, 1});
    to.specular_color_texture = use_of(*e, "specularColorTexture");
  }
  if (const tinygltf::Value* e = member(extensions, "KHR_materials_clearcoat")) {
    to.clearcoat = number(*e, "clearcoatFactor", 0);
    to.clearcoat_texture = use_of(*e, "clearcoatTexture");
    to.clearcoat_roughness = number(*e, "clearcoatRoughnessFactor", 0);
    to.clearcoat_roughness_texture = use_of(*e, "clearcoatRoughnessTexture");
    to.clearcoat_normal_texture = use_of(*e, "clearcoatNormalTexture");
  }
  if (const tinygltf::Value* e = member(extensions, "KHR_materials_sheen")) {
    to.sheen_color = color(*e, "sheenColorFactor", {0, 0, 0});
    to.sheen_color_texture = use_of(*e, "sheenColorTexture");
    to.sheen_roughness = number(*e, "sheenRoughnessFactor", 0);
    to.sheen_roughness_texture = use_of(*e, "sheenRoughnessTexture");
  }
  if (const tinygltf::Value* e = member(extensions, "KHR_materials_anisotropy")) {
    to.anisotropy = number(*e, "anisotropyStrength", 0);
    to.anisotropy_rotation = number(*e, "anisotropyRotation", 0);
    to.anisotropy_texture = use_of(*e, "anisotropyTexture");
  }
}

Material material_of(const tinygltf::Material& from) {
  Material to;
  to.name = from.name;
  const tinygltf::PbrMetallicRoughness& pbr = from.pbrMetallicRoughness;
  if (pbr.baseColorFactor.size() == 4) std::copy_n(pbr.baseColorFactor.begin(), 4, to.base_color.begin());
  to.base_color_texture = use_of(pbr.baseColorTexture);
  to.metallic = pbr.metallicFactor, to.roughness = pbr.roughnessFactor;
  to.metallic_roughness_texture = use_of(pbr.metallicRoughnessTexture);
  to.normal_texture = use_of(from.normalTexture);
  to.normal_scale = from.normalTexture.scale;
  to.occlusion_texture = use_of(from.occlusionTexture);
  if (from.emissiveFactor.size() == 3)
    to.emissive = {from.emissiveFactor[0], from.emissiveFactor[1], from.emissiveFactor[2]};
  to.emissive_texture = use_of(from.emissiveTexture);
  if (const tinygltf::Value* e = member(from.extensions, "KHR_materials_emissive_strength"))
    to.emissive *= number(*e, "emissiveStrength", 1);
  to.alpha = from.alphaMode == "MASK"    ? Material::Alpha::Mask
             : from.alphaMode == "BLEND" ? Material::Alpha::Blend
                                         : Material::Alpha::Opaque;
  to.alpha_cutoff = from.alphaCutoff;
  to.double_sided = from.doubleSided;
  to.unlit = member(from.extensions, "KHR_materials_unlit") != nullptr;
  read_transmission(from.extensions, to);
  read_layers(from.extensions, to);
  return to;
}

Sampler::Wrap wrap_of(int wrap) {
  return wrap == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE     ? Sampler::Wrap::Clamp
         : wrap == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? Sampler::Wrap::Mirror
                                                         : Sampler::Wrap::Repeat;
}

Texture texture_of(const tinygltf::Texture& from, const tinygltf::Model& model) {
  Texture to;
  to.image = from.source;
  // KHR_texture_basisu is not decoded: such textures have a plain source beside it, or the check has said so.
  if (const tinygltf::Value* webp = member(from.extensions, "EXT_texture_webp"))
    to.image = integer(*webp, "source", from.source);
  if (from.sampler < 0) return to;
  const tinygltf::Sampler& sampler = model.samplers[static_cast<size_t>(from.sampler)];
  to.sampler = {wrap_of(sampler.wrapS), wrap_of(sampler.wrapT), sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST};
  return to;
}

}  // namespace

void convert_materials(const tinygltf::Model& from, Model& to) {
  for (const tinygltf::Texture& texture : from.textures) to.textures.push_back(texture_of(texture, from));
  for (const tinygltf::Material& material : from.materials) to.materials.push_back(material_of(material));
}

}  // namespace whit::gltf
