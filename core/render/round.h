// One batch of rays on its way through the stages: the renderer's side of core/plugin/integrator.h.
#pragma once

#include <optional>
#include <vector>

#include "core/plugin/integrator.h"
#include "core/render/light_reach.h"
#include "core/render/surface.h"
#include "core/render/worker.h"

namespace whit {

class Round final : public RayRound {
 public:
  /// Rays [first, first + count) of worker.level(depth); new rays are appended to worker.level(depth + 1).
  Round(Worker& worker, int depth, int first, int count);

  int depth() const override { return depth_; }
  void intersect() override;
  void add_escaped() override;
  void find_surfaces() override;
  void add_emitted() override;
  int light_count() const override { return static_cast<int>(scene_.lights.size()); }
  void add_direct(int light) override;
  void spawn_specular() override;

  /// Adds what the surfaces sent to the radiance of their samples. Ends the round.
  void deliver();

 private:
  friend class RoundLog;
  using Run = MaterialRun;

  void pass_through_interfaces();
  void report_lost_rays();
  void gather_hits(const int32_t* order, int n);
  void take_hits();
  void shade_runs();
  bool needs_numbers() const;
  SampleKeys make_keys() const;
  bool leaves_dark(const SceneLight& light);
  void scatter(const LightSamples& samples, const RGBLanes& f);
  void add_unshadowed(const SceneLight& light, const LightSamples& samples, const RGBLanes& contribution);

  struct Spawned {
    Vec3Lanes wi;
    RGBLanes weight;
    Vec3Lanes rx_o, rx_d, ry_o, ry_d;
  };
  Spawned allocate_spawned();
  void spawn(bool refraction, const Spawned& out);
  void spawn_differentials(const Run& run, bool refraction, const Spawned& out) const;
  void append_children(const Spawned& reflected, const Spawned& refracted, bool any_reflected, bool any_refracted);

  Worker& worker_;
  const Scene& scene_;
  Arena& arena_;
  ArenaScope scope_;
  const int depth_;
  const RayList& rays_;
  const int first_, count_;

  Vec3Lanes ray_o_, ray_d_, ray_rx_o_, ray_rx_d_, ray_ry_o_, ray_ry_d_;  ///< By ray.
  const float* ray_time_ = nullptr;
  HitLanes ray_hits_;
  SurfaceHits hits_;           ///< By point: grouped by material.
  int32_t* ray_of_ = nullptr;  ///< The ray (0 .. count) of a point.
  RGBLanes throughput_, radiance_;
  int32_t* slot_ = nullptr;
  uint32_t* stream_ = nullptr;
  SampleKeys keys_;  ///< Of the points; empty when nothing is drawn for them.
  ShadingBatch points_;
  std::optional<PointBounds> bounds_;  ///< Of the points, once a light has been compared with them.
  std::optional<bool> finite_;         ///< are_finite(), once asked.
  std::vector<Run>& runs_;
};

}  // namespace whit
