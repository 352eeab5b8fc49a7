// Path tracing: light by way of any number of surfaces. At every point one light is sampled and one direction is followed;
// light that both can find is weighed by the power heuristic.
// Sources: Kajiya, The Rendering Equation, SIGGRAPH 1986; Veach, Robust Monte Carlo Methods for Light Transport
// Simulation, 1997, chapters 8 to 10; PBR 3e, section 14.5.4, whose meaning of "maxdepth" and "rrthreshold" this has.

#include <algorithm>

#include "core/plugin/integrator.h"
#include "core/plugin/registry.h"
#include "core/plugin/transport.h"

namespace whit {
namespace {

struct Path final : Integrator {
  int maxdepth = 5;
  float rrthreshold = 1;
  Choice strategy;

  int max_depth() const override { return std::max(maxdepth, 0) + 1; }
  EffectSet simulates() const override { return EffectSet::all(); }
  EffectSet effects() const override { return maxdepth > 0 ? EffectSet{Effect::Indirect} : EffectSet{}; }
  bool keeps_differentials() const override { return false; }
  bool keeps_densities() const override { return true; }
  std::optional<LightStrategy> light_strategy() const override {
    constexpr LightStrategy kNamed[] = {LightStrategy::Spatial, LightStrategy::Uniform, LightStrategy::Power};
    return kNamed[strategy.index];
  }

  /// What is drawn at each bounce: a light and a point of it, a lobe and a direction of it, and whether to go on.
  enum Dimension : int { kLight = 0, kLobe = 3, kRoulette = 6, kDimensions = 7 };
  int dimensions(int) const override { return kDimensions; }

  void shade(Rays& rays, Transport& t) const override {
    const Hits hits = t.intersect(rays);
    t.add(rays, t.escaped(rays, hits, power_heuristic));
    const bool last = rays.depth >= maxdepth;
    Points points = t.surfaces(rays, hits, last ? Transport::Which::Emitting : Transport::Which::All);
    t.add(points, t.emitted(points, power_heuristic));
    if (last) return;
    t.shade(points);
    // Without indirect light no sampled direction finds a light that is sampled here.
    const bool indirect = t.live(Effect::Indirect);
    const ChosenLights chosen = t.choose_lights(points, kLight);
    for (int k = 0; k < chosen.of; ++k) {
      const DirectSamples light = t.sample(points, chosen, k);
      const Scattered scattered = t.scatter(points, light.wi, indirect);
      t.add(points, light, t.visible(points, light, arriving(light, scattered)));
    }
    const Onward onward = t.sampled(points, kLobe, indirect ? LobeKinds::All : LobeKinds::Specular);
    if (rays.depth > 3) t.roulette(points, onward, kRoulette, rrthreshold);
    t.send(points, onward);
  }
};

const Register<Path> path{
    "path",
    "Light by way of all surfaces: path tracing with multiple importance sampling.",
    param(&Path::maxdepth, "maxdepth", 5, Unit::None,
          "Bounces at most: 0 shows what emits, 1 adds direct light, 2 light by way of one other surface.",
          {kAny.min, 1e6}),
    param(&Path::rrthreshold, "rrthreshold", 1.0f, Unit::None,
          "Paths that carry less than this may end at random from the fifth bounce on."),
    choice(&Path::strategy, "lightsamplestrategy", {"spatial", "uniform", "power"},
           "How the one light is chosen: by what may arrive from it, evenly, or by its power."),
    pixelbounds_param()};

}  // namespace
}  // namespace whit
