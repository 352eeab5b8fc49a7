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

  int max_depth() const override { return std::max(maxdepth, 1); }

  /// Those of the lights, and a choice between several mirrors or smooth boundaries of a point.
  int dimensions(int lights) const override { return lights + 2; }

  void shade(Rays& rays, Transport& t) const override {
    const Hits hits = t.intersect(rays);
    t.add(rays, t.escaped(rays, hits));
    Points points = t.surfaces(rays, hits);
    t.shade(points);
    t.add(points, t.emitted(points));
    for (const int light : lights(t, points)) {
      const DirectSamples s = t.sample(points, light);
      const RGBLanes f = t.scatter(points, s.wi).f;
      t.add(points, s, t.visible(points, s, times(points.n, f, s.radiance)));
    }
    if (rays.depth + 1 >= maxdepth) return;
    const int choice = t.light_dimensions();
    t.send(points, t.mirrored(points, choice), t.refracted(points, choice + 1));
  }
};

const Register<Whitted> whitted{
    "whitted", "Direct light, perfect mirrors and refraction (Whitted 1980).",
    param(&Whitted::maxdepth, "maxdepth", 5, Unit::None,
          "Rounds of rays: 1 or less shows direct light only, each further one a specular bounce.", {kAny.min, 1e6}),
    pixelbounds_param()};

}  // namespace
}  // namespace whit
