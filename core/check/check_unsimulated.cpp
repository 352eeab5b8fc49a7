// What a scene asks for that is not simulated, beside what a render warns of.

#include <string>

#include "core/check/findings.h"

namespace whit {

void check_unsimulated(const CheckedWorld& world, Findings& found) {
  const SceneDescription& d = world.description;
  for (const Ignored& ignored : world.plan.ignored) {
    // Media and what looks otherwise than one might expect are warnings of every render.
    if (!ignored.instead.empty() || (d.has_media() && ignored.where.offset == d.first_medium().offset)) continue;
    if (world.bound.integrator.replaced) continue;  // Said where it is named.
    found.add("not-simulated", ignored.where, ignored.what + " is not simulated");
  }
  for (size_t i = 1; i < d.materials.size(); ++i) {
    const auto& material = world.bound.materials[i].plugin;
    if (!material || !material->scatters_below() || !world.plan.material_live[i]) continue;
    found.add("not-simulated", d.materials[i].where,
              "scattering below the surface of \"" + d.materials[i].plugin + "\" is not simulated",
              "the surface alone is shown");
  }
}

}  // namespace whit
