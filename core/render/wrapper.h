// A transport around another: what only watches light transport stays out of it.
#pragma once

#include "core/plugin/transport.h"

namespace whit {

/// Hands every call on. What is derived from it looks at what goes in and what comes out.
class TransportWrapper : public Transport {
 public:
  explicit TransportWrapper(Transport& inner) : inner_(inner) {}

  Hits intersect(Rays& rays) override { return inner_.intersect(rays); }
  Seen escaped(const Rays& rays, const Hits& hits, Heuristic h) override { return inner_.escaped(rays, hits, h); }
  Points surfaces(const Rays& rays, const Hits& hits, Which which) override {
    return inner_.surfaces(rays, hits, which);
  }
  Seen emitted(const Points& points, Heuristic h) override { return inner_.emitted(points, h); }
  void shade(Points& points) override { inner_.shade(points); }
  int next_light(const Points& points, int light) override { return inner_.next_light(points, light); }
  DirectSamples sample(const Points& points, int light, int number, int of, bool densities) override {
    return inner_.sample(points, light, number, of, densities);
  }
  ChosenLights choose_lights(const Points& points, int dimension) override {
    return inner_.choose_lights(points, dimension);
  }
  DirectSamples sample(const Points& points, const ChosenLights& chosen, int number) override {
    return inner_.sample(points, chosen, number);
  }
  Scattered scatter(const Points& points, const Vec3Lanes& wi, bool densities, LobeKinds kinds) override {
    return inner_.scatter(points, wi, densities, kinds);
  }
  RGBLanes visible(const Points& points, const DirectSamples& samples, const RGBLanes& light) override {
    return inner_.visible(points, samples, light);
  }
  Onward mirrored(const Points& points, int dimension) override { return inner_.mirrored(points, dimension); }
  Onward refracted(const Points& points, int dimension) override { return inner_.refracted(points, dimension); }
  Onward sampled(const Points& points, int dimension, LobeKinds kinds) override {
    return inner_.sampled(points, dimension, kinds);
  }
  void roulette(const Points& points, const Onward& onward, int dimension, float threshold) override {
    inner_.roulette(points, onward, dimension, threshold);
  }
  Rays rays(const Points& points, const Onward& onward) override { return inner_.rays(points, onward); }
  void send(const Points& points, const Onward& onward, const Onward& also) override {
    inner_.send(points, onward, also);
  }
  void add(const Rays& rays, const Seen& seen) override { inner_.add(rays, seen); }
  void add(const Points& points, const Seen& seen) override { inner_.add(points, seen); }
  void add(const Points& points, const DirectSamples& samples, const RGBLanes& light) override {
    inner_.add(points, samples, light);
  }
  int samples_of(int light) const override { return inner_.samples_of(light); }
  bool live(Effect effect) const override { return inner_.live(effect); }
  Arena& arena() override { return inner_.arena(); }
  int light_dimensions() const override { return inner_.light_dimensions(); }
  const float* draw_1d(const Points& points, int dimension) override { return inner_.draw_1d(points, dimension); }
  Uniform2 draw_2d(const Points& points, int dimension) override { return inner_.draw_2d(points, dimension); }

 protected:
  Transport& inner_;
};

}  // namespace whit
