// A model at a time: where its nodes are, and how its meshes are bent.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/gltf/model.h"
#include "core/gltf/primitive.h"

namespace whit::gltf {

/// Nodes at a time. All matrices are of row vectors, from a space to that of the scene's roots.
struct PosedNodes {
  std::vector<Mat4d> to_root;                ///< One for each node.
  std::vector<std::vector<double>> weights;  ///< Of each node's morph targets; empty where its mesh has none.
};

/// Poses all nodes: as the file has them, or with its animations at `time` seconds, held before their first and behind
/// their last key. Where two animations move the same property of a node, the first counts. Returns "", or what is wrong
/// with the numbers of an animation and its place in the file.
std::string pose_nodes(const Model& model, std::optional<double> time, PosedNodes& out);

/// The nodes that are shown, parents first, in a model at a time.
struct ShownNodes {
  std::vector<int> nodes;
  PosedNodes posed;
};

/// Whether a matrix can be inverted. Nodes that are scaled to nothing are there, and not shown.
bool is_placeable(const Mat4d& m);

/// How a mesh is bent before it is placed.
bool is_bent(const Pose& pose);

/// A node's mesh, wherever it is placed: once, or as often as EXT_mesh_gpu_instancing says.
struct DrawnMesh {
  int node = -1, mesh = -1;
  Pose pose;
  std::vector<Mat4d> to_root;  ///< Those that can be inverted.
};

/// What is drawn of the nodes. A million placements are the most that is shown of a model. "" or what is wrong, with the
/// place in the file; `unplaceable` counts the others.
std::string drawn_meshes(const Model& model, const ShownNodes& shown, std::vector<DrawnMesh>& out, size_t& unplaceable);

}  // namespace whit::gltf
