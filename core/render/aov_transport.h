// Light transport that notes what AOVs ask for: values of first surfaces, and by which way light got to the camera.
#pragma once

#include "core/render/aov_plan.h"
#include "core/render/worker.h"
#include "core/render/wrapper.h"

namespace whit {

/// Watches camera rays and what is added to samples, and fills the arrays of the samples' chunk.
class AovTransport final : public TransportWrapper {
 public:
  AovTransport(Transport& inner, const Scene& scene, const AovPlan& plan, const SampleChunk& chunk)
      : TransportWrapper(inner), scene_(scene), plan_(plan), chunk_(chunk) {}

  Points surfaces(const Rays& rays, const Hits& hits, Which which) override;
  void shade(Points& points) override;
  void add(const Rays& rays, const Seen& seen) override;
  void add(const Points& points, const Seen& seen) override;
  void add(const Points& points, const DirectSamples& samples, const RGBLanes& light) override;

 private:
  void note_surfaces(const Points& points);
  void add_part(const Rays& rays, int ray, const RGB& light, bool seen);
  void add_to_group(int group, const Rays& rays, int ray, const RGB& light);

  const Scene& scene_;
  const AovPlan& plan_;
  const SampleChunk& chunk_;
};

}  // namespace whit
