// The ray tracer: geometry in, nearest hits and occlusion out, in batches. The only door to Embree.
//
// Geometry lives in groups. Group 0 is the world, in render space; the others are object definitions, in a
// local space of their own, placed in the world by instances.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/accel/curve.h"
#include "core/accel/exact_triangle.h"
#include "core/accel/ray_end.h"
#include "core/base/vec.h"
#include "core/batch/rays.h"
#include "core/plugin/shape.h"

namespace whit {

/// n rays, structure of arrays, in render space. Directions are unit vectors. A ray that is not finite hits nothing.
struct RayLanes {
  int n = 0;
  Vec3Lanes o, d;
  const float* t_max = nullptr;  ///< Null: infinite.
  const float* time = nullptr;   ///< In [0,1] over the transform times; null: 0.
  const RayEnd* end = nullptr;   ///< Shadow rays: what they all end on; null: just t_max.
  Vec3Lanes q{};                 ///< Shadow rays to a plane: the points they end on, if known better than by t_max.
  const RayEnd* const* ends = nullptr;  ///< Shadow rays: what each ends on; null: all on `end`.
};

/// Decides whether a surface is there at a hit (alpha textures). Called from worker threads.
class AlphaTest {
 public:
  virtual ~AlphaTest() = default;
  /// True when the surface is cut away at the point. `p` is the hit in the group's space.
  virtual bool cut(uint32_t prim, float u, float v, const Vec3f& p, bool shadow_ray) const = 0;
};

/// A triangle mesh in its group's space. Arrays must outlive the Accel; positions are padded by one float.
struct MeshView {
  const float* positions = nullptr;  ///< 3 per vertex.
  size_t vertex_count = 0;
  const uint32_t* indices = nullptr;  ///< 3 per triangle.
  size_t triangle_count = 0;
};

/// Affine 3x4 matrices, column-major as Embree's FLOAT3X4_COLUMN_MAJOR: x axis, y axis, z axis, translation.
struct Affine {
  float m[12];
};

/// Embree's device. Ray tracers that share one can share what is built on it.
class AccelDevice;
/// `config` is Embree's: "isa=avx2", or "" as a rule.
std::shared_ptr<AccelDevice> make_accel_device(const std::string& config = {});

/// A mesh that is built once and then traced by ray tracers that come and go, each of which may place it elsewhere.
class BuiltMesh;
/// Builds it, for ray tracers of the same device and robustness. `owner` keeps the arrays where they are. Where that fails
/// the ray tracer says so that it is added to.
std::shared_ptr<BuiltMesh> build_mesh(std::shared_ptr<AccelDevice> device, const MeshView& mesh,
                                      std::shared_ptr<const void> owner, bool robust);

struct AccelOptions {
  bool robust = true;  ///< Watertight traversal.
  /// Scenes worth at most so many triangles (an analytic shape is worth 200) are traced as if all rays were coherent:
  /// neighbours then meet the same few boxes wherever they go. Measured in docs/speed.md.
  double small_scene = 1000;
  /// Camera rays may be aimed exactly at vertices, and are looked at again: core/accel/second_look.h.
  bool second_look = false;
  std::string embree{};                   ///< Configuration of Embree's device, e.g. "isa=avx2"; tests use it.
  std::shared_ptr<AccelDevice> device{};  ///< Null: one of its own, of that configuration.
};

class RayRecord;

class Accel {
 public:
  explicit Accel(const AccelOptions& options);
  ~Accel();
  Accel(const Accel&) = delete;
  Accel& operator=(const Accel&) = delete;

  static constexpr int kWorld = 0;

  /// Starts a new object group; returns its number.
  int add_group();
  void add_mesh(int group, const MeshView& mesh, int shape, const AlphaTest* alpha);
  /// A new group that is this mesh alone; returns its number. Two ray tracers that have it must not be built at once, nor
  /// one be built while another traces.
  int add_built(std::shared_ptr<BuiltMesh> mesh, int shape);
  /// Triangles that are traced in double precision. They must outlive the Accel.
  void add_exact(int group, std::span<const ExactTriangle> triangles, int shape, const AlphaTest* alpha);
  void add_curves(int group, const CurveView& curves, int shape, const AlphaTest* alpha);
  void add_analytic(int group, const AnalyticShape& shape_geometry, int shape, const AlphaTest* alpha);
  /// Places a group in the world; keys are group-to-render matrices, evenly spaced over time [0,1] and
  /// interpolated linearly between. Returns the instance's index.
  int add_instance(int group, const std::vector<Affine>& keys);

  /// Builds the acceleration structures. Returns an error text, "" when all went well.
  std::string build();
  /// To be called after build() when there are touched ends (RayEnd::touched): builds again, for rays that ask about
  /// every triangle they meet. All rays get slower by it, so it is not done for lights that nothing touches.
  std::string watch_ends();

  /// `coherent`: neighbouring rays are alike (camera rays). Decides the speed, and the rays' kind in a record.
  void intersect(const RayLanes& rays, const Hits& hits, bool coherent) const;
  /// Writes 1 where something is hit before t_max, else 0. Returns for how many rays that was known without tracing them
  /// (core/accel/blockers.h).
  int occluded(const RayLanes& rays, uint8_t* blocked) const;

  /// What is so near to an emitter that shadow rays must tell it from that: from a triangle of render space, or whatever
  /// is in a box. `corners` is null for a box.
  Touching touching(const Box3d& box, const std::array<Vec3d, 3>* corners) const;

  /// Keeps every ray that is traced from now on (one thread only); null ends it. For core/accel/replay.h.
  void record(RayRecord* record);
  /// True when something is instanced. Embree 3.13.5 then never returns from a coherent packet of occlusion rays.
  bool has_instances() const;
  /// Embree's scenes of the world, each an RTCScene: analytic shapes are in the second.
  std::array<void*, 2> embree_scenes() const;

  /// Bytes Embree holds, with all that its device is shared with.
  size_t bytes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// "Embree 3.13.5" for logs.
std::string accel_version();

}  // namespace whit
