#include "core/watch/effect_costs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/render/film_render.h"

namespace whit {
namespace {

/// Pixels of the piece, in the middle of the picture; and how many samples each has at most.
constexpr double kPixels = 96 * 96;
constexpr int kMostSamples = 64;
/// Processor seconds that tell enough.
constexpr double kEnough = 0.08;

}  // namespace

std::optional<double> EffectCosts::share_without(const BuiltWorld& without, int threads) {
  RenderOptions options;
  options.threads = threads;
  options.progress = [this](double) { return go_on_(); };
  // Every how many-th part of the picture on both axes, around its middle.
  const Vec2i size = world_.scene->camera().film.resolution;
  const double side = std::min(1.0, std::sqrt(kPixels / std::max(1.0, double(size.x) * size.y)));
  options.crop_given = true;
  options.crop[0] = options.crop[2] = 0.5 - side / 2, options.crop[1] = options.crop[3] = 0.5 + side / 2;
  FilmRender a(*world_.scene, options), b(*without.scene, options);
  const std::array<FilmRender*, 2> both{&a, &b};
  const int own = std::min(world_.scene->samples_per_pixel, without.scene->samples_per_pixel);
  const int most = world_.scene->sampler().extends() ? kMostSamples : std::min(kMostSamples, own);
  for (int samples = 1; samples <= most; samples *= 2) {
    if (!FilmRender::extend_in_turn(both, static_cast<uint32_t>(samples))) return std::nullopt;
    if (a.cpu_seconds() > kEnough) break;
  }
  if (!(a.cpu_seconds() > 0)) return std::nullopt;
  return 1 - b.cpu_seconds() / a.cpu_seconds();
}

}  // namespace whit
