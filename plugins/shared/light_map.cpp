#include "plugins/shared/light_map.h"

#include <limits>

#include "core/base/fastmath.h"
#include "core/image/image.h"
#include "core/image/picture_need.h"
#include "core/image/texture_store.h"

namespace whit {
namespace {

TextureSpec spec_of(const FileName& file, WrapMode wrap) {
  TextureSpec spec;
  spec.path = file.path;
  spec.flip = false;
  spec.wrap = wrap;
  return spec;
}

}  // namespace

MemoryNeed LightMap::need(const FileName& file, WrapMode wrap) {
  return file.empty() ? MemoryNeed() : texture_need(spec_of(file, wrap));
}

bool LightMap::prepare(const PrepareContext& ctx, const FileName& file, WrapMode wrap) {
  if (file.empty()) return true;
  const Result<ImageInfo> info = probe_image(file.path);
  if (!info.ok()) {
    ctx.diagnostics->file_error(file.where, info.error);
    return false;
  }
  aspect_ = static_cast<double>(info.value.width) / info.value.height;
  image_ = ctx.textures->add(spec_of(file, wrap), file.where);
  return true;
}

void LightMap::look_up(int n, const float* s, const float* t, const RGBLanes& out) const {
  image_->lookup(n, s, t, nullptr, nullptr, nullptr, nullptr, out.r, out.g, out.b);
  constexpr float kMost = std::numeric_limits<float>::max();
  for_lanes(n, [=](int i) {
    const auto sound = [](float x) { return x <= kMost ? max_of(x, 0.0f) : 0.0f; };
    out.set(i, {sound(out.r[i]), sound(out.g[i]), sound(out.b[i])});
  });
}

RGB LightMap::mean() const {
  // As pbrt: in the middle of the level of 2 x 2 texels.
  const float middle = 0.5f, width = 0.5f;
  RGB mean(0.0f);
  image_->lookup_width(1, &middle, &middle, &width, &mean.x, &mean.y, &mean.z);
  return mean;
}

}  // namespace whit
