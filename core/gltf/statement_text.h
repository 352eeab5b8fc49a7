// Statements of a scene file as text: what quotes, numbers and lists look like.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>

#include "core/base/vec.h"

namespace whit::gltf {

/// Without what would end a line or is no text: for comments and names.
inline std::string printable_name(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  }
  return text;
}

/// "# lamp" and the end of the line.
inline std::string comment(const std::string& text) { return "# " + printable_name(text) + "\n"; }

/// In double quotes, as the scene files' grammar has it, which has no other control characters than these.
inline std::string scene_string(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    switch (c) {
      case '"': out += "\\\""; break;
      case '\\': out += "\\\\"; break;
      case '\n': out += "\\n"; break;
      case '\r': out += "\\r"; break;
      case '\t': out += "\\t"; break;
      case '\b': out += "\\b"; break;
      case '\f': out += "\\f"; break;
      default: out += c;
    }
  }
  return out + '"';
}

/// ` "float roughness" 0.5`; numbers are the shortest that read back the same.
inline std::string number_param(std::string_view declaration, double value) {
  return fmt::format(" \"{}\" {}", declaration, value);
}
inline std::string vector_param(std::string_view declaration, const Vec3d& v) {
  return fmt::format(" \"{}\" [ {} {} {} ]", declaration, v.x, v.y, v.z);
}
inline std::string string_param(std::string_view declaration, std::string_view value) {
  return fmt::format(" \"{}\" {}", declaration, scene_string(value));
}

/// "Transform [ ... ]": Transform replaces the current matrix, ConcatTransform goes before it.
inline std::string matrix_statement(std::string_view statement, const Mat4d& m) {
  std::string out = std::string(statement) + " [";
  for (int i = 0; i < 16; ++i) out += fmt::format(" {}", m[i / 4][i % 4]);
  return out + " ]\n";
}

}  // namespace whit::gltf
