#include "core/render/render.h"

#include <pmmintrin.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <xmmintrin.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <mutex>

#include "core/render/flush_denormals.h"
#include "core/render/trace.h"
#include "core/scene/alpha.h"

namespace whit {
namespace {

/// Camera samples traced together.
constexpr int kChunk = 2048;

class FilmRender {
 public:
  FilmRender(const Scene& scene, const RenderOptions& options)
      : scene_(scene), options_(options), filter_(scene.filter()), aovs_(scene, options.aovs), workers_([&] {
          return Worker(scene, options.time_stages, aovs_.any() ? &aovs_ : nullptr);
        }) {}

  RenderResult run() {
    prepare();
    const auto start = std::chrono::steady_clock::now();
    const int threads = options_.threads > 0 ? options_.threads : tbb::this_task_arena::max_concurrency();
    tbb::global_control control(tbb::global_control::max_allowed_parallelism,
                                static_cast<size_t>(std::max(threads, 1)));
    tbb::task_arena arena(threads);
    arena.execute([&] {
      tbb::parallel_for(
          tbb::blocked_range<size_t>(0, tiles_.size(), 1),
          [&](const auto& range) {
            for (size_t t = range.begin(); t != range.end(); ++t) render_tile(t);
          },
          tbb::simple_partitioner());
      resolve_film(tiles_, grid_, filter_, static_cast<float>(scene_.film().scale()), result_.picture);
      if (!aovs_.any()) return;
      result_.aovs =
          resolve_aovs(scene_, aovs_, options_.aovs.place, aov_tiles_, grid_, filter_, result_.picture.window);
    });
    for (const Worker& w : workers_) result_.statistics.add(w.statistics);
    result_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    result_.threads = threads;
    result_.complete = !stopped_;
    return std::move(result_);
  }

 private:
  /// Lays the tiles of the fixed grid over the pixels whose samples can reach the cropped picture.
  void prepare() {
    Picture& picture = result_.picture;
    picture.resolution = scene_.camera().film.resolution;
    double crop[4];
    scene_.film().crop_window(crop);
    picture.window = crop_pixels(picture.resolution, options_.crop_given ? options_.crop : crop);
    const Vec2i reach(filter_.x_reach(), filter_.y_reach());
    samples_ = Box2i(picture.window.min - reach, picture.window.max + reach);
    const auto& bounds = scene_.integrator().pixel_bounds();
    if (bounds.size() == 4) {
      samples_.min.x = std::max(samples_.min.x, bounds[0]), samples_.max.x = std::min(samples_.max.x, bounds[1]);
      samples_.min.y = std::max(samples_.min.y, bounds[2]), samples_.max.y = std::min(samples_.max.y, bounds[3]);
    }
    const auto tile_of = TileReach::tile_of;
    if (samples_.max.x <= samples_.min.x || samples_.max.y <= samples_.min.y) return;
    grid_.first = {tile_of(samples_.min.x), tile_of(samples_.min.y)};
    grid_.columns = tile_of(samples_.max.x - 1) - grid_.first.x + 1;
    grid_.rows = tile_of(samples_.max.y - 1) - grid_.first.y + 1;
    const size_t tiles = static_cast<size_t>(grid_.columns) * static_cast<size_t>(grid_.rows);
    tiles_.reserve(tiles);
    if (aovs_.any()) aov_tiles_.reserve(tiles);
    for (int y = 0; y < grid_.rows; ++y) {
      for (int x = 0; x < grid_.columns; ++x) {
        tiles_.emplace_back(grid_.first + Vec2i(x, y), filter_);
        if (aovs_.any()) aov_tiles_.emplace_back(aovs_, grid_.first + Vec2i(x, y), filter_);
      }
    }
  }

  void render_tile(size_t t) {
    if (stopped_) return;
    FlushDenormals flush;
    Worker& worker = workers_.local();
    worker.start_clock();
    take_alpha_tests();
    const Vec2i tile = grid_.first + Vec2i(static_cast<int>(t) % grid_.columns, static_cast<int>(t) / grid_.columns);
    const int x0 = std::max(tile.x * TileSums::kTile, samples_.min.x);
    const int x1 = std::min((tile.x + 1) * TileSums::kTile, samples_.max.x);
    const int y0 = std::max(tile.y * TileSums::kTile, samples_.min.y);
    const int y1 = std::min((tile.y + 1) * TileSums::kTile, samples_.max.y);
    int32_t px[kChunk], py[kChunk];
    uint32_t index[kChunk];
    int n = 0;
    for (int y = y0; y < y1; ++y) {
      for (int x = x0; x < x1; ++x) {
        for (int s = 0; s < scene_.samples_per_pixel; ++s) {
          px[n] = x, py[n] = y, index[n] = static_cast<uint32_t>(s);
          if (++n == kChunk) render_samples(worker, t, std::exchange(n, 0), px, py, index);
        }
      }
    }
    if (n > 0) render_samples(worker, t, n, px, py, index);
    worker.stop_clock();
    worker.statistics.alpha_tests += take_alpha_tests();
    if (options_.tile_done) preview_tile(tiles_[t], {{x0, y0}, {x1, y1}});
    report_progress();
  }

