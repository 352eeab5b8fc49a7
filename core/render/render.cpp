#include "core/render/render.h"

#include <algorithm>
#include <cmath>

#include "core/render/film_render.h"

namespace whit {

Box2i crop_pixels(const Vec2i& resolution, const double crop[4]) {
  // In float, as pbrt: 0.3 of 90 pixels begins at pixel 28.
  const auto edge = [](double f, int n) {
    return std::clamp(static_cast<int>(std::ceil(static_cast<float>(f) * static_cast<float>(n))), 0, n);
  };
  return {{edge(crop[0], resolution.x), edge(crop[2], resolution.y)},
          {edge(crop[1], resolution.x), edge(crop[3], resolution.y)}};
}

void pixel_crop(const Box2i& pixels, const Vec2i& resolution, double (&crop)[4]) {
  for (int axis = 0; axis < 2; ++axis) {
    crop[2 * axis] = (pixels.min[axis] - 0.5) / resolution[axis];
    crop[2 * axis + 1] = (pixels.max[axis] - 0.5) / resolution[axis];
  }
}

RenderResult render(const Scene& scene, const RenderOptions& options) {
  FilmRender film(scene, options);
  const bool usable = !options.keeper || options.keeper->begin(film);
  bool complete = usable && film.go_on();
  if (complete) {
    const uint32_t whole = options.part ? options.part->whole : static_cast<uint32_t>(scene.samples_per_pixel);
    complete = film.extend(std::max(whole, film.wanted()) + options.more_samples);
  }
  if (options.keeper && usable) options.keeper->end(film, complete);
  RenderResult result = film.result();
  result.complete = complete;
  return result;
}

}  // namespace whit
