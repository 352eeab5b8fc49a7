// Rendering a scene: tiles over threads, samples into the film.
#pragma once

#include <functional>
#include <optional>
#include <span>

#include "core/render/aov_film.h"
#include "core/render/film_buffer.h"
#include "core/render/film_keeper.h"
#include "core/render/statistics.h"
#include "core/scene/scene.h"

namespace whit {

/// The samples [first, last) of each pixel's `whole`.
struct SampleRange {
  uint32_t first = 0, last = 0, whole = 0;
};

struct RenderOptions {
  int threads = 0;                ///< 0: one per core.
  bool crop_given = false;        ///< crop overrides the film's.
  double crop[4] = {0, 1, 0, 1};  ///< x0, x1, y0, y1 as fractions of the picture.
  AovRequest aovs{};              ///< What the picture holds beside its colours.
  bool blocks = false;            ///< Keep sums of four blocks of samples, from which the error can be told.
  bool adaptive = false;          ///< Smaller units, which may have different numbers of samples (film_render.h).
  bool time_stages = false;       ///< Fills the statistics' seconds by stage.
  /// Called now and then, from one thread at a time, with the share done in [0,1]; returning false stops.
  std::function<bool(double)> progress{};
  /// Called from any worker when a tile's own samples are done: its window and linear RGB, row by row, without what
  /// the neighbours' samples add within the filter's reach. For previews.
  std::function<void(const Box2i&, std::span<const float>)> tile_done{};
  FilmKeeper* keeper = nullptr;       ///< Keeps the film's state meanwhile, and may have an earlier one's.
  std::optional<SampleRange> part{};  ///< Of the samples, these alone: FilmRender::merge() makes a whole of parts.
  uint32_t more_samples = 0;          ///< Beyond those that the scene, or the film that was kept, was to have.
};

struct RenderResult {
  Picture picture;
  AovPicture aovs;  ///< What RenderOptions::aovs asks for, of the same window.
  RenderStatistics statistics;
  double samples_per_pixel = 0;  ///< On average, where units have different numbers.
  double seconds = 0;            ///< Of the render loop, wall clock.
  double cpu_seconds = 0;        ///< The same of the processors, added up over threads.
  int threads = 1;
  bool complete = true;  ///< False when progress() stopped it.
  double share = 1;      ///< Of the samples that were wanted, those that there are.
};

/// The pixels a render covers: the film's crop, or the one given; x1 and y1 exclusive.
Box2i crop_pixels(const Vec2i& resolution, const double crop[4]);

/// The other way: the window, as fractions of the picture, of which crop_pixels() makes these pixels.
void pixel_crop(const Box2i& pixels, const Vec2i& resolution, double (&crop)[4]);

/// Renders. The picture has the same bits for any number of threads and any crop.
RenderResult render(const Scene& scene, const RenderOptions& options);

}  // namespace whit