  void render_samples(Worker& worker, size_t tile, int n, const int32_t* px, const int32_t* py, const uint32_t* index) {
    ArenaScope scope(worker.arena);
    generate_camera_rays(worker, n, px, py, index);
    trace_chunk(worker);
    const SampleChunk& c = worker.chunk;
    const uint8_t* usable = weigh_samples(worker);
    for (int i = 0; i < n; ++i) {
      if (!usable[i]) worker.statistics.note_invalid({c.px[i], c.py[i]}, c.index[i]);
    }
    tiles_[tile].add(n, c.film_x, c.film_y, c.radiance, usable);
    if (aovs_.any()) aov_tiles_[tile].add(c, usable);
  }

  /// Limits the samples' luminance and weighs them as the camera says. Returns which of them are numbers.
  const uint8_t* weigh_samples(Worker& worker) const {
    const SampleChunk& c = worker.chunk;
    const float brightest = static_cast<float>(scene_.film().max_sample_luminance());
    uint8_t* usable = worker.arena.alloc<uint8_t>(c.n);
    for_lanes(c.n, [&](int i) {
      const RGB l = c.radiance[i];
      const float y = luminance(l);
      usable[i] = is_usable_sample(l);
      const float limit = y > brightest ? brightest / y : 1.0f, weight = c.ray_weight[i];
      c.radiance.set(i, {l.x * limit * weight, l.y * limit * weight, l.z * limit * weight});
    });
    return usable;
  }

  void preview_tile(const TileSums& tile, Box2i window) const {
    const Box2i& whole = result_.picture.window;
    window.min = {std::max(window.min.x, whole.min.x), std::max(window.min.y, whole.min.y)};
    window.max = {std::min(window.max.x, whole.max.x), std::min(window.max.y, whole.max.y)};
    if (window.min.x >= window.max.x || window.min.y >= window.max.y) return;
    std::vector<float> rgb;
    for (int y = window.min.y; y < window.max.y; ++y) {
      for (int x = window.min.x; x < window.max.x; ++x) {
        const double* s = tile.at(x, y);
        for (int c = 0; c < 3; ++c) rgb.push_back(s[3] != 0 ? static_cast<float>(s[c] / s[3]) : 0.0f);
      }
    }
    options_.tile_done(window, rgb);
  }

  void report_progress() {
    const size_t done = ++tiles_done_;
    if (!options_.progress) return;
    std::unique_lock lock(progress_mutex_, std::try_to_lock);
    if (lock && !options_.progress(static_cast<double>(done) / static_cast<double>(tiles_.size()))) stopped_ = true;
  }

  const Scene& scene_;
  const RenderOptions& options_;
  FilterTable filter_;
  const AovPlan aovs_;
  tbb::enumerable_thread_specific<Worker> workers_;
  Box2i samples_;
  TileGrid grid_;
  std::vector<TileSums> tiles_;
  std::vector<AovTile> aov_tiles_;  ///< As many, or none.
  std::atomic<size_t> tiles_done_{0};
  std::atomic<bool> stopped_{false};
  std::mutex progress_mutex_;
  RenderResult result_;
};

}  // namespace

Box2i crop_pixels(const Vec2i& resolution, const double crop[4]) {
  // In float, as pbrt: 0.3 of 90 pixels begins at pixel 28.
  const auto edge = [](double f, int n) {
    return std::clamp(static_cast<int>(std::ceil(static_cast<float>(f) * static_cast<float>(n))), 0, n);
  };
  return {{edge(crop[0], resolution.x), edge(crop[2], resolution.y)},
          {edge(crop[1], resolution.x), edge(crop[3], resolution.y)}};
}

RenderResult render(const Scene& scene, const RenderOptions& options) { return FilmRender(scene, options).run(); }

}  // namespace whit
