// A second look for camera rays. Embree's robust traversal lets no ray through an edge, but of rays aimed exactly at a
// vertex it loses 1 % between the triangles around it: the signs of its edge tests, each right to within rounding,
// contradict each other. The neighbours of such a ray, farther away than rounding reaches, all hit. Camera rays alone can
// be aimed like that, by pixels that line up with vertices, and only where the sampler puts samples at the same place in
// every pixel; others meet a vertex by chance: never in 1e7 rays. Looking again at all that hit nothing, whatever the
// sampler, took 43 % of the speed of a ball before a sky.
#pragma once

#include <algorithm>

#include "core/accel/accel.h"
#include "core/base/fastmath.h"

namespace whit {

/// Rays turned a little, and what they hit then. Few enough to stay in the cache.
class SecondLook {
 public:
  static constexpr int kWidth = 128;

  /// Looks with trace(RayLanes, Hits) for something nearer than what was hit.
  template <class Trace>
  void look(const RayLanes& rays, const Hits& hits, const Trace& trace) {
    for (int first = 0; first < rays.n; first += kWidth) {
      for (const bool across : {false, true}) {
        gather(rays, hits, first);
        look_to_both_sides(rays, hits, across, trace);
      }
    }
  }

 private:
  /// 32 roundings of a unit vector, many times the reach of the contradictions; a fiftieth of a pixel where
  /// 1000 of them show 5 degrees.
  static constexpr float kTurn = 0x1p-19f, kNearer = 1 - 1e-4f;

  struct Kept {
    float t, u, v;
    int32_t shape, instance;
    uint32_t prim;
  };

  /// Gathers those of kWidth rays that are to be looked at.
  void gather(const RayLanes& rays, const Hits& hits, int first) {
    n_ = 0;
    for (int i = first; i < std::min(rays.n, first + kWidth); ++i) {
      lane_[n_] = i;
      n_ += hits.t[i] == hits.t[i];  // NaN marks rays that cannot be traced
    }
  }

  /// Traces the gathered rays turned to one side, then those that hit now turned to the other side. What hits twice
  /// gets its first hit: at a silhouette one side misses, so nothing grows by this. What is only as much nearer as the
  /// turn makes it is the same surface.
  template <class Trace>
  void look_to_both_sides(const RayLanes& rays, const Hits& hits, bool across, const Trace& trace) {
    for (const float turn : {kTurn, -kTurn}) {
      if (n_ == 0) return;
      load(rays, hits, across, turn);
      trace(RayLanes{n_, lanes(o_), lanes(d_), t_max_, time_}, Hits{t_, shape_, prim_, instance_, u_, v_});
      int left = 0;
      for (int i = 0; i < n_; ++i) {
        if (shape_[i] < 0) continue;
        lane_[left] = lane_[i];
        kept_[left++] = turn > 0 ? Kept{t_[i], u_[i], v_[i], shape_[i], instance_[i], prim_[i]} : kept_[i];
      }
      n_ = left;
    }
    for (int i = 0; i < n_; ++i) accept(kept_[i], lane_[i], hits);
  }

  static Vec3Lanes lanes(float (&v)[3][kWidth]) { return {v[0], v[1], v[2]}; }

  void load(const RayLanes& rays, const Hits& hits, bool across, float turn) {
    for (int i = 0; i < n_; ++i) {
      const int from = lane_[i];
      const Vec3f d = rays.d[from];
      const Frame frame = coordinate_system(d);
      lanes(o_).set(i, rays.o[from]), lanes(d_).set(i, d + (across ? frame.t : frame.s) * turn);
      t_max_[i] = hits.t[from] * kNearer;
      time_[i] = rays.time ? rays.time[from] : 0;
    }
  }
  static void accept(const Kept& k, int to, const Hits& hits) {
    hits.t[to] = k.t, hits.u[to] = k.u, hits.v[to] = k.v;
    hits.shape[to] = k.shape, hits.instance[to] = k.instance, hits.prim[to] = k.prim;
  }

  int n_ = 0;
  int lane_[kWidth];
  float o_[3][kWidth], d_[3][kWidth], t_max_[kWidth], time_[kWidth], t_[kWidth], u_[kWidth], v_[kWidth];
  int32_t shape_[kWidth], instance_[kWidth];
  uint32_t prim_[kWidth];
  Kept kept_[kWidth];
};

}  // namespace whit
