// The world's analytic shapes, in an Embree scene of their own beside that of the triangles. Embree keeps them in a tree
// of their own in any case and walks it for every ray. Here rays are first asked for the boxes of the shapes, 64 at once,
// and few are left to be traced: of those to a lamp, none for the lamp's own sake.
#pragma once

#include <vector>

#include "core/accel/embree_geometry.h"
#include "core/accel/packets.h"
#include "core/accel/shadow_rays.h"

namespace whit {

class AnalyticScene {
 public:
  /// Takes over a reference to a scene.
  explicit AnalyticScene(RTCScene scene) : scene_(scene) {}
  ~AnalyticScene() { rtcReleaseScene(scene_); }
  AnalyticScene(const AnalyticScene&) = delete;
  AnalyticScene& operator=(const AnalyticScene&) = delete;

  RTCScene scene() const { return scene_; }
  bool empty() const { return boxes_.empty(); }
  /// Of a shape that was attached to the scene; `unshaded_by_itself` as in GeometryUser.
  void add_box(const RTCBounds& bounds, int unshaded_by_itself);

  /// Those of rays [first, first + count), at most kBlock, that reach the box of a shape within t_far, which has a value
  /// for each of them (null: infinite): how many, and their lanes. The shape `unshaded_by` does not count.
  int reaching(const RayLanes& rays, int first, int count, const float* t_far, int unshaded_by, int32_t* lanes) const;

  /// Replaces the hits of n lanes by nearer ones on the analytic shapes; geometry 0 of the scene has number first_shape.
  template <int N>
  void intersect(const RayLanes& rays, const int32_t* lanes, int n, const Hits& hits, EmbreeQuery& query,
                 int first_shape) const;
  /// Writes 1 for those of n lanes that hit an analytic shape before their ends, and leaves the rest.
  template <int N>
  void occluded(const RayLanes& rays, const int32_t* lanes, int n, const LaneEnds& ends, EmbreeQuery& query,
                uint8_t* blocked) const;

  static constexpr int kBlock = 64;  ///< Rays that are asked together.

  /// Whether so many lanes of a block are as good as all: then packets of them are traced as they are.
  static bool are_most(int n, int count) { return 4 * n >= 3 * count; }

 private:
  static constexpr size_t kFew = 8;  ///< So many boxes are looked at one by one; more are joined to one.
  struct Reach {
    RTCBounds bounds;
    int unshaded_by_itself;
  };

  RTCScene scene_;
  std::vector<Reach> boxes_;
};

}  // namespace whit
