// A film inside, for film_render.cpp, which takes samples, and film_state.cpp, which brings them from one film to another.
#pragma once

#include <tbb/enumerable_thread_specific.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "core/batch/zero_pages.h"
#include "core/render/borrowed_arena.h"
#include "core/render/film_render.h"
#include "core/render/trace.h"

namespace whit {

/// Camera samples traced together.
constexpr int kFilmChunk = 2048;
/// Pixels on each side of what one thread renders at a time.
constexpr int kFilmTask = 16;
/// Samples of a pixel that are taken before the next pixel's turn. States are saved, and renders stopped, between rounds
/// only. Longer ones keep rays together (4 % of the time on scenes/mesh.pbrt), where a filter keeps to its pixel.
constexpr uint32_t kFilmRound = 64, kLongFilmRound = 1024;

/// What a pass adds to a unit: the samples [have, want), and in which blocks; of a part of a picture, only those up to
/// `until`, in the blocks of the whole.
struct FilmUnitPass {
  uint32_t have = 0, want = 0, until = 0;
  // Bytes from a file may be anything, which a bool must not.
  uint8_t doubled = 0;  ///< As many again: they are the last two blocks.
  uint8_t begun = 0;    ///< The blocks are ready for them.

  bool operator==(const FilmUnitPass&) const = default;
  /// The same samples in the same blocks.
  bool is_like(const FilmUnitPass& p) const {
    return have == p.have && want == p.want && until == p.until && doubled == p.doubled;
  }
  uint8_t block(uint32_t sample) const {
    const uint64_t at = sample - have, of = want - have;
    return static_cast<uint8_t>(doubled ? 2 + 2 * at / of : TileSums::kBlocks * at / of);
  }
};

/// Samples on their way into a chunk, and which unit and block each belongs to.
struct FilmChunk {
  int n = 0;
  int32_t px[kFilmChunk], py[kFilmChunk];
  uint32_t index[kFilmChunk];
  uint8_t block[kFilmChunk];
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
  void note_blocks(const FilmUnitPass& pass, int more) {
    for (int i = n - more; i < n; ++i) block[i] = pass.block(index[i]);
  }
};

struct FilmRender::Impl {
  Impl(const Scene& of, const RenderOptions& asked);
  void prepare();

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
    const int per_task = kFilmTask / grid.size;
    return static_cast<size_t>(grid.columns / per_task) * static_cast<size_t>(grid.rows / per_task);
  }

  /// The units of a task, tile by tile.
  template <class Body>
  void each_unit(size_t task, const Body& body) const {
    const int per_task = kFilmTask / grid.size, columns = grid.columns / per_task;
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
  void begin_pass(std::span<const uint32_t> want, std::string pass_note = {});
  void render_task(size_t task);
  /// Makes room for the blocks of what a pass adds, before the first of it.
  void begin_blocks(size_t unit);

  /// The samples that some of a task's units want: from the first on that one lacks, up to the last.
  std::pair<uint32_t, uint32_t> begin_task(size_t task);

  /// Adds the samples [from, to) of all of the task's units that want them.
  void add_round(Worker& worker, size_t task, uint32_t from, uint32_t to);
  static void close_run(FilmChunk& chunk, size_t unit);
  void render_chunk(Worker& worker, FilmChunk& samples);

  /// Limits the samples' luminance and weighs them as the camera says. Returns which of them are numbers.
  const uint8_t* weigh_samples(Worker& worker) const;

  // ---- A state of it ----

  /// What a film of the same state has in common with this.
  std::array<uint64_t, 6> layout() const;

  uint32_t taken(size_t u) const { return have[u] - base[u]; }
  /// Nothing was taken nor is to be.
  bool is_idle(size_t u) const { return taken(u) == 0 && pass[u] == FilmUnitPass{}; }

  void save(ByteWriter& out) const;
  bool restore(ByteReader& in);
  bool merge(ByteReader& in, Gaps gaps);

  /// What is known of a unit beside its sums.
  struct UnitState {
    uint32_t base, have;
    FilmUnitPass pass;
  };

  /// Calls body(unit, what was saved of it) for those that were not idle.
  template <class Body>
  void each_state(ByteReader& in, const Body& body);

  /// Adds what rendering took.
  void add_figures(ByteReader& in);

  // ---- Passes that others take shares of ----

  PassRest rest() const;
  double samples_left(size_t u, uint32_t had, const FilmUnitPass& p) const;
  void save_pass(ByteWriter& out) const;
  bool take_share(ByteReader& in, size_t share, size_t of);
  size_t task_of(size_t unit) const;
  /// Which tasks are a share, by the samples that each lacks.
  static std::vector<bool> tasks_of_share(const std::vector<double>& work, size_t share, size_t of);
  bool add_share(ByteReader& in);
  /// How many numbers there are in each of the columns that cryptomattes are made of.
  std::vector<size_t> things_of_mattes() const;

  // ---- What is seen of it ----

  void preview(size_t task) const;
  void report_progress();

  /// One over the units' numbers of samples; nothing where all have the same.
  std::vector<double> weights() const;

  Unit unit(size_t u) const { return {pixels_of(u), colour_of(u), taken(u)}; }
  double samples_per_pixel() const;
  /// Of the samples that are wanted.
  double share() const;

  float film_scale() const { return static_cast<float>(scene.film().scale()); }

  const Scene& scene;
  RenderOptions options;
  FilterTable filter;
  const uint32_t round = filter.is_own_pixel() ? kLongFilmRound : kFilmRound;
  const AovPlan aovs;
  tbb::enumerable_thread_specific<Worker> workers;
  tbb::enumerable_thread_specific<FilmChunk> chunks;
  Picture window;  ///< Without colours.
  Box2i sampled;
  TileGrid grid;
  ZeroPages<double> memory;        ///< Of the sums.
  ZeroPages<float> rests;          ///< Likewise.
  std::vector<TileSums> sums;      ///< By unit.
  std::vector<AovTile> aov_tiles;  ///< As many, or none.
  std::vector<uint32_t> base;      ///< Of each unit's samples the first that is to be taken.
  std::vector<uint32_t> have;      ///< And the first that is not taken yet.
  std::vector<FilmUnitPass> pass;
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

}  // namespace whit
