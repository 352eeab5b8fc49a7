// Triangles that are huge beside what is seen next to them, like a ground of 1e7 units under a cube. Floats have seven
// digits: the corners would be rounded to a whole unit, and every hit's error bound follows them. Such triangles are
// traced and shaded in double precision (core/accel/exact_triangle.h), and the floats of their group are made for the
// rest.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "core/base/vec.h"
#include "core/plugin/shape.h"

namespace whit {

/// From where and beside what the surfaces of a group are looked at, in the coordinates of its shapes.
class CloseUps {
 public:
  /// Somebody looks from there.
  void look_from(const Vec3d& eye) { eyes_.push_back(eye); }
  /// Something is there, of the box's size.
  void add(const Box3d& content);
  /// Triangles that reach farther than this from a point are huge, whatever is beside them: core/scene/far.h.
  void end_at(const Vec3d& from, double reach) { from_ = from, reach_ = reach; }
  /// To be called when all is added.
  void sort();

  /// Whether a triangle is huge: 2048 times larger than its distance from an eye or than all smaller content together, if
  /// that is beside it, or 16384 times larger than one thing beside it. Ordinary scenes have no such triangles; beyond,
  /// errors of 4e-7 of its size would show.
  bool makes_huge(const Vec3d& a, const Vec3d& b, const Vec3d& c) const;
  /// Whether any triangle of a mesh may be huge, by the mesh's box alone.
  bool may_make_huge(const Box3d& mesh) const;
  /// Whether all smaller content together is 2048 times smaller than the box and inside of it.
  bool is_dwarfed_by(const Box3d& box) const;

 private:
  /// Content in the order of its sizes, and the box of all that is not larger.
  struct Content {
    double size;
    Box3d own, all;
  };
  /// How many are smaller than `size`.
  size_t count_below(double size) const;

  bool is_far(const Box3d& box) const;

  Vec3d from_{0, 0, 0};
  double reach_ = std::numeric_limits<double>::infinity();
  std::vector<Vec3d> eyes_;
  std::vector<Content> contents_;
};

/// The numbers of a mesh's huge triangles, rising; its own small triangles count as content. `bounds` is the mesh's box
/// under `m`.
std::vector<uint32_t> find_huge(const MeshData& mesh, const Mat4d& m, const Box3d& bounds, const CloseUps& around);

/// Moves those triangles to a mesh of their own, and their vertices with them.
MeshData take_huge(MeshData& mesh, std::span<const uint32_t> huge);

}  // namespace whit
