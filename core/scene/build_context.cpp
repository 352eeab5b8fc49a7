#include "core/scene/build_context.h"

#include <algorithm>

#include "core/scene/motion.h"

namespace whit {

TransformPair BuildContext::transform(int i) const {
  const TransformPair& given = description().transforms[static_cast<size_t>(i)];
  if (!given.animated() || !scene.plan.off.has(Effect::MotionBlur)) return given;
  const double span = description().time_end - description().time_start;
  const double open = static_cast<double>(scene.camera().shutter_open) - description().time_start;
  const Mat4d still = interpolate(given, span != 0 ? std::clamp(open / span, 0.0, 1.0) : 0.0);
  return {still, still};
}

PrepareContext BuildContext::preparation(SourcePos where, Diagnostics& reports) const {
  PrepareContext context;
  context.diagnostics = &reports;
  context.statement = where;
  context.textures = &textures;
  context.space = scene.space;
  context.scene_radius = scene_radius;
  context.samples_per_pixel = scene.samples_per_pixel;
  context.attributes = scene.plan.attributes;
  context.reading_pictures = reading_pictures;
  return context;
}

}  // namespace whit
