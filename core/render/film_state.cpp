// What a film is to other films: a state to go on from, parts and shares to be added.
#include <algorithm>
#include <array>
#include <cmath>

#include "core/render/film_impl.h"

namespace whit {
namespace {

/// A unit of a pass, as whoever takes a share of it needs to know it.
struct UnitRest {
  uint32_t unit = 0, have = 0;
  FilmUnitPass pass;
};

/// Whose turn the n-th of some tiles is, of so many: one in each round, which begins elsewhere each time, so that no share
/// is a column of the film.
size_t turn(size_t n, size_t of) {
  const auto step = static_cast<size_t>(std::lround(0.618 * static_cast<double>(of)));  // the golden ratio
  return (n % of + n / of * step) % of;
}

}  // namespace

std::array<uint64_t, 6> FilmRender::Impl::layout() const {
  return {static_cast<uint64_t>(grid.columns), static_cast<uint64_t>(grid.rows),
          static_cast<uint64_t>(grid.size),    TileSums::numbers(filter, grid.size, options.blocks),
          options.blocks ? uint64_t{1} : 0,    aovs.columns.size()};
}

void FilmRender::Impl::save(ByteWriter& out) const {
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

bool FilmRender::Impl::restore(ByteReader& in) {
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

bool FilmRender::Impl::merge(ByteReader& in, Gaps gaps) {
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

template <class Body>
void FilmRender::Impl::each_state(ByteReader& in, const Body& body) {
  for (size_t task = 0; task < tasks() && in.ok(); ++task) {
    const std::lock_guard lock(task_locks[task]);
    each_unit(task, [&](size_t u) {
      if (in.value<uint8_t>() != 0) body(u, in.value<UnitState>());
    });
  }
}

void FilmRender::Impl::add_figures(ByteReader& in) {
  {
    const std::lock_guard counting(statistics_lock);
    statistics.add(in.value<RenderStatistics>());
  }
  seconds += in.value<double>();
  worker_seconds = worker_seconds + in.value<double>();
}

FilmRender::PassRest FilmRender::Impl::rest() const {
  PassRest rest;
  for (size_t task = 0; task < tasks(); ++task) {
    const double before = rest.samples;
    each_unit(task, [&](size_t u) { rest.samples += samples_left(u, have[u], pass[u]); });
    rest.tiles += rest.samples > before;
  }
  return rest;
}

double FilmRender::Impl::samples_left(size_t u, uint32_t had, const FilmUnitPass& p) const {
  return static_cast<double>(p.until - had) * static_cast<double>(unit(u).area());
}

void FilmRender::Impl::save_pass(ByteWriter& out) const {
  std::vector<UnitRest> units;
  for (size_t u = 0; u < pass.size(); ++u) {
    if (have[u] != pass[u].until) units.push_back({static_cast<uint32_t>(u), have[u], pass[u]});
  }
  out.value(layout());
  out.list(std::span<const UnitRest>(units));
}

bool FilmRender::Impl::take_share(ByteReader& in, size_t share, size_t of) {
  if (in.value<decltype(layout())>() != layout()) return false;
  const std::vector<UnitRest> units = in.list<UnitRest>();
  if (!in.ok() || !in.rest().empty()) return false;
  std::vector<double> work(tasks());
  for (const UnitRest& r : units) {
    const FilmUnitPass& p = r.pass;
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

size_t FilmRender::Impl::task_of(size_t unit) const {
  const auto per_task = static_cast<size_t>(kFilmTask / grid.size), columns = static_cast<size_t>(grid.columns);
  const size_t tile = unit / static_cast<size_t>(grid.colours);
  return tile / columns / per_task * (columns / per_task) + tile % columns / per_task;
}

std::vector<bool> FilmRender::Impl::tasks_of_share(const std::vector<double>& work, size_t share, size_t of) {
  std::vector<size_t> order;
  for (size_t task = 0; task < work.size(); ++task) {
    if (work[task] > 0) order.push_back(task);
  }
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return work[a] > work[b]; });
  std::vector<bool> mine(work.size());
  for (size_t n = 0; n < order.size(); ++n) mine[order[n]] = turn(n, of) == share;
  return mine;
}

bool FilmRender::Impl::add_share(ByteReader& in) {
  // All of it or nothing is in a state that is saved meanwhile.
  const std::lock_guard passing(pass_lock);
  if (in.value<decltype(layout())>() != layout()) return false;
  in.text();
  add_figures(in);
  const std::vector<size_t> things = things_of_mattes();
  each_state(in, [&](size_t u, const UnitState& s) {
    if (s.base != have[u] || s.have != pass[u].until || s.have == s.base || !s.pass.is_like(pass[u])) in.fail();
    if (!in.ok()) return;
    begin_blocks(u);
    have[u] = s.have;
    sums[u].merge(in);
    if (aovs.any()) aov_tiles[u].merge(in, things);
  });
  return in.ok() && in.rest().empty();
}

std::vector<size_t> FilmRender::Impl::things_of_mattes() const {
  std::vector<size_t> counts;
  for (const AovLayer& layer : aovs.layers) {
    if (layer.row->matte) counts.push_back(layer.row->names(scene, options.aovs.place).size());
  }
  return counts;
}

void FilmRender::save(ByteWriter& out) const { impl_->save(out); }
bool FilmRender::restore(ByteReader& in) { return impl_->restored = impl_->restore(in); }
FilmRender::PassRest FilmRender::rest() const { return impl_->rest(); }
void FilmRender::save_pass(ByteWriter& out) const { impl_->save_pass(out); }
bool FilmRender::take_share(ByteReader& in, size_t share, size_t of) { return impl_->take_share(in, share, of); }
bool FilmRender::add_share(ByteReader& in) { return impl_->add_share(in); }
bool FilmRender::merge(ByteReader& in, Gaps gaps) { return impl_->merge(in, gaps); }

}  // namespace whit
