// Whitted's recursive ray tracing: direct light from every light with one shadow ray each, and perfect mirrors
// and refraction followed to a depth. No interreflection of diffuse or glossy surfaces.
// Source: Whitted, An Improved Illumination Model for Shaded Display, CACM 23(6), 1980; PBR 3e, section 1.3.5.

#include <algorithm>

#include "core/plugin/integrator.h"
#include "core/plugin/registry.h"

namespace whit {
namespace {

struct Whitted final : Integrator {
  int maxdepth = 5;

  int max_depth() const override { return std::max(maxdepth, 1); }

  void shade(RayRound& rays) const override {
    rays.intersect();
    rays.add_escaped();
    rays.find_surfaces();
    rays.add_emitted();
    for (int light = 0; light < rays.light_count(); ++light) rays.add_direct(light);
    if (rays.depth() + 1 < maxdepth) rays.spawn_specular();
  }

  void check(Diagnostics& diagnostics, SourcePos) override {
    if (!bounds.given) return;
    if (bounds.values.size() != 4) {
      diagnostics.error(bounds.where, "\"pixelbounds\" needs four integers: x0 x1 y0 y1");
      return;
    }
    pixel_bounds_.assign(bounds.values.begin(), bounds.values.end());
  }

  IntegerList bounds;
};

const Register<Whitted> whitted{
    "whitted", "Direct light, perfect mirrors and refraction (Whitted 1980).",
    param(&Whitted::maxdepth, "maxdepth", 5, Unit::None,
          "Rounds of rays: 1 or less shows direct light only, each further one a specular bounce.", {kAny.min, 1e6}),
    param(&Whitted::bounds, "pixelbounds", Unit::Pixels, "Renders only this part, x0 x1 y0 y1; the rest is black.")};

}  // namespace
}  // namespace whit
