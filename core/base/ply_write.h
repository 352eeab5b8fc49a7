// Triangle meshes as the bytes of PLY files (Turk 1994).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace whit {

/// Numbers that each vertex has, beside its position.
struct PlyColumns {
  const char* properties;         ///< Their names, with spaces between: "nx ny nz".
  size_t count;                   ///< How many there are.
  std::span<const float> values;  ///< Flat, `count` a vertex; none, and there are no such columns.
};

/// A binary file in the machine's order of bytes: positions (3 a vertex) as double or rounded to float, the columns, and
/// triangles (3 indices each).
std::string write_ply(std::span<const double> positions, bool doubles, std::span<const PlyColumns> columns,
                      std::span<const uint32_t> indices);

}  // namespace whit
