// A mesh as the bytes of a PLY file.
#pragma once

#include <string>

#include "core/plugin/shape.h"

namespace whit {

/// A binary PLY file that reads back as the same mesh, to the bit: positions as float where they are floats, else as
/// double; normals, both sets of surface parameters, colours and tangents as float, under the names that parse_ply() knows.
std::string mesh_as_ply(const MeshData& mesh);

}  // namespace whit
