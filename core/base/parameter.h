// One parameter of a scene statement, `"float radius" [1]`, as plain data with the places it came from.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "core/base/diagnostics.h"
#include "core/base/vec.h"

namespace whit {

/// The parameter types of pbrt-v3 (aliases already resolved: color is Rgb, point is Point3, ...).
enum class ParamType : uint8_t {
  Integer,
  Float,
  Bool,
  String,
  Point2,
  Point3,
  Vector2,
  Vector3,
  Normal3,
  Rgb,
  Xyz,
  Blackbody,
  Spectrum,
  Texture
};

/// The name of a type as a scene file spells it: "integer", "float", ..., "rgb", "texture".
const char* param_type_name(ParamType type);

/// A texture named by a parameter, resolved at the statement that names it: the index into
/// SceneDescription::textures of the float and of the spectrum texture of that name, -1 where there is none.
struct TextureRef {
  std::string name;
  int float_texture = -1;
  int spectrum_texture = -1;

  bool operator==(const TextureRef&) const = default;
};

/// A parameter declaration and its values. Numbers of all vector and colour types are flat: a point3 has
/// three per value. A spectrum holds either (wavelength nm, value) pairs, flat, or the names of .spd files.
struct Parameter {
  ParamType type = ParamType::Float;
  std::string name;
  SourcePos where;      ///< The declaration string.
  SourcePos values_at;  ///< The first value, or its opening bracket.
  std::variant<std::vector<double>, std::vector<int32_t>, std::vector<uint8_t>, std::vector<std::string>,
               std::vector<TextureRef>>
      values;

  /// Numbers of a float, point, vector, normal, rgb, xyz, blackbody or inline spectrum; empty otherwise.
  const std::vector<double>& numbers() const { return get<double>(); }
  const std::vector<int32_t>& integers() const { return get<int32_t>(); }
  const std::vector<uint8_t>& bools() const { return get<uint8_t>(); }
  const std::vector<std::string>& strings() const { return get<std::string>(); }
  const std::vector<TextureRef>& textures() const { return get<TextureRef>(); }
  bool is_empty() const {
    return std::visit([](const auto& v) { return v.empty(); }, values);
  }

 private:
  template <class T>
  const std::vector<T>& get() const {
    static const std::vector<T> none;
    const auto* v = std::get_if<std::vector<T>>(&values);
    return v ? *v : none;
  }
};

using ParameterList = std::vector<Parameter>;

}  // namespace whit
