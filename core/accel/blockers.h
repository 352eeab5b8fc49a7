// What can stand between surfaces and a light, coarsely, so that shadow rays which leave a patch of surface together are
// known to arrive without being traced: most rays from walls and grounds in the light.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/accel/accel.h"
#include "core/accel/embree_geometry.h"
#include "core/accel/shadow_rays.h"

namespace whit {

/// Boxes around runs of triangles and around whole shapes, and single triangles of small meshes, in a tree. Rays are
/// asked about in groups: all of them are inside the hull of two boxes, one around their origins and one around their
/// ends, and that hull is held against the tree (a shaft: Haines and Wallace, Shaft Culling for Efficient Ray-Cast
/// Radiosity, 1991). Render space.
class Blockers {
 public:
  static constexpr int kGroup = 64;  ///< Rays that are asked about together.

  /// The positions and indices must stay.
  void add_mesh(const MeshView& mesh);
  void add_exact(std::span<const ExactTriangle> triangles);
  /// Anything else. `unshaded_by_itself` as in GeometryUser.
  void add_box(const Box3d& box, int unshaded_by_itself = kShadesItself);
  void build();

  /// True only if none of the rays [first, first + count), at most kGroup, meets anything before its end at t_far, which
  /// has a value for each of them. Rays end in front of the triangle that they end on (core/accel/ray_end.h); the shape
  /// `unshaded_by` blocks none of them.
  bool are_clear(const RayLanes& rays, int first, int count, const float* t_far, int unshaded_by) const;

 private:
  static constexpr int kWidth = 8;
  using Three = std::array<float, 3>;
  struct Box {
    Three low, high;
  };
  struct Item {
    Box box;
    const MeshView* mesh = nullptr;  ///< Of a single triangle.
    uint32_t triangle = 0;
    const ExactTriangle* exact = nullptr;
    int unshaded_by_itself = kShadesItself;
  };
  /// Children are other nodes, or ~ items.
  struct Node {
    alignas(32) float low[3][kWidth], high[3][kWidth];
    int32_t child[kWidth];
    int32_t count = 0;
  };
  struct Shaft;

  Box box_of(int first, int last) const;
  int halve(int first, int last);
  int build_node(int first, int last);
  bool set_ends(Shaft& shaft) const;
  static unsigned meets(const Shaft& shaft, const Node& node);
  static bool is_passed(const Item& item, const Shaft& shaft);
  static bool are_beside(const Shaft& shaft, const Vec3d& n, const Vec3d& a, double error);

  std::vector<MeshView> meshes_;
  std::vector<Item> items_;
  std::vector<Node> nodes_;
  Box all_{};  ///< Around all there is.
};

}  // namespace whit
