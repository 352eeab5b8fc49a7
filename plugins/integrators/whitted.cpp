// Whitted's recursive ray tracing: direct light from every light with one shadow ray each, and perfect mirrors
// and refraction followed to a depth. No interreflection of diffuse or glossy surfaces.
// Source: Whitted, An Improved Illumination Model for Shaded Display, CACM 23(6), 1980; PBR 3e, section 1.3.5.

#include <algorithm>

#include "core/plugin/integrator.h"
#include "core/plugin/registry.h"
#include "core/plugin/transport.h"

namespace whit {
namespace {

struct Whitted final : Integrator {
  int maxdepth = 5;
  Choice strategy;

  int max_depth() const override { return std::max(maxdepth, 1); }
  std::optional<LightStrategy> light_strategy() const override {
    return strategy.index == 0 ? std::nullopt : std::optional(LightStrategy::Spatial);
  }
  int light_choices() const override { return kLightsOfTree; }

  /// Those of the lights, and a choice between several mirrors or smooth boundaries of a point.
  enum Dimension : int { kLight = 0 };
  int dimensions(int lights) const override { return lights + 2; }

  void shade(Rays& rays, Transport& t) const override {
    const Hits hits = t.intersect(rays);
    t.add(rays, t.escaped(rays, hits));
    Points points = t.surfaces(rays, hits);
    t.shade(points);
    t.add(points, t.emitted(points));
    const ChosenLights chosen = t.choose_lights(points, kLight);
    for (int k = 0; k < chosen.of; ++k) {
      const ArenaScope scratch(t.arena());
      add_sampled(points, t.sample(points, chosen, k), t);
    }
    if (chosen.of == 0) {
      for (const int light : lights(t, points)) add_sampled(points, t.sample(points, light), t);
    }
    if (rays.depth + 1 >= maxdepth) return;
    const int choice = t.light_dimensions();
    t.send(points, t.mirrored(points, choice), t.refracted(points, choice + 1));
  }

  static void add_sampled(const Points& points, const DirectSamples& s, Transport& t) {
    const RGBLanes f = t.scatter(points, s.wi).f;
    t.add(points, s, t.visible(points, s, times(points.n, f, s.radiance)));
  }
};

const Register<Whitted> whitted{
    "whitted", "Direct light, perfect mirrors and refraction (Whitted 1980).",
    param(&Whitted::maxdepth, "maxdepth", 5, Unit::None,
          "Rounds of rays: 1 or less shows direct light only, each further one a specular bounce.", {kAny.min, 1e6}),
    choice(&Whitted::strategy, "strategy", {"all", "tree"},
           "Samples every light at each point, or a few that a tree of the lights chooses by what may arrive."),
    pixelbounds_param()};

}  // namespace
}  // namespace whit
