// Materials of a model as statements.
#pragma once

#include <map>
#include <set>
#include <string>

#include "core/gltf/describe.h"

namespace whit::gltf {

/// Names that are used once each.
class UniqueNames {
 public:
  explicit UniqueNames(std::string prefix) : prefix_(std::move(prefix)) {}
  /// `wanted`, or `otherwise` where that is "", with a number where it is taken.
  std::string unique(const std::string& wanted, const std::string& otherwise);

 private:
  std::string prefix_;
  std::set<std::string> taken_;
};

/// How a shape wears a material.
struct WornMaterial {
  std::string statements;  ///< NamedMaterial, and AreaLightSource where it emits.
  std::string for_shape;   ///< Parameters of the shape: its alpha mask.
  bool emits = false;
};

/// Writes each material once, when first asked for.
class MaterialWriter {
 public:
  MaterialWriter(const Model& model, Assets& assets, UniqueNames& names)
      : model_(model), assets_(assets), names_(names) {}

  /// A material (-1: the file's default) on a mesh with or without vertex colours.
  const WornMaterial& worn(int material, bool colors);

  /// The statements that make all of them.
  const std::string& statements() const { return statements_; }
  const std::set<std::string>& notes() const { return notes_; }

 private:
  struct Value;
  std::string image_map(const TextureUse& use, bool spectrum, const std::string& parameters);
  std::string texture(bool spectrum, const std::string& wanted, const std::string& definition);
  std::string product(const std::string& a, const std::string& b, bool spectrum);
  Value color(const Vec3d& factor, const TextureUse& use, bool vertex_colors);
  Value number(double factor, const TextureUse& use, const char* channel);
  Value anisotropy_angle(const Material& material);
  Value alpha(const Material& material, bool vertex_colors);
  std::string metallic_roughness(const Material& material, bool colors);
  std::string extensions(const Material& material);
  std::string unlit(const Material& material, bool colors);
  Value faded(const Value& color, const Value& alpha);
  std::string emission(const Material& material, bool colors);
  void note_limits(const Material& material);

  const Model& model_;
  Assets& assets_;
  UniqueNames& names_;
  std::string statements_;
  std::set<std::string> notes_;
  std::map<std::string, std::string> textures_;  ///< Names by definition.
  std::map<std::pair<int, bool>, WornMaterial> worn_;
};

}  // namespace whit::gltf
