#include "core/plugin/mesh_ply.h"

#include <algorithm>
#include <array>

#include "core/base/ply_write.h"

namespace whit {

std::string mesh_as_ply(const MeshData& mesh) {
  const bool floats = std::all_of(mesh.positions.begin(), mesh.positions.end(),
                                  [](double x) { return static_cast<double>(static_cast<float>(x)) == x; });
  const std::array<PlyColumns, 6> columns{{{"nx ny nz", 3, mesh.normals},
                                           {"u v", 2, mesh.uvs},
                                           {"u1 v1", 2, mesh.uvs1},
                                           {"red green blue alpha", 4, mesh.colors},
                                           {"tx ty tz", 3, mesh.tangents},
                                           {"tw", 1, mesh.bitangent_signs}}};
  return write_ply(mesh.positions, !floats, columns, mesh.indices);
}

}  // namespace whit
