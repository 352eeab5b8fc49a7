// Baking: object-space doubles become group-space floats, once, after everything was placed in double.
#pragma once

#include <memory>

#include "core/scene/scene.h"

namespace whit {

/// Bounds of the mesh's triangles under `m`, in double; of all its points when it has no indices.
Box3d mesh_bounds(const MeshData& data, const Mat4d& m);

/// Transforms a mesh by `object_to_group` into floats. Triangles without area are dropped and counted.
std::unique_ptr<Mesh> bake_mesh(const MeshData& data, const Mat4d& object_to_group, size_t& degenerate);

/// The same for triangles that are huge (core/scene/huge.h), which keep their corners in double beside. `neighbours` are
/// the other triangles of their mesh.
std::unique_ptr<Mesh> bake_huge(const MeshData& data, const MeshData& neighbours, const Mat4d& object_to_group,
                                size_t& degenerate);

/// Moves curves to a space of their own, which keeps the shape of their object space.
std::unique_ptr<Curves> bake_curves(const CurveData& data, const Mat4d& object_to_group);

/// The inverse transpose of the linear part, scaled so that its largest entry is about 1 (normals only).
Mat4d normal_matrix(const Mat4d& m);

}  // namespace whit
