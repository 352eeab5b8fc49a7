#include "core/render/film_render.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <ctime>
#include <numeric>
#include <utility>

#include "core/batch/zero_pages.h"
#include "core/render/borrowed_arena.h"
#include "core/render/flush_denormals.h"
#include "core/render/trace.h"
#include "core/scene/alpha.h"

namespace whit {
namespace {

/// Camera samples traced together.
constexpr int kChunk = 2048;
/// Pixels on each side of what one thread renders at a time.
constexpr int kTask = 16;
/// Samples of a pixel that are taken before the next pixel's turn. States are saved, and renders stopped, between rounds
/// only. Longer ones keep rays together (4 % of the time on scenes/mesh.pbrt), where a filter keeps to its pixel.
constexpr uint32_t kRound = 64, kLongRound = 1024;

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
  if (adaptive) grid.size = kTask / 2, grid.colours = 2;
  if (pixels.max.x <= pixels.min.x || pixels.max.y <= pixels.min.y) return grid;
  const TileGrid tasks;
  const int per_task = kTask / grid.size;
  const Vec2i first(tasks.tile_of(pixels.min.x), tasks.tile_of(pixels.min.y));
  grid.first = first * per_task;
  grid.columns = (tasks.tile_of(pixels.max.x - 1) - first.x + 1) * per_task;
  grid.rows = (tasks.tile_of(pixels.max.y - 1) - first.y + 1) * per_task;
  return grid;
}

/// What a pass adds to a unit: the samples [have, want), and in which blocks; of a part of a picture, only those up to
/// `until`, in the blocks of the whole.
struct UnitPass {
  uint32_t have = 0, want = 0, until = 0;
  // Bytes from a file may be anything, which a bool must not.
  uint8_t doubled = 0;  ///< As many again: they are the last two blocks.
  uint8_t begun = 0;    ///< The blocks are ready for them.

  bool operator==(const UnitPass&) const = default;
  /// The same samples in the same blocks.
  bool is_like(const UnitPass& p) const {
    return have == p.have && want == p.want && until == p.until && doubled == p.doubled;
  }
  uint8_t block(uint32_t sample) const {
    const uint64_t at = sample - have, of = want - have;
    return static_cast<uint8_t>(doubled ? 2 + 2 * at / of : TileSums::kBlocks * at / of);
  }
};

/// A unit of a pass, as whoever takes a share of it needs to know it.
struct UnitRest {
  uint32_t unit = 0, have = 0;
  UnitPass pass;
};

/// Whose turn the n-th of some tiles is, of so many: one in each round, which begins elsewhere each time, so that no share
/// is a column of the film.
size_t turn(size_t n, size_t of) {
  const auto step = static_cast<size_t>(std::lround(0.618 * static_cast<double>(of)));  // the golden ratio
  return (n % of + n / of * step) % of;
}

/// Samples on their way into a chunk, and which unit and block each belongs to.
struct Chunk {
  int n = 0;
  int32_t px[kChunk], py[kChunk];
  uint32_t index[kChunk];
  uint8_t block[kChunk];
  /// The units in order, each up to where its samples end.
  std::vector<std::pair<size_t, int>> runs;

  /// Samples of a pixel from `first` on; there must be room.
  void add(int x, int y, uint32_t first, int more) {
    int32_t *const to_x = px + n, *const to_y = py + n;
    uint32_t* const to = index + n;
    for_lanes(more, [=](int i) { to_x[i] = x, to_y[i] = y, to[i] = first + static_cast<uint32_t>(i); });
    n += more;
  }
  /// Of those that were added last.
  void note_blocks(const UnitPass& pass, int more) {
    for (int i = n - more; i < n; ++i) block[i] = pass.block(index[i]);
  }
};

}  // namespace

struct FilmRender::Impl {
  Impl(const Scene& of, const RenderOptions& asked)
      : scene(of), options(asked), filter(of.filter()), aovs(of, options.aovs), workers([this] {
          return Worker(scene, options.time_stages, aovs.any() ? &aovs : nullptr);
        }) {
    options.blocks |= aovs.blocks;
    prepare();
  }

