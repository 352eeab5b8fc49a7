// Reads triangle meshes from PLY files (Turk 1994): ascii, little and big endian binary, any order and type of
// properties. Works on bytes in memory; who maps the file and who reports the error is the caller's business.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/mesh_attributes.h"

namespace whit {

/// The mesh of a PLY file. Every index is below the number of vertices; normals and surface parameters are finite.
struct PlyMesh {
  /// x y z per vertex, as the file says: NaN and infinity too, since nothing may use such a vertex. Who makes triangles of
  /// them leaves out those that have no area (remove_degenerate_triangles()).
  std::vector<double> positions;
  std::vector<float> normals;  ///< nx ny nz per vertex, or empty.
  std::vector<float> uvs;      ///< u v per vertex (also s t, texture_u texture_v, texture_s texture_t), or empty.
  std::vector<float> uvs1;     ///< u1 v1 per vertex, or empty; where asked for.
  /// red green blue alpha per vertex, or empty; where asked for. Integers are divided by their largest, so that 255 of 8
  /// bits is 1; without alpha it is 1.
  std::vector<float> colors;
  std::vector<float> tangents;         ///< tx ty tz per vertex, or empty.
  std::vector<float> bitangent_signs;  ///< tw per vertex, or empty; not without tangents.
  std::vector<uint32_t> indices;       ///< 3 per triangle; a quad 0 1 2 3 becomes 0 1 2 and 3 0 2.
  size_t bad_numbers = 0;              ///< Of all but positions that are NaN or infinite; they are 0 instead.
  size_t skipped_faces = 0;            ///< Faces with fewer than 3 or more than 4 corners, which are left out.
};

/// How much the mesh of a PLY file is, as far as its header and a look at the end tell.
struct PlyCounts {
  uint64_t vertices = 0, triangles = 0;
  uint64_t floats = 0;  ///< Of each vertex, beside its position.
};

/// Counts without reading more than the header and the last few lines. Zeros of files that parse_ply() has nothing good to say of.
PlyCounts count_ply(std::string_view bytes, const MeshAttributes& wanted = {});

/// Reads the mesh from the file's bytes; it is empty if the file says that there are no faces or no vertices. Returns ""
/// or what is wrong ("PLY data ends early"); `out` is then unspecified. Counts of the header are checked against the size of the data before anything is allocated.
std::string parse_ply(std::string_view bytes, PlyMesh& out, const MeshAttributes& wanted = {});

}  // namespace whit
