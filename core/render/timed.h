// Which stage of light transport the time goes into.
#pragma once

#include "core/batch/stage_clock.h"
#include "core/render/wrapper.h"

namespace whit {

/// Tells a clock what each call is about.
class TimedTransport final : public TransportWrapper {
 private:
  template <class Call>
  auto in(Stage stage, const Call& call) {
    const StageScope scope(&clock_, stage);
    return call();
  }

 public:
  TimedTransport(Transport& inner, StageClock& clock) : TransportWrapper(inner), clock_(clock) {}

  Hits intersect(Rays& rays) override {
    return in(Stage::Intersect, [&] { return inner_.intersect(rays); });
  }
  Seen escaped(const Rays& rays, const Hits& hits, Heuristic h) override {
    return in(Stage::LightSampling, [&] { return inner_.escaped(rays, hits, h); });
  }
  Points surfaces(const Rays& rays, const Hits& hits, Which which) override {
    Points points = in(Stage::Interaction, [&] { return inner_.surfaces(rays, hits, which); });
    points.at.clock = &clock_;  // textures tell it themselves
    return points;
  }
  Seen emitted(const Points& points, Heuristic h) override {
    return in(Stage::LightSampling, [&] { return inner_.emitted(points, h); });
  }
  void shade(Points& points) override {
    in(Stage::Lobes, [&] { inner_.shade(points); });
  }
  int next_light(const Points& points, int light) override {
    return in(Stage::LightSampling, [&] { return inner_.next_light(points, light); });
  }
  DirectSamples sample(const Points& points, int light, int number, int of, bool densities) override {
    return in(Stage::LightSampling, [&] { return inner_.sample(points, light, number, of, densities); });
  }
  ChosenLights choose_lights(const Points& points, int dimension) override {
    return in(Stage::LightSampling, [&] { return inner_.choose_lights(points, dimension); });
  }
  DirectSamples sample(const Points& points, const ChosenLights& chosen, int number) override {
    return in(Stage::LightSampling, [&] { return inner_.sample(points, chosen, number); });
  }
  Scattered scatter(const Points& points, const Vec3Lanes& wi, bool densities, LobeKinds kinds) override {
    return in(Stage::Lobes, [&] { return inner_.scatter(points, wi, densities, kinds); });
  }
  RGBLanes visible(const Points& points, const DirectSamples& samples, const RGBLanes& light) override {
    return in(Stage::Shadow, [&] { return inner_.visible(points, samples, light); });
  }
  Onward mirrored(const Points& points, int dimension) override {
    return in(Stage::Spawn, [&] { return inner_.mirrored(points, dimension); });
  }
  Onward refracted(const Points& points, int dimension) override {
    return in(Stage::Spawn, [&] { return inner_.refracted(points, dimension); });
  }
  Onward sampled(const Points& points, int dimension, LobeKinds kinds) override {
    return in(Stage::Spawn, [&] { return inner_.sampled(points, dimension, kinds); });
  }
  void roulette(const Points& points, const Onward& onward, int dimension, float threshold) override {
    in(Stage::Spawn, [&] { inner_.roulette(points, onward, dimension, threshold); });
  }
  Rays rays(const Points& points, const Onward& onward) override {
    return in(Stage::Spawn, [&] { return inner_.rays(points, onward); });
  }
  void send(const Points& points, const Onward& onward, const Onward& also) override {
    in(Stage::Spawn, [&] { inner_.send(points, onward, also); });
  }

 private:
  StageClock& clock_;
};

}  // namespace whit
