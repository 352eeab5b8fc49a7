// Lights that light nothing, as far as their statements tell.

#include <string>
#include <vector>

#include "core/check/findings.h"

namespace whit {

void check_lights(const CheckedWorld& world, Findings& found) {
  const SceneDescription& d = world.description;
  const BoundScene& bound = world.bound;
  for (size_t i = 0; i < d.lights.size(); ++i) {
    const auto& light = bound.lights[i].plugin;
    if (!light) continue;
    const std::string what = "the light \"" + d.lights[i].plugin + '"';
    if (light->is_black()) {
      found.add("black-light", d.lights[i].where, what + " is black: it gives no light");
    } else if (!world.plan.light_live[i] && !(light->effects() - world.plan.off).empty()) {
      found.add("useless-light", d.lights[i].where, what + " lights nothing",
                "no surface scatters light to all sides: mirrors and smooth glass alone do not show it");
    }
  }
  std::vector<int> worn(d.area_lights.size());
  for (const ShapeDescription& shape : d.shapes)
    if (shape.area_light >= 0) ++worn[static_cast<size_t>(shape.area_light)];
  for (size_t i = 0; i < d.area_lights.size(); ++i) {
    const auto& light = bound.area_lights[i].plugin;
    if (!light) continue;
    if (worn[i] == 0) {
      found.add("useless-light", d.area_lights[i].where, "no shape has the emission of this AreaLightSource",
                "it is for the shapes behind it, up to the end of the block around it");
    } else if (is_black(light->radiance())) {
      found.add("black-light", d.area_lights[i].where, "the emission is black: it gives no light");
    }
  }
}

}  // namespace whit
