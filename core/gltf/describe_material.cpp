#include "core/gltf/describe_material.h"

#include <cmath>
#include <utility>

#include "core/base/fastmath.h"
#include "core/gltf/statement_text.h"

namespace whit::gltf {

std::string UniqueNames::unique(const std::string& wanted, const std::string& otherwise) {
  const std::string base = prefix_ + printable_name(wanted.empty() ? otherwise : wanted);
  std::string name = base;
  for (int i = 2; !taken_.insert(name).second; ++i) name = fmt::format("{} {}", base, i);
  return name;
}

/// A parameter that is a constant, or a texture times a constant that the texture has in it.
struct MaterialWriter::Value {
  std::string texture;  ///< "" for a constant.
  Vec3d constant{0, 0, 0};

  bool is(double v) const { return texture.empty() && constant == Vec3d(v, v, v); }
  /// "" where it is what a statement without it means.
  std::string color_param(const std::string& name, double default_value) const {
    if (is(default_value)) return {};
    return texture.empty() ? vector_param("rgb " + name, constant) : string_param("texture " + name, texture);
  }
  std::string number_param(const std::string& name, double default_value) const {
    if (is(default_value)) return {};
    return texture.empty() ? gltf::number_param("float " + name, constant.x) : string_param("texture " + name, texture);
  }
};

/// The texture with that definition, which is written once.
std::string MaterialWriter::texture(bool spectrum, const std::string& wanted, const std::string& definition) {
  const std::string key = (spectrum ? "\"spectrum\" " : "\"float\" ") + definition;
  const auto [found, is_new] = textures_.try_emplace(key);
  if (is_new) {
    found->second = names_.unique("", wanted);
    statements_ += fmt::format("Texture {} {}\n", scene_string(found->second), key);
  }
  return found->second;
}

/// A picture by way of its texture coordinates. The file's have v pointing down, and so has KHR_texture_transform; ours
/// point up, and so does t.
std::string MaterialWriter::image_map(const TextureUse& use, bool spectrum, const std::string& parameters) {
  const Texture& texture = model_.textures[static_cast<size_t>(use.texture)];
  if (texture.image < 0) return {};
  const Image& image = model_.images[static_cast<size_t>(texture.image)];
  std::string definition =
      "\"imagemap\"" + assets_.picture(image, fmt::format("picture {}", texture.image)) + parameters;
  const auto wrap = [](Sampler::Wrap w) {
    return w == Sampler::Wrap::Clamp ? "clamp" : w == Sampler::Wrap::Mirror ? "mirror" : "repeat";
  };
  if (texture.sampler.wrap_s != Sampler::Wrap::Repeat)
    definition += string_param("string wrapu", wrap(texture.sampler.wrap_s));
  if (texture.sampler.wrap_t != Sampler::Wrap::Repeat)
    definition += string_param("string wrapv", wrap(texture.sampler.wrap_t));
  if (texture.sampler.nearest) definition += string_param("string filter", "point");
  if (use.uv_set > 0) definition += fmt::format(" \"integer uvset\" {}", use.uv_set);
  if (use.offset != Vec2d(0, 0) || use.scale != Vec2d(1, 1) || use.rotation != 0) {
    const double c = std::cos(use.rotation), s = std::sin(use.rotation);
    definition += fmt::format(" \"float uvmatrix\" [ {} {} {} {} {} {} ]", c * use.scale.x, -s * use.scale.y,
                              use.offset.x + s * use.scale.y, s * use.scale.x, c * use.scale.y,
                              1 - use.offset.y - c * use.scale.y);
  }
  return this->texture(spectrum, image.name.empty() ? fmt::format("picture {}", texture.image) : image.name,
                       definition);
}

/// a times b, each a texture's name, a parameter's number or list, or "" for 1.
std::string MaterialWriter::product(const std::string& a, const std::string& b, bool spectrum) {
  if (a.empty() || b.empty()) return a + b;
  const auto factor = [&](const char* name, const std::string& of) {
    const bool constant = of.front() == '[';
    return fmt::format(" \"{} {}\" {}", constant ? (spectrum ? "rgb" : "float") : "texture", name,
                       constant ? of : scene_string(of));
  };
  return texture(spectrum, "product", "\"scale\"" + factor("tex1", a) + factor("tex2", b));
}

MaterialWriter::Value MaterialWriter::color(const Vec3d& factor, const TextureUse& use, bool vertex_colors) {
  if (factor == Vec3d(0, 0, 0)) return {"", factor};
  std::string made = use ? image_map(use, true, string_param("bool gamma", "true")) : "";
  if (vertex_colors) made = product(made, texture(true, "vertex colours", "\"vertexcolor\""), true);
  if (made.empty()) return {"", factor};
  if (factor != Vec3d(1, 1, 1)) made = product(made, fmt::format("[ {} {} {} ]", factor.x, factor.y, factor.z), true);
  return {made, {}};
}

MaterialWriter::Value MaterialWriter::number(double factor, const TextureUse& use, const char* channel) {
  if (factor == 0 || !use) return {"", Vec3d(factor)};
  std::string made =
      image_map(use, false, string_param("string channel", channel) + string_param("bool gamma", "false"));
  if (made.empty()) return {"", Vec3d(factor)};
  if (factor != 1) made = product(made, fmt::format("[ {} ]", factor), false);
  return {made, {}};
}

/// The direction of a texture, in degrees, from the direction that the material has.
MaterialWriter::Value MaterialWriter::anisotropy_angle(const Material& m) {
  const double offset = m.anisotropy_rotation * 180 / detail::kPiD;
  const Value x = number(1, m.anisotropy_texture, "red"), y = number(1, m.anisotropy_texture, "green");
  if (x.texture.empty() || y.texture.empty()) return {"", Vec3d(offset)};
  return {texture(false, "angle",
                  "\"angle\"" + string_param("texture x", x.texture) + string_param("texture y", y.texture) +
                      (offset != 0 ? gltf::number_param("float offset", offset) : "")),
          {}};
}

/// Of the base colour, its texture and the vertices.
MaterialWriter::Value MaterialWriter::alpha(const Material& material, bool vertex_colors) {
  Value value = number(material.base_color[3], material.base_color_texture, "alpha");
  if (!vertex_colors || material.base_color[3] == 0) return value;
  const std::string colors =
      texture(false, "vertex alpha", "\"vertexcolor\"" + string_param("string channel", "alpha"));
  return {product(value.texture.empty() ? fmt::format("[ {} ]", value.constant.x) : value.texture, colors, false), {}};
}

std::string MaterialWriter::metallic_roughness(const Material& m, bool colors) {
  const Vec3d base(m.base_color[0], m.base_color[1], m.base_color[2]);
  std::string out = color(base, m.base_color_texture, colors).color_param("basecolor", 1);
  out += number(m.metallic, m.metallic_roughness_texture, "blue").number_param("metallic", 1);
  out += number(m.roughness, m.metallic_roughness_texture, "green").number_param("roughness", 1);
  if (m.normal_texture) {
    const std::string map = image_map(m.normal_texture, true, string_param("bool gamma", "false"));
    if (!map.empty()) out += string_param("texture normalmap", map);
    if (!map.empty() && m.normal_scale != 1) out += number_param("float normalscale", m.normal_scale);
  }
  if (m.alpha == Material::Alpha::Blend) out += alpha(m, colors).number_param("opacity", 1);
  return out + extensions(m);
}

/// A body that scatters nothing; what it shows is its emission.
std::string MaterialWriter::unlit(const Material& m, bool colors) {
  std::string out = vector_param("rgb basecolor", {0, 0, 0}) + gltf::number_param("float metallic", 0) +
                    gltf::number_param("float specular", 0);
  if (m.alpha == Material::Alpha::Blend) out += alpha(m, colors).number_param("opacity", 1);
  return out;
}

std::string MaterialWriter::extensions(const Material& m) {
  std::string out;
  if (m.ior != 1.5) out += number_param("float ior", m.ior);
  out += number(m.specular, m.specular_texture, "alpha").number_param("specular", 1);
  out += color(m.specular_color, m.specular_color_texture, false).color_param("specularcolor", 1);
  out += number(m.transmission, m.transmission_texture, "red").number_param("transmission", 0);
  if (m.has_volume && m.thickness > 0) out += string_param("bool thin", "false");
  out += number(m.clearcoat, m.clearcoat_texture, "red").number_param("clearcoat", 0);
  if (m.clearcoat > 0)
    out += number(m.clearcoat_roughness, m.clearcoat_roughness_texture, "green").number_param("clearcoatroughness", 0);
  out += color(m.sheen_color, m.sheen_color_texture, false).color_param("sheencolor", 0);
  if (m.sheen_color != Vec3d(0, 0, 0))
    out += number(m.sheen_roughness, m.sheen_roughness_texture, "alpha").number_param("sheenroughness", 0);
  out += number(m.anisotropy, m.anisotropy_texture, "blue").number_param("anisotropy", 0);
  if (m.anisotropy > 0) out += anisotropy_angle(m).number_param("anisotropyrotation", 0);
  return out;
}

/// Blending takes from what a surface emits as well.
MaterialWriter::Value MaterialWriter::faded(const Value& color, const Value& alpha) {
  if (color.texture.empty() && alpha.texture.empty()) return {"", color.constant * alpha.constant.x};
  return {texture(true, "faded",
                  "\"mix\" \"rgb tex1\" [ 0 0 0 ]" + color.color_param("tex2", -1) + alpha.number_param("amount", -1)),
          {}};
}

/// The area light of a surface that emits, or that is unlit: it shows its colour and lights nothing.
std::string MaterialWriter::emission(const Material& m, bool colors) {
  const Vec3d factor = m.unlit ? Vec3d(m.base_color[0], m.base_color[1], m.base_color[2]) : m.emissive;
  if (factor == Vec3d(0, 0, 0)) return {};
  Value map = color(Vec3d(1, 1, 1), m.unlit ? m.base_color_texture : m.emissive_texture, m.unlit && colors);
  if (m.alpha == Material::Alpha::Blend) map = faded(map, alpha(m, colors));
  if (map.is(0)) return {};
  std::string out = "AreaLightSource \"diffuse\"" + vector_param("rgb L", factor);
  out += map.color_param("map", 1);
  if (m.unlit) out += string_param("bool lights", "false");
  if (m.unlit || m.double_sided) out += string_param("bool twosided", "true");
  return out + "\n";
}

void MaterialWriter::note_limits(const Material& m) {
  if (m.occlusion_texture) notes_.insert("occlusion maps are not used: what is in the way of light is found by rays");
  if (m.attenuation_distance && m.has_volume && m.thickness > 0)
    notes_.insert("light is not absorbed inside of solids (KHR_materials_volume)");
  if (m.clearcoat_normal_texture && m.clearcoat > 0)
    notes_.insert("clear coats have the normals of what is below them");
}

const WornMaterial& MaterialWriter::worn(int index, bool colors) {
  const auto [found, is_new] = worn_.try_emplace({index, colors});
  if (!is_new) return found->second;
  const Material m = index < 0 ? Material() : model_.materials[static_cast<size_t>(index)];
  note_limits(m);
  const std::string body =
      "\"string type\" \"metallicroughness\"" + (m.unlit ? unlit(m, colors) : metallic_roughness(m, colors));
  WornMaterial worn;
  const std::string light = emission(m, colors);
  worn.emits = !light.empty();
  if (m.alpha == Material::Alpha::Mask) {
    const Value value = alpha(m, colors);
    worn.for_shape =
        value.texture.empty()
            ? (value.constant.x >= m.alpha_cutoff ? "" : number_param("float alpha", 0))
            : string_param("texture alpha", texture(false, "mask",
                                                    "\"threshold\"" + string_param("texture value", value.texture) +
                                                        number_param("float edge", m.alpha_cutoff)));
  }
  const std::string name = names_.unique(m.name, index < 0 ? "default material" : fmt::format("material {}", index));
  statements_ += fmt::format("MakeNamedMaterial {} {}\n", scene_string(name), body);
  worn.statements = fmt::format("NamedMaterial {}\n", scene_string(name)) + light;
  return found->second = std::move(worn);
}

}  // namespace whit::gltf
