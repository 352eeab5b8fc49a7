// Geometry between reading and baking, in double precision and in groups that share a space: what is too far away is left
// out, what is huge is set apart, and each group gets the space that its floats will be in.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <unordered_set>
#include <vector>

#include "core/scene/build_context.h"
#include "core/scene/far.h"
#include "core/scene/kept_geometry.h"

namespace whit {

/// A mesh, curves or an analytic shape.
struct LoadedShape {
  size_t description = 0;  ///< Index into SceneDescription::shapes.
  Mat4d to_group;          ///< From object space to where the group's shapes were described.
  MeshData mesh, huge;     ///< Two parts of one mesh: core/scene/huge.h.
  CurveData curves;
  Box3d bounds;                          ///< Where the group's shapes were described.
  std::string key;                       ///< Of a mesh that is to be kept (core/scene/kept_geometry.h), else "".
  Diagnostics said;                      ///< Of reading that.
  std::shared_ptr<const KeptMesh> kept;  ///< What was; `mesh` is then empty.
};

/// The world, an object definition, or one shape that moves, or that is kept wherever it stands.
struct Group {
  std::vector<LoadedShape> shapes;
  std::optional<TransformPair> motion;  ///< Of a group that is one shape in object space: where it stands.
  Vec3d middle{0, 0, 0};                ///< From where distances are measured.
  RenderSpace space;
  Box3d bounds, near;   ///< Of all, and without what is huge or far: floats are made for that.
  Horizon horizon;      ///< Of what stands in it.
  int accel_group = 0;  ///< The ray tracer's number, which is Accel::kWorld too for a group without surfaces.
};

struct Groups {
  std::vector<Group> all;  ///< 0 the world, then one per object, then one per shape that has its own.
  std::map<int, std::vector<size_t>> moving;  ///< Groups of such shapes, by object (-1: the world).
  std::unordered_set<size_t> left_out;        ///< Instances that are too far away.

  Group& world() { return all[0]; }
  const Group& world() const { return all[0]; }
  const Group& placed_by(const InstanceDescription& instance) const {
    return all[static_cast<size_t>(instance.object + 1)];
  }
  std::span<const size_t> moving_in(int object) const {
    const auto found = moving.find(object);
    return found == moving.end() ? std::span<const size_t>() : found->second;
  }
};

/// Reads the live shapes, on all threads. Those that cannot be read lose their plugin (reported).
Groups load_groups(const BuildContext& context, std::vector<Bound<Shape>>& shapes);

/// Render space, and the radius of a sphere around its origin that holds all that is not far.
struct WorldSpace {
  RenderSpace space;
  double radius = 1;
};

/// Render space stands at the camera; object groups stand at their own centres.
WorldSpace choose_spaces(const BuildContext& context, Groups& groups);

}  // namespace whit
