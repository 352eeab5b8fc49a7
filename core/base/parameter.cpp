#include "core/base/parameter.h"

namespace whit {

const char* param_type_name(ParamType type) {
  switch (type) {
    case ParamType::Integer: return "integer";
    case ParamType::Float: return "float";
    case ParamType::Bool: return "bool";
    case ParamType::String: return "string";
    case ParamType::Point2: return "point2";
    case ParamType::Point3: return "point3";
    case ParamType::Vector2: return "vector2";
    case ParamType::Vector3: return "vector3";
    case ParamType::Normal3: return "normal";
    case ParamType::Rgb: return "rgb";
    case ParamType::Xyz: return "xyz";
    case ParamType::Blackbody: return "blackbody";
    case ParamType::Spectrum: return "spectrum";
    case ParamType::Texture: return "texture";
  }
  return "unknown";
}

}  // namespace whit
