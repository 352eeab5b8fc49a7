#include "core/plugin/plugin.h"

namespace whit {

const char* effect_name(Effect e) {
  switch (e) {
    case Effect::AreaLight: return "area light";
    case Effect::EnvironmentLight: return "environment light";
    case Effect::DeltaLight: return "delta light";
    case Effect::Mirror: return "mirror";
    case Effect::Refraction: return "refraction";
    case Effect::Glossy: return "glossy";
    case Effect::TextureFiltering: return "texture filtering";
    case Effect::Bump: return "bump";
    case Effect::AlphaMask: return "alpha mask";
    case Effect::MotionBlur: return "motion blur";
    case Effect::DepthOfField: return "depth of field";
    case Effect::Instancing: return "instancing";
    case Effect::Interface: return "interface";
    case Effect::kCount: break;
  }
  return "unknown";
}

}  // namespace whit
