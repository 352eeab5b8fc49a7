// A primitive as a triangle mesh.
#pragma once

#include <string>
#include <vector>

#include "core/gltf/model.h"
#include "core/plugin/shape.h"

namespace whit::gltf {

/// How a primitive is posed: by weights of its morph targets, then by matrices of its skin's joints.
struct Pose {
  std::vector<double> weights;  ///< One for each target, or empty.
  std::vector<Mat4d> joints;  ///< From the mesh's space to that of the result, one for each joint; empty: not skinned.
};

/// What the material asks of a mesh beside positions and normals.
struct MeshNeeds {
  bool tangents = false;  ///< There is a normal map, or anisotropy. Made by MikkTSpace's rules where the file has none.
  int tangent_uv_set = 0;  ///< Of the normal map's texture coordinates.
  bool uv0 = false, uv1 = false;
  bool colors = false;
};

/// The triangles of one primitive, in the mesh's space (or the joints' targets'). Strips and fans become lists. Normals
/// that the file lacks are those of the triangles: there are none then, unless tangents are made, for which vertices are not
/// shared. Texture coordinates have v pointing up: 1 - v of the file's, here and nowhere else. A primitive of
/// points or lines, or without positions, is empty. Degenerate triangles are left out and counted, and so are those with
/// a corner that is not finite. Tangents are empty where the file has neither them nor the texture coordinates. Returns
/// "", or what is wrong with the file and the place in it. Thread-safe.
std::string read_primitive(const Model& model, const Primitive& primitive, const Pose& pose, const MeshNeeds& needs,
                           MeshData& out);

}  // namespace whit::gltf
