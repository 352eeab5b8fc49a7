// Light transport over a scene: the renderer's side of core/plugin/transport.h.
#pragma once

#include <vector>

#include "core/plugin/transport.h"
#include "core/render/points.h"
#include "core/render/worker.h"

namespace whit {

/// One worker's transport. What is called for one batch lives until finish().
class Tracer final : public Transport {
 public:
  explicit Tracer(Worker& worker) : worker_(worker), scene_(worker.scene), arena_(worker.arena) {}

  // tracer.cpp
  Hits intersect(Rays& rays) override;
  Points surfaces(const Rays& rays, const Hits& hits, Which which) override;
  void shade(Points& points) override;
  void add(const Rays& rays, const Seen& seen) override;
  void add(const Points& points, const Seen& seen) override;
  void add(const Points& points, const DirectSamples& samples, const RGBLanes& light) override;
  Arena& arena() override { return arena_; }
  bool live(Effect effect) const override { return scene_.plan.live(effect); }
  int light_dimensions() const override { return scene_.light_dimensions; }
  const float* draw_1d(const Points& points, int dimension) override;
  Uniform2 draw_2d(const Points& points, int dimension) override;

  // seen.cpp
  Seen escaped(const Rays& rays, const Hits& hits, Heuristic heuristic) override;
  Seen emitted(const Points& points, Heuristic heuristic) override;

  // direct.cpp
  int next_light(const Points& points, int light) override;
  DirectSamples sample(const Points& points, int light, int number, int of, bool densities) override;
  int samples_of(int light) const override { return scene_.lights[static_cast<size_t>(light)].samples; }
  ChosenLights choose_lights(const Points& points, int dimension) override;
  DirectSamples sample(const Points& points, const ChosenLights& chosen, int number) override;
  Scattered scatter(const Points& points, const Vec3Lanes& wi, bool densities, LobeKinds kinds) override;
  RGBLanes visible(const Points& points, const DirectSamples& samples, const RGBLanes& light) override;

  // onward.cpp
  Onward mirrored(const Points& points, int dimension) override;
  Onward refracted(const Points& points, int dimension) override;
  Onward sampled(const Points& points, int dimension, LobeKinds kinds) override;
  void roulette(const Points& points, const Onward& onward, int dimension, float threshold) override;
  Rays rays(const Points& points, const Onward& onward) override;
  void send(const Points& points, const Onward& onward, const Onward& also) override;

  /// Adds what the points of the batch send to the radiance of their samples. Ends the batch.
  void finish();

  bool skip_dark = true;  ///< Leave lights out that can reach none of the points.

  const Scene& scene() const { return scene_; }
  const SampleChunk& chunk() const { return worker_.chunk; }

 private:
  const SampleKeys& keys_of(const Points& points);
  float expected_samples(int light, const Vec3f& p) const;
  DirectSamples allocate_samples(const Points& points, bool densities);
  bool leaves_dark(const SceneLight& light, const Points& points) const;
  RayLanes shadow_rays(const Points& points, const DirectSamples& samples, const int32_t* lanes, int n);
  Onward specular(const Points& points, LobeType type, int dimension);

  Worker& worker_;
  const Scene& scene_;
  Arena& arena_;
  std::vector<Points> delivering_;  ///< Of the batch; kept for its memory.
};

/// What pass_through_interfaces() did.
struct Passed {
  int64_t traced = 0;   ///< Rays.
  int64_t stopped = 0;  ///< Rays that did not get ahead.
};

/// Sends rays that hit an interface on from behind it, until all have met a material or left. `rays` then have origins
/// (and differentials) of their own. Those that do not get ahead become misses at NaN.
Passed pass_through_interfaces(const Scene& scene, Rays& rays, const Hits& hits, Arena& arena);

}  // namespace whit