  void prepare() {
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

  // ---- Threads ----

  int threads() const { return options.threads > 0 ? options.threads : tbb::this_task_arena::max_concurrency(); }

  template <class Body>
  void on_threads(const Body& body) const {
    tbb::global_control control(tbb::global_control::max_allowed_parallelism,
                                static_cast<size_t>(std::max(threads(), 1)));
    BorrowedArena arena(threads());
    arena.execute(body);
  }

  size_t tasks() const {
    const int per_task = kTask / grid.size;
    return static_cast<size_t>(grid.columns / per_task) * static_cast<size_t>(grid.rows / per_task);
  }

  /// The units of a task, tile by tile.
  template <class Body>
  void each_unit(size_t task, const Body& body) const {
    const int per_task = kTask / grid.size, columns = grid.columns / per_task;
    const int x0 = static_cast<int>(task) % columns * per_task, y0 = static_cast<int>(task) / columns * per_task;
    for (int y = y0; y < y0 + per_task; ++y) {
      const int unit = (y * grid.columns + x0) * grid.colours;
      for (int k = 0; k < per_task * grid.colours; ++k) body(static_cast<size_t>(unit + k));
    }
  }

  /// A unit's pixels within what is sampled.
  Box2i pixels_of(size_t unit) const {
    const int tile = static_cast<int>(unit) / grid.colours;
    const Vec2i min = (grid.first + Vec2i(tile % grid.columns, tile / grid.columns)) * grid.size;
    const Vec2i max = min + Vec2i(grid.size, grid.size);
    return {{std::max(min.x, sampled.min.x), std::max(min.y, sampled.min.y)},
            {std::min(max.x, sampled.max.x), std::min(max.y, sampled.max.y)}};
  }
  int colour_of(size_t unit) const { return grid.colours == 1 ? -1 : static_cast<int>(unit) & 1; }

  // ---- Passes ----

  /// So many samples for each unit.
  std::vector<uint32_t> everywhere(uint32_t samples) const { return std::vector<uint32_t>(grid.units(), samples); }

  /// What is to be added to each unit. Units that have as many samples already get none.
  void begin_pass(std::span<const uint32_t> want, std::string pass_note = {}) {
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

  void render_task(size_t task) {
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

  /// The samples that some of a task's units want: from the first on that one lacks, up to the last.
  std::pair<uint32_t, uint32_t> begin_task(size_t task) {
    const std::lock_guard lock(task_locks[task]);
    uint32_t from = UINT32_MAX, to = 0;
    each_unit(task, [&](size_t u) {
      if (have[u] == pass[u].until) return;
      if (pass[u].doubled && !std::exchange(pass[u].begun, uint8_t{1})) sums[u].halve_blocks();
      from = std::min(from, have[u]), to = std::max(to, pass[u].until);
    });
    return {from, to};
  }

  /// Adds the samples [from, to) of all of the task's units that want them.
  void add_round(Worker& worker, size_t task, uint32_t from, uint32_t to) {
    Chunk& chunk = chunks.local();
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
            const auto more = static_cast<int>(std::min<uint32_t>(last - s, static_cast<uint32_t>(kChunk - chunk.n)));
            chunk.add(x, y, s, more);
            if (options.blocks) chunk.note_blocks(pass[u], more);
            s += static_cast<uint32_t>(more);
            if (chunk.n == kChunk) close_run(chunk, u), render_chunk(worker, chunk);
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

  static void close_run(Chunk& chunk, size_t unit) {
    const int begin = chunk.runs.empty() ? 0 : chunk.runs.back().second;
    if (chunk.n > begin) chunk.runs.emplace_back(unit, chunk.n);
  }

  void render_chunk(Worker& worker, Chunk& samples) {
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

  /// Limits the samples' luminance and weighs them as the camera says. Returns which of them are numbers.
  const uint8_t* weigh_samples(Worker& worker) const {
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

  // ---- A state of it ----

  /// What a film of the same state has in common with this.
  std::array<uint64_t, 6> layout() const {
    return {static_cast<uint64_t>(grid.columns), static_cast<uint64_t>(grid.rows),
            static_cast<uint64_t>(grid.size),    TileSums::numbers(filter, grid.size, options.blocks),
            options.blocks ? uint64_t{1} : 0,    aovs.columns.size()};
  }

  uint32_t taken(size_t u) const { return have[u] - base[u]; }
  /// Nothing was taken nor is to be.
  bool is_idle(size_t u) const { return taken(u) == 0 && pass[u] == UnitPass{}; }

  void save(ByteWriter& out) const {
    const std::lock_guard passing(pass_lock);
    out.value(layout());
    out.text(note);
    {
      const std::lock_guard counting(statistics_lock);
      out.value(statistics);
    }
    out.value(seconds);
    out.value(worker_seconds.load());
    for (size_t task = 0; task < tasks(); ++task) {
      const std::lock_guard lock(task_locks[task]);
      each_unit(task, [&](size_t u) {
        out.value(is_idle(u) ? uint8_t{0} : uint8_t{1});
        if (is_idle(u)) return;
        out.value(UnitState{base[u], have[u], pass[u]});
        if (taken(u) == 0) return;
        sums[u].save(out);
        if (aovs.any()) aov_tiles[u].save(out);
      });
    }
  }

  bool restore(ByteReader& in) {
    if (in.value<decltype(layout())>() != layout()) return false;
    note = in.text();
    add_figures(in);
    const std::vector<size_t> things = things_of_mattes();
    each_state(in, [&](size_t u, const UnitState& s) {
      // Of a share the pass is known already.
      if (s.base != base[u] || (!is_idle(u) && !s.pass.is_like(pass[u]))) in.fail();
      if (s.have < std::max(s.pass.have, s.base) || s.have > s.pass.until) in.fail();
      if (!in.ok()) return;
      have[u] = s.have, pass[u] = s.pass;
      if (taken(u) == 0) return;
      sums[u].merge(in);
      if (aovs.any()) aov_tiles[u].restore(in, things);
    });
    return in.ok() && in.rest().empty();
  }

  bool merge(ByteReader& in, Gaps gaps) {
    if (in.value<decltype(layout())>() != layout()) return false;
    in.text();
    add_figures(in);
    const std::vector<size_t> things = things_of_mattes();
    each_state(in, [&](size_t u, const UnitState& s) {
      if ((have[u] != s.base && gaps == Gaps::None) || s.have < s.base) in.fail();
      if (!in.ok() || s.have == s.base) return;
      have[u] += s.have - s.base;  // their number, which is what a mean needs
      sums[u].merge(in);
      if (aovs.any()) aov_tiles[u].merge(in, things);
    });
    return in.ok() && in.rest().empty();
  }

  /// What is known of a unit beside its sums.
  struct UnitState {
    uint32_t base, have;
    UnitPass pass;
  };

  /// Calls body(unit, what was saved of it) for those that were not idle.
  template <class Body>
  void each_state(ByteReader& in, const Body& body) {
    for (size_t task = 0; task < tasks() && in.ok(); ++task) {
      const std::lock_guard lock(task_locks[task]);
      each_unit(task, [&](size_t u) {
        if (in.value<uint8_t>() != 0) body(u, in.value<UnitState>());
      });
    }
  }

  /// Adds what rendering took.
  void add_figures(ByteReader& in) {
    {
      const std::lock_guard counting(statistics_lock);
      statistics.add(in.value<RenderStatistics>());
    }
    seconds += in.value<double>();
    worker_seconds = worker_seconds + in.value<double>();
  }

  // ---- Passes that others take shares of ----

  PassRest rest() const {
    PassRest rest;
    for (size_t task = 0; task < tasks(); ++task) {
      const double before = rest.samples;
      each_unit(task, [&](size_t u) { rest.samples += samples_left(u, have[u], pass[u]); });
      rest.tiles += rest.samples > before;
    }
    return rest;
  }

  double samples_left(size_t u, uint32_t had, const UnitPass& p) const {
    return static_cast<double>(p.until - had) * static_cast<double>(unit(u).area());
  }

  void save_pass(ByteWriter& out) const {
    std::vector<UnitRest> units;
    for (size_t u = 0; u < pass.size(); ++u) {
      if (have[u] != pass[u].until) units.push_back({static_cast<uint32_t>(u), have[u], pass[u]});
    }
    out.value(layout());
    out.list(std::span<const UnitRest>(units));
  }

  bool take_share(ByteReader& in, size_t share, size_t of) {
    if (in.value<decltype(layout())>() != layout()) return false;
    const std::vector<UnitRest> units = in.list<UnitRest>();
    if (!in.ok() || !in.rest().empty()) return false;
    std::vector<double> work(tasks());
    for (const UnitRest& r : units) {
      const UnitPass& p = r.pass;
      if (r.unit >= grid.units() || r.have < p.have || r.have >= p.until || p.until != p.want) return false;
      work[task_of(r.unit)] += samples_left(r.unit, r.have, p);
    }
    is_share = true;
    const std::vector<bool> mine = tasks_of_share(work, share, of);
    for (const UnitRest& r : units) {
      if (!mine[task_of(r.unit)]) continue;
      base[r.unit] = have[r.unit] = r.have;
      pass[r.unit] = r.pass;
      pass[r.unit].begun = 1;  // There are no blocks here that would have to make room.
    }
    return true;
  }

  size_t task_of(size_t unit) const {
    const auto per_task = static_cast<size_t>(kTask / grid.size), columns = static_cast<size_t>(grid.columns);
    const size_t tile = unit / static_cast<size_t>(grid.colours);
    return tile / columns / per_task * (columns / per_task) + tile % columns / per_task;
  }

  /// Which tasks are a share, by the samples that each lacks.
  static std::vector<bool> tasks_of_share(const std::vector<double>& work, size_t share, size_t of) {
    std::vector<size_t> order;
    for (size_t task = 0; task < work.size(); ++task) {
      if (work[task] > 0) order.push_back(task);
    }
    std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return work[a] > work[b]; });
    std::vector<bool> mine(work.size());
    for (size_t n = 0; n < order.size(); ++n) mine[order[n]] = turn(n, of) == share;
    return mine;
  }

  bool add_share(ByteReader& in) {
    // All of it or nothing is in a state that is saved meanwhile.
    const std::lock_guard passing(pass_lock);
    if (in.value<decltype(layout())>() != layout()) return false;
    in.text();
    add_figures(in);
    const std::vector<size_t> things = things_of_mattes();
    each_state(in, [&](size_t u, const UnitState& s) {
      if (s.base != have[u] || s.have != pass[u].until || s.have == s.base || !s.pass.is_like(pass[u])) in.fail();
      if (!in.ok()) return;
      if (pass[u].doubled && !std::exchange(pass[u].begun, uint8_t{1})) sums[u].halve_blocks();
      have[u] = s.have;
      sums[u].merge(in);
      if (aovs.any()) aov_tiles[u].merge(in, things);
    });
    return in.ok() && in.rest().empty();
  }

  /// How many numbers there are in each of the columns that cryptomattes are made of.
  std::vector<size_t> things_of_mattes() const {
    std::vector<size_t> counts;
    for (const AovLayer& layer : aovs.layers) {
      if (layer.row->matte) counts.push_back(layer.row->names(scene, options.aovs.place).size());
    }
    return counts;
  }

  // ---- What is seen of it ----

  void preview(size_t task) const {
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

  void report_progress() {
    if (!options.progress) return;
    std::unique_lock lock(progress_mutex, std::try_to_lock);
    if (lock && !options.progress(static_cast<double>(tasks_done) / static_cast<double>(tasks()))) stopped = true;
  }

  /// One over the units' numbers of samples; nothing where all have the same.
  std::vector<double> weights() const {
    if (std::all_of(have.begin(), have.end(), [&](uint32_t n) { return n == have.front(); })) return {};
    std::vector<double> w(have.size());
    for (size_t u = 0; u < w.size(); ++u) w[u] = taken(u) > 0 ? 1.0 / taken(u) : 0.0;
    return w;
  }

  Unit unit(size_t u) const { return {pixels_of(u), colour_of(u), taken(u)}; }

  double samples_per_pixel() const {
    double samples = 0, pixels = 0;
    for (size_t u = 0; u < have.size(); ++u) {
      const auto area = static_cast<double>(unit(u).area());
      samples += area * taken(u), pixels += area;
    }
    return pixels > 0 ? samples / pixels : 0.0;
  }

  /// Of the samples that are wanted.
  double share() const {
    double samples = 0, all = 0;
    for (size_t u = 0; u < have.size(); ++u) {
      const auto area = static_cast<double>(unit(u).area());
      samples += area * taken(u), all += area * (std::max(have[u], pass[u].until) - base[u]);
    }
    return all > 0 ? samples / all : 1.0;
  }

  float film_scale() const { return static_cast<float>(scene.film().scale()); }

  const Scene& scene;
  RenderOptions options;
  FilterTable filter;
  const uint32_t round = filter.is_own_pixel() ? kLongRound : kRound;
  const AovPlan aovs;
  tbb::enumerable_thread_specific<Worker> workers;
  tbb::enumerable_thread_specific<Chunk> chunks;
  Picture window;  ///< Without colours.
  Box2i sampled;
  TileGrid grid;
  ZeroPages<double> memory;        ///< Of the sums.
  ZeroPages<float> rests;          ///< Likewise.
  std::vector<TileSums> sums;      ///< By unit.
  std::vector<AovTile> aov_tiles;  ///< As many, or none.
  std::vector<uint32_t> base;      ///< Of each unit's samples the first that is to be taken,
  std::vector<uint32_t>
      have;  ///< and where it has come to: so many per pixel there are, where that is the first of all.
  std::vector<UnitPass> pass;
  std::string note;
  bool restored = false, is_share = false;
  mutable std::mutex pass_lock;  ///< Of what a pass begins with; taken before a task's.
  /// Of all that a task's units have; between rounds nobody needs it, and it is as a state may be saved.
  mutable std::vector<std::mutex> task_locks;
  RenderStatistics statistics;  ///< Of all rounds that are done.
  mutable std::mutex statistics_lock;
  std::atomic<size_t> tasks_done{0};
  std::atomic<bool> stopped{false};
  std::mutex progress_mutex;
  std::atomic<double> worker_seconds{0};
  double seconds = 0;
};

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
  for (const UnitPass& p : impl_->pass) most = std::max(most, p.want);
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

void FilmRender::save(ByteWriter& out) const { impl_->save(out); }
bool FilmRender::restore(ByteReader& in) { return impl_->restored = impl_->restore(in); }
FilmRender::PassRest FilmRender::rest() const { return impl_->rest(); }
void FilmRender::save_pass(ByteWriter& out) const { impl_->save_pass(out); }
bool FilmRender::take_share(ByteReader& in, size_t share, size_t of) { return impl_->take_share(in, share, of); }
bool FilmRender::add_share(ByteReader& in) { return impl_->add_share(in); }
bool FilmRender::merge(ByteReader& in, Gaps gaps) { return impl_->merge(in, gaps); }

std::vector<FilmRender::Unit> FilmRender::units() const {
  std::vector<Unit> units;
  for (size_t u = 0; u < impl_->have.size(); ++u) units.push_back(impl_->unit(u));
  return units;
}

}  // namespace whit
