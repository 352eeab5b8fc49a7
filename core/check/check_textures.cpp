// Pictures much finer or coarser than the view shows them.

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/check/findings.h"
#include "core/check/view_rays.h"

namespace whit {
namespace {

/// So many texels along a pixel, or so many pixels along a texel, are far from what shows.
constexpr float kFar = 16;
/// Pictures of fewer texels are patterns.
constexpr int kPattern = 64;

struct Use {
  int width = 0, height = 0;
  float least = std::numeric_limits<float>::infinity(), most = 0;  ///< Texels along a pixel.
};

class Uses {
 public:
  explicit Uses(const Scene& scene)
      : scene_(scene),
        per_pixel_(std::sqrt(static_cast<float>(scene.footprint_samples))),
        all_(scene.bound.textures.size()) {}

  /// Points that wear one material.
  void note(size_t material, const ShadingBatch& at) {
    for (const TextureUse& use : scene_.bound.materials[material].textures)
      note_texture(static_cast<size_t>(use.texture), at);
    for (const int member : scene_.bound.materials[material].materials) note(static_cast<size_t>(member), at);
  }

  const std::vector<Use>& all() const { return all_; }

 private:
  void note_texture(size_t t, const ShadingBatch& at) {
    const auto& bound = scene_.bound.textures[t];
    if (!bound.plugin || !scene_.plan.texture_live[t]) return;
    const ArenaScope scope(*at.arena);
    std::optional<TexelUse> used;
    if (const auto* f = dynamic_cast<const Texture<float>*>(bound.plugin.get())) used = f->texels_used(at);
    if (const auto* c = dynamic_cast<const Texture<RGB>*>(bound.plugin.get())) used = c->texels_used(at);
    Use& use = all_[t];
    if (used) {
      use.width = used->width, use.height = used->height;
      for (int i = 0; i < at.n; ++i) {
        // A ray without neighbours has no footprint, and nothing can be said of its point.
        if (!(used->most[i] > 0) || !std::isfinite(used->most[i])) continue;
        use.least = std::min(use.least, used->least[i] * per_pixel_);
        use.most = std::max(use.most, used->most[i] * per_pixel_);
      }
    }
    for (const TextureUse& part : bound.textures) note_texture(static_cast<size_t>(part.texture), at);
  }

  const Scene& scene_;
  const float per_pixel_;
  std::vector<Use> all_;
};

std::string size_text(int width, int height) { return std::to_string(width) + " x " + std::to_string(height); }

/// The next power of two, so that nothing is lost by another resampling.
int enough(float texels) {
  int size = 1;
  while (static_cast<float>(size) < texels) size *= 2;
  return size;
}

}  // namespace

void check_textures(const Scene& scene, Findings& found) {
  if (!scene.plan.live(Effect::Textures) || !scene.plan.needs_differentials()) return;
  Uses uses(scene);
  for_view_rays(scene, 4096, [&](Worker&, const Rays&, const Points& points) {
    for (int first = 0; first < points.n;) {
      const auto material_of = [&](int i) { return scene.shapes[static_cast<size_t>(points.hits.shape[i])].material; };
      int last = first + 1;
      while (last < points.n && material_of(last) == material_of(first)) ++last;
      uses.note(static_cast<size_t>(material_of(first)), points.at.range(first, last - first));
      first = last;
    }
    return true;
  });
  for (size_t t = 0; t < uses.all().size(); ++t) {
    const Use& use = uses.all()[t];
    const TextureDescription& d = scene.bound.description->textures[t];
    if (use.most <= 0) continue;
    const std::string name = "\"" + d.name + "\", of " + size_text(use.width, use.height) + " texels, ";
    if (use.least > kFar) {
      const auto side = [&](int texels) { return std::min(texels, enough(static_cast<float>(texels) / use.least)); };
      found.add("fine-texture", d.where,
                "texture " + name + "is shown with at least " + std::to_string(static_cast<int>(use.least)) +
                    " texels along each pixel",
                "a picture of " + size_text(side(use.width), side(use.height)) + " would look the same");
    } else if (use.most < 1 / kFar && use.width * use.height > kPattern) {
      found.add("coarse-texture", d.where,
                "texture " + name + "is shown with at least " + std::to_string(static_cast<int>(1 / use.most)) +
                    " pixels along each texel",
                "it looks blurred");
    }
  }
}

}  // namespace whit
