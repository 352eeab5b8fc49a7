// Direct light by multiple importance sampling: samples of lights and of lobes, weighed by the power heuristic. Mirrors and
// smooth boundaries are followed as by whitted.
// Sources: Veach and Guibas, Optimally Combining Sampling Techniques for Monte Carlo Rendering, SIGGRAPH 1995; PBR 3e,
// section 14.3.

#include <algorithm>

#include "core/plugin/integrator.h"
#include "core/plugin/registry.h"
#include "core/plugin/transport.h"

namespace whit {
namespace {

struct DirectLighting final : Integrator {
  int maxdepth = 5;
  Choice strategy;

  enum Strategy : int { kAll, kOne, kTree };
  bool samples_all() const { return strategy.index == kAll; }
  int max_depth() const override { return std::max(maxdepth, 1); }
  std::optional<LightStrategy> light_strategy() const override {
    return samples_all() ? std::nullopt : std::optional(LightStrategy::Spatial);
  }
  int light_choices() const override { return strategy.index == kTree ? kLightsOfTree : 1; }

  /// After those of the lights: three that are free, a lobe and a direction of it, and a choice between several mirrors
  /// or smooth boundaries.
  enum Dimension : int { kLight = 0, kLobe = 3, kMirror = 6, kBoundary = 7, kDimensions = 8 };
  int dimensions(int lights) const override { return lights + kDimensions; }

  void shade(Rays& rays, Transport& t) const override {
    const Hits hits = t.intersect(rays);
    t.add(rays, t.escaped(rays, hits));
    Points points = t.surfaces(rays, hits);
    t.shade(points);
    t.add(points, t.emitted(points));
    const int own = t.light_dimensions();
    const ChosenLights chosen = t.choose_lights(points, kLight);
    for (int k = 0; k < chosen.of; ++k) {
      const ArenaScope scratch(t.arena());
      add_sampled(points, t.sample(points, chosen, k), t);
    }
    if (chosen.of == 0) add_all(points, t);
    if (t.live(Effect::AreaLights) || t.live(Effect::EnvironmentLights)) add_met(points, own + kLobe, t);
    if (rays.depth + 1 >= maxdepth) return;
    t.send(points, t.mirrored(points, own + kMirror), t.refracted(points, own + kBoundary));
  }

  static void add_all(const Points& points, Transport& t) {
    for (const int light : lights(t, points)) {
      const int of = t.samples_of(light);
      for (int k = 0; k < of; ++k) {
        const ArenaScope scratch(t.arena());
        add_sampled(points, t.sample(points, light, k, of, true), t);
      }
    }
  }

  /// The light of samples, as far as no sampled direction finds it.
  static void add_sampled(const Points& points, const DirectSamples& light, Transport& t) {
    const bool found_otherwise = light.pdf != nullptr;
    const Scattered s = t.scatter(points, light.wi, found_otherwise, LobeKinds::NonSpecular);
    t.add(points, light, t.visible(points, light, arriving(light, s)));
  }

  /// The light that a sampled direction meets, as far as no sample of a light finds it.
  static void add_met(const Points& points, int dimension, Transport& t) {
    Rays rays = t.rays(points, t.sampled(points, dimension, LobeKinds::NonSpecular));
    const Hits hits = t.intersect(rays);
    t.add(rays, t.escaped(rays, hits, power_heuristic));
    const Points emitters = t.surfaces(rays, hits, Transport::Which::Emitting);
    t.add(emitters, t.emitted(emitters, power_heuristic));
  }
};

const Register<DirectLighting> direct_lighting{
    "directlighting", "Direct light by samples of lights and lobes together, perfect mirrors and refraction.",
    param(&DirectLighting::maxdepth, "maxdepth", 5, Unit::None,
          "Rounds of rays: 1 or less shows direct light only, each further one a specular bounce.", {kAny.min, 1e6}),
    choice(
        &DirectLighting::strategy, "strategy", {"all", "one", "tree"},
        "Samples every light as often as its \"samples\" say, or one or a few lights for each point, which a tree of "
        "the lights chooses by what may arrive."),
    pixelbounds_param()};

}  // namespace
}  // namespace whit
