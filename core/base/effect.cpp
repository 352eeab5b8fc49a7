#include "core/base/effect.h"

#include <algorithm>
#include <string_view>

namespace whit {
namespace {

/// In the order of Effect.
constexpr EffectInfo kInfos[] = {
    {"diffuse", "light scattered to all sides", "no diffuse lobes", "lobes evaluated for each light", "", 0, 12},
    {"glossy", "rough reflection and transmission", "no rough lobes", "lobes evaluated for each light", "", 0, 24},
    {"reflection", "perfect mirrors", "no mirror rays", "mirror rays, traced in another round",
     "1 per bounce, drawn where a surface has two such lobes", 44, 24},
    {"refraction", "perfectly clear boundaries", "no refracted rays", "refracted rays, traced in another round",
     "1 per bounce, drawn where a surface has two such lobes", 44, 24},
    {"area-lights", "surfaces that emit", "nothing emits", "emission added; each emitter sampled",
     "2 per bounce and emitter", 0, 48},
    {"environment-lights", "light from infinity", "a black sky", "escaped rays see it; each sampled",
     "2 per bounce and light", 0, 48},
    {"delta-lights", "points and directions that radiate", "none of these lights", "each evaluated", "", 0, 40},
    {"shadows", "what stands between a surface and a light", "light passes through everything", "shadow rays", "", 0,
     33},
    {"textures", "parameters that change over a surface", "each parameter at its default", "textures evaluated", "", 0,
     12},
    {"texture-filtering", "textures averaged over a sample's footprint", "textures looked up at points",
     "differential rays from the camera and on, footprints", "", 48, 64},
    {"bump", "normals tilted by bump and normal maps", "smooth normals",
     "displacement evaluated three times; differential rays, footprints", "", 48, 64},
    {"alpha", "surfaces cut out by a texture", "whole surfaces", "the ray tracer asks at each hit", "", 0, 0},
    {"motion-blur", "things that move while the shutter is open", "all as it is when the shutter opens",
     "times sampled, transforms interpolated", "1 per sample", 4, 4},
    {"depth-of-field", "a lens with an area", "rays through the middle of the lens", "positions on the lens sampled",
     "2 per sample", 0, 0},
    {"instancing", "objects that are placed", "no placed objects", "points taken to render space and back", "", 0, 4},
    {"interfaces", "surfaces without a material", "none of these surfaces", "rays sent on behind them", "", 0, 0},
    {"indirect", "light by way of other surfaces that scatter", "direct light alone",
     "rays sampled from lobes, traced in another round", "7 per bounce", 64, 32},
};
static_assert(std::size(kInfos) == kEffects);

}  // namespace

const EffectInfo& effect_info(Effect e) { return kInfos[static_cast<size_t>(e)]; }

std::vector<std::string> effect_names() {
  std::vector<std::string> names;
  for (const EffectInfo& info : kInfos) names.emplace_back(info.name);
  return names;
}

EffectSet parse_effects(const std::string& names, std::string& unknown) {
  EffectSet set;
  for (size_t begin = 0; begin <= names.size();) {
    const size_t end = std::min(names.find(',', begin), names.size());
    const std::string_view name = std::string_view(names).substr(begin, end - begin);
    const auto* found =
        std::find_if(std::begin(kInfos), std::end(kInfos), [&](const auto& i) { return name == i.name; });
    if (found == std::end(kInfos)) {
      unknown = name;
      return {};
    }
    set.add(static_cast<Effect>(found - kInfos));
    begin = end + 1;
  }
  return set;
}

}  // namespace whit
