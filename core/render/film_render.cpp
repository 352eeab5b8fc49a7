#include "core/render/film_render.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <numeric>
#include <utility>

#include "core/render/film_impl.h"
#include "core/render/flush_denormals.h"
#include "core/scene/alpha.h"

namespace whit {
namespace {

/// Processor seconds of this thread.
double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// The pixels whose samples can reach the cropped picture.
Box2i sampled_pixels(const Scene& scene, const FilterTable& filter, const Box2i& window) {
  const Vec2i reach(filter.x_reach(), filter.y_reach());
  Box2i samples(window.min - reach, window.max + reach);
  const auto& bounds = scene.integrator().pixel_bounds();
  if (bounds.size() == 4) {
    samples.min.x = std::max(samples.min.x, bounds[0]), samples.max.x = std::min(samples.max.x, bounds[1]);
    samples.min.y = std::max(samples.min.y, bounds[2]), samples.max.y = std::min(samples.max.y, bounds[3]);
  }
  return samples;
}

/// The tiles of the fixed grid over some pixels; whole tasks, so that every one has as many units.
TileGrid grid_over(const Box2i& pixels, bool adaptive) {
  TileGrid grid;
  if (adaptive) grid.size = kFilmTask / 2, grid.colours = 2;
  if (pixels.max.x <= pixels.min.x || pixels.max.y <= pixels.min.y) return grid;
  const TileGrid tasks;
  const int per_task = kFilmTask / grid.size;
  const Vec2i first(tasks.tile_of(pixels.min.x), tasks.tile_of(pixels.min.y));
  grid.first = first * per_task;
  grid.columns = (tasks.tile_of(pixels.max.x - 1) - first.x + 1) * per_task;
  grid.rows = (tasks.tile_of(pixels.max.y - 1) - first.y + 1) * per_task;
  return grid;
}

}  // namespace

FilmRender::Impl::Impl(const Scene& of, const RenderOptions& asked)
    : scene(of), options(asked), filter(of.filter()), aovs(of, options.aovs), workers([this] {
        return Worker(scene, options.time_stages, aovs.any() ? &aovs : nullptr);
      }) {
  options.blocks |= aovs.blocks;
  prepare();
}

void FilmRender::Impl::prepare() {
  window.resolution = scene.camera().film.resolution;
  double crop[4];
  scene.film().crop_window(crop);
  window.window = crop_pixels(window.resolution, options.crop_given ? options.crop : crop);
  sampled = sampled_pixels(scene, filter, window.window);
  grid = grid_over(sampled, options.adaptive);
  const size_t numbers = TileSums::numbers(filter, grid.size, options.blocks);
  memory = ZeroPages<double>(numbers * grid.units());
  rests = ZeroPages<float>(numbers * grid.units());
  sums.reserve(grid.units());
  if (aovs.any()) aov_tiles.reserve(grid.units());
  for (int y = 0; y < grid.rows; ++y) {
    for (int x = 0; x < grid.columns * grid.colours; ++x) {
      const Vec2i tile = grid.first + Vec2i(x / grid.colours, y);
      const size_t at = numbers * sums.size();
      sums.emplace_back(tile, filter, grid.size, options.blocks, TileMemory{memory.data() + at, rests.data() + at});
      if (aovs.any()) aov_tiles.emplace_back(aovs, tile, filter, grid.size);
    }
  }
  base.assign(grid.units(), options.part ? options.part->first : 0);
  have = base;
  pass.assign(grid.units(), {});
  task_locks = std::vector<std::mutex>(tasks());
}

void FilmRender::Impl::begin_pass(std::span<const uint32_t> want, std::string pass_note) {
  const std::lock_guard lock(pass_lock);
  note = std::move(pass_note);
  pass.assign(grid.units(), {});
  tasks_done = 0;
  for (size_t u = 0; u < pass.size(); ++u) {
    const uint32_t to = std::max(want[u], have[u]);
    if (options.part) pass[u] = {0, to, std::min(to, options.part->last)};
    else pass[u] = {have[u], to, to, options.blocks && have[u] > 0 && to == 2 * have[u]};
    // Beyond the pixels that are sampled nothing is left to do, for nobody.
    if (unit(u).area() == 0) have[u] = pass[u].until;
  }
}

void FilmRender::Impl::render_task(size_t task) {
  if (stopped) return;
  const double start = thread_seconds();
  FlushDenormals flush;
  Worker& worker = workers.local();
  worker.start_clock();
  take_alpha_tests();
  const auto [from, to] = begin_task(task);
  for (uint32_t at = from; at < to && !stopped;) {
    const uint32_t end = std::min(to, at / round * round + round);
    add_round(worker, task, at, end);
    at = end;
    if (at < to) report_progress();
  }
  if (from < to) {
    worker.stop_clock();
    worker.statistics.alpha_tests += take_alpha_tests();
    worker_seconds += thread_seconds() - start;
    if (options.tile_done) preview(task);
  }
  ++tasks_done;
  report_progress();
}

void FilmRender::Impl::begin_blocks(size_t unit) {
  if (pass[unit].doubled && !std::exchange(pass[unit].begun, uint8_t{1})) sums[unit].halve_blocks();
}

std::pair<uint32_t, uint32_t> FilmRender::Impl::begin_task(size_t task) {
  const std::lock_guard lock(task_locks[task]);
  uint32_t from = UINT32_MAX, to = 0;
  each_unit(task, [&](size_t u) {
    if (have[u] == pass[u].until) return;
    begin_blocks(u);
    from = std::min(from, have[u]), to = std::max(to, pass[u].until);
  });
  return {from, to};
}

void FilmRender::Impl::add_round(Worker& worker, size_t task, uint32_t from, uint32_t to) {
  FilmChunk& chunk = chunks.local();
  const std::lock_guard lock(task_locks[task]);
  each_unit(task, [&](size_t u) {
    const uint32_t first = std::max(from, have[u]), last = std::min(to, pass[u].until);
    if (first >= last) return;
    const Box2i pixels = pixels_of(u);
    const int colour = colour_of(u);
    for (int y = pixels.min.y; y < pixels.max.y; ++y) {
      for (int x = pixels.min.x; x < pixels.max.x; ++x) {
        if (colour >= 0 && ((x + y) & 1) != colour) continue;
        for (uint32_t s = first; s < last;) {
          const auto more = static_cast<int>(std::min<uint32_t>(last - s, static_cast<uint32_t>(kFilmChunk - chunk.n)));
          chunk.add(x, y, s, more);
          if (options.blocks) chunk.note_blocks(pass[u], more);
          s += static_cast<uint32_t>(more);
          if (chunk.n == kFilmChunk) close_run(chunk, u), render_chunk(worker, chunk);
        }
      }
    }
    close_run(chunk, u);
    have[u] = last;
  });
  render_chunk(worker, chunk);
  const std::lock_guard counting(statistics_lock);
  statistics.add(std::exchange(worker.statistics, {}));
}

void FilmRender::Impl::close_run(FilmChunk& chunk, size_t unit) {
  const int begin = chunk.runs.empty() ? 0 : chunk.runs.back().second;
  if (chunk.n > begin) chunk.runs.emplace_back(unit, chunk.n);
}

void FilmRender::Impl::render_chunk(Worker& worker, FilmChunk& samples) {
  if (samples.n == 0) return;
  ArenaScope scope(worker.arena);
  generate_camera_rays(worker, samples.n, samples.px, samples.py, samples.index);
  trace_chunk(worker);
  const SampleChunk& c = worker.chunk;
  const uint8_t* usable = weigh_samples(worker);
  for (int i = 0; i < c.n; ++i) {
    if (!usable[i]) worker.statistics.note_invalid({c.px[i], c.py[i]}, c.index[i]);
  }
  int begin = 0;
  for (const auto& [unit, end] : samples.runs) {
    sums[unit].add(end - begin, c.film_x + begin, c.film_y + begin, c.radiance.from(begin), usable + begin,
                   options.blocks ? samples.block + begin : nullptr);
    if (aovs.any()) aov_tiles[unit].add(c, usable, begin, end);
    begin = end;
  }
  samples.n = 0;
  samples.runs.clear();
}

const uint8_t* FilmRender::Impl::weigh_samples(Worker& worker) const {
  const SampleChunk& c = worker.chunk;
  const float brightest = static_cast<float>(scene.film().max_sample_luminance());
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

void FilmRender::Impl::preview(size_t task) const {
  Box2i box;
  each_unit(task, [&](size_t u) { box.extendBy(pixels_of(u)); });
  const Box2i& whole = window.window;
  box.min = {std::max(box.min.x, whole.min.x), std::max(box.min.y, whole.min.y)};
  box.max = {std::min(box.max.x, whole.max.x), std::min(box.max.y, whole.max.y)};
  if (box.min.x >= box.max.x || box.min.y >= box.max.y) return;
  std::vector<float> rgb;
  for (int y = box.min.y; y < box.max.y; ++y) {
    for (int x = box.min.x; x < box.max.x; ++x) {
      const TileSums::Sums s = *sums[static_cast<size_t>(grid.own_unit({x, y}))].at(x, y);
      for (size_t c = 0; c < 3; ++c) rgb.push_back(s[3] != 0 ? static_cast<float>(s[c] / s[3]) : 0.0f);
    }
  }
  options.tile_done(box, rgb);
}

void FilmRender::Impl::report_progress() {
  if (!options.progress) return;
  std::unique_lock lock(progress_mutex, std::try_to_lock);
  if (lock && !options.progress(static_cast<double>(tasks_done) / static_cast<double>(tasks()))) stopped = true;
}

std::vector<double> FilmRender::Impl::weights() const {
  if (std::all_of(have.begin(), have.end(), [&](uint32_t n) { return n == have.front(); })) return {};
  std::vector<double> w(have.size());
  for (size_t u = 0; u < w.size(); ++u) w[u] = taken(u) > 0 ? 1.0 / taken(u) : 0.0;
  return w;
}

double FilmRender::Impl::samples_per_pixel() const {
  double samples = 0, pixels = 0;
  for (size_t u = 0; u < have.size(); ++u) {
    const auto area = static_cast<double>(unit(u).area());
    samples += area * taken(u), pixels += area;
  }
  return pixels > 0 ? samples / pixels : 0.0;
}

double FilmRender::Impl::share() const {
  double samples = 0, all = 0;
  for (size_t u = 0; u < have.size(); ++u) {
    const auto area = static_cast<double>(unit(u).area());
    samples += area * taken(u), all += area * (std::max(have[u], pass[u].until) - base[u]);
  }
  return all > 0 ? samples / all : 1.0;
}

FilmRender::FilmRender(const Scene& scene, const RenderOptions& options)
    : impl_(std::make_unique<Impl>(scene, options)) {}
FilmRender::~FilmRender() = default;

int64_t FilmRender::Unit::area() const {
  const Vec2i size = pixels.max - pixels.min;
  if (size.x <= 0 || size.y <= 0) return 0;
  const int64_t all = int64_t{size.x} * size.y;
  // Of an odd number of pixels the corner's colour has one more.
  return colour < 0 ? all : (all + (holds(pixels.min.x, pixels.min.y) ? 1 : 0)) / 2;
}

bool FilmRender::extend(uint32_t samples) { return extend(impl_->everywhere(samples)); }

bool FilmRender::extend(std::span<const uint32_t> samples, std::string note) {
  begin_pass(samples, std::move(note));
  return go_on();
}

void FilmRender::begin_pass(std::span<const uint32_t> samples, std::string note) {
  impl_->begin_pass(samples, std::move(note));
}

bool FilmRender::go_on() {
  FilmRender* const self = this;
  return extend_tasks(std::span(&self, 1));
}

bool FilmRender::extend_in_turn(std::span<FilmRender* const> films, uint32_t samples) {
  for (FilmRender* film : films) film->impl_->begin_pass(film->impl_->everywhere(samples));
  return extend_tasks(films);
}

bool FilmRender::extend_tasks(std::span<FilmRender* const> films) {
  const auto start = std::chrono::steady_clock::now();
  Impl& first = *films.front()->impl_;
  first.on_threads([&] {
    tbb::parallel_for(
        tbb::blocked_range<size_t>(0, first.tasks(), 1),
        [&](const auto& range) {
          for (size_t t = range.begin(); t != range.end(); ++t) {
            for (size_t k = 0; k < films.size(); ++k) films[(t + k) % films.size()]->impl_->render_task(t);
          }
        },
        tbb::simple_partitioner());
  });
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  bool complete = true;
  for (FilmRender* film : films) {
    const std::lock_guard lock(film->impl_->pass_lock);
    film->impl_->seconds += seconds / static_cast<double>(films.size());
    complete &= !film->impl_->stopped.exchange(false);
  }
  return complete;
}

Picture FilmRender::picture() const {
  Picture picture = impl_->window;
  const std::vector<double> weights = impl_->weights();
  impl_->on_threads([&] {
    resolve_film({impl_->grid, impl_->filter, impl_->sums, weights, -1}, impl_->film_scale(), picture);
  });
  return picture;
}

std::vector<float> FilmRender::variance(int colour) const {
  const Picture& of = impl_->window;
  const auto width = static_cast<size_t>(of.width());
  const double scale2 = static_cast<double>(impl_->film_scale()) * static_cast<double>(impl_->film_scale());
  std::vector<float> out(3 * width * static_cast<size_t>(of.height()));
  const std::vector<double> weights = impl_->weights();
  const FilmUnits film{impl_->grid, impl_->filter, impl_->sums, weights, colour};
  impl_->on_threads([&] {
    tbb::parallel_for(0, of.height(), [&](int row) {
      for (size_t x = 0; x < width; ++x) {
        const Vec3d v = block_variance(film, of.window.min + Vec2i(static_cast<int>(x), row)) * scale2;
        for (int c = 0; c < 3; ++c)
          out[3 * (static_cast<size_t>(row) * width + x) + static_cast<size_t>(c)] = static_cast<float>(v[c]);
      }
    });
  });
  return out;
}

RenderResult FilmRender::result() const {
  const auto start = std::chrono::steady_clock::now();
  const Impl& of = *impl_;
  RenderResult result;
  // A share is no picture, and most of its film is memory that was never touched.
  result.picture = of.is_share ? of.window : picture();
  if (of.aovs.any() && !of.is_share) {
    const std::vector<double> weights = of.weights();
    of.on_threads([&] {
      result.aovs = resolve_aovs(of.scene, of.aovs, of.options.aovs.place, of.aov_tiles,
                                 {of.grid, of.filter, of.sums, weights, -1}, result.picture.window);
    });
  }
  result.statistics = of.statistics;
  for (const Worker& w : of.workers) result.statistics.add(w.statistics);
  result.samples_per_pixel = of.samples_per_pixel();
  result.share = of.share();
  result.threads = of.threads();
  result.cpu_seconds = cpu_seconds();
  result.seconds = of.seconds + std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

double FilmRender::cpu_seconds() const { return impl_->worker_seconds; }

bool FilmRender::restored() const { return impl_->restored; }
const std::string& FilmRender::note() const { return impl_->note; }

uint32_t FilmRender::wanted() const {
  uint32_t most = 0;
  for (const FilmUnitPass& p : impl_->pass) most = std::max(most, p.want);
  return most;
}

FilmPart FilmRender::part() const {
  const Impl& of = *impl_;
  FilmPart part{of.window.resolution, of.window.window, {}};
  if (of.options.adaptive) return part;
  const uint32_t all = std::max(static_cast<uint32_t>(of.scene.samples_per_pixel), wanted());
  part.samples = of.options.part.value_or(SampleRange{0, all, all});
  return part;
}

std::vector<FilmRender::Unit> FilmRender::units() const {
  std::vector<Unit> units;
  for (size_t u = 0; u < impl_->have.size(); ++u) units.push_back(impl_->unit(u));
  return units;
}

}  // namespace whit
