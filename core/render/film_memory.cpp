#include "core/render/film_memory.h"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/image/denoiser.h"

namespace whit {
namespace {

/// Bytes as they were measured (docs/memory.md).
struct Measured {
  static constexpr double kWorker = 1 << 19;  ///< Of a thread: its batches and its stack.
  static constexpr double kHeap = 16;         ///< Of a piece in the heap, beside what was asked for.
  static constexpr double kCovers = 32;       ///< Of a pixel of a unit: what covers it, with its place in the heap.
};

/// How the film is cut up, in numbers that no size can overflow.
struct FilmSize {
  double width, height;        ///< Of the picture's window.
  double units, reach_pixels;  ///< Units, and the pixels that each has sums of.
  double own_pixels;           ///< Of a unit's tile.
  double reach_width;
  double x_reach, y_reach;
};

FilmSize size_of(const BoundScene& bound, const FilmNeed& need) {
  Vec2i resolution = bound.film.plugin->resolution();
  if (need.quick) resolution = {std::max(1, resolution.x / 4), std::max(1, resolution.y / 4)};
  double crop[4];
  bound.film.plugin->crop_window(crop);
  const Box2i window = crop_pixels(resolution, need.crop_given ? need.crop : crop);
  const Filter& filter = *bound.filter.plugin;
  const auto reach = [](float radius) { return std::max(0.0, std::ceil(static_cast<double>(radius) - 0.5)); };
  FilmSize s{};
  s.x_reach = reach(filter.x_width), s.y_reach = reach(filter.y_width);
  s.width = std::max(0, window.max.x - window.min.x), s.height = std::max(0, window.max.y - window.min.y);
  const double tile = need.adaptive ? TileReach::kTile / 2 : TileReach::kTile;
  // Whole tasks of 16 x 16 pixels, wherever the window begins.
  const auto tasks = [](double low, double high) {
    return std::floor((high - 1) / TileReach::kTile) - std::floor(low / TileReach::kTile) + 1;
  };
  const double all_tasks = tasks(window.min.x - s.x_reach, window.max.x + s.x_reach) *
                           tasks(window.min.y - s.y_reach, window.max.y + s.y_reach);
  s.units = s.width > 0 && s.height > 0 ? all_tasks * (need.adaptive ? 8 : 1) : 0;
  s.reach_width = tile + 2 * s.x_reach;
  s.reach_pixels = s.reach_width * (tile + 2 * s.y_reach);
  s.own_pixels = tile * tile;
  return s;
}

/// Names of groups of lights that anything has.
double light_groups(const BoundScene& bound) {
  std::set<std::string> names;
  const auto add = [&](const Entity& light) {
    for (const Parameter& p : light.params)
      if (p.name == "lightgroup") names.insert(p.strings().begin(), p.strings().end());
  };
  for (const Entity& light : bound.description->lights) add(light);
  for (const Entity& light : bound.description->area_lights) add(light);
  return static_cast<double>(names.size());
}

/// What AOVs have for each pixel.
struct AovNumbers {
  double means = 0, nearest = 0, channels = 0, mattes = 0;
  bool any = false, statistics = false, blocks = false;
};

AovNumbers aov_numbers(const BoundScene& bound, const std::vector<std::string>& names) {
  AovNumbers n;
  for (const AovRow& row : all_aovs()) {
    if (std::find(names.begin(), names.end(), row.name) == names.end()) continue;
    const double channels = static_cast<double>(row.channels.size()) * (row.by_light_group ? light_groups(bound) : 1);
    n.any = true;
    n.channels += channels;
    if (row.pixel == AovPixel::Nearest) n.nearest += channels;
    else if (row.pixel != AovPixel::Statistic) n.means += channels;
    n.statistics |= row.pixel == AovPixel::Statistic;
    n.blocks |= row.blocks;
    // Each is three layers of four channels.
    if (row.matte) ++n.mattes, n.channels += 12;
  }
  return n;
}

/// Sums of a unit: the picture's, those of blocks, and AOVs'.
double unit_bytes(const FilmSize& s, const AovNumbers& aovs, bool blocks) {
  const double columns = sizeof(int) * s.reach_width + Measured::kHeap;
  constexpr double kSum = sizeof(double) + sizeof(float);
  double bytes = sizeof(TileSums) + columns + s.reach_pixels * (blocks ? TileSums::kBlocks : 1) * 4 * kSum;
  if (!aovs.any) return bytes;
  bytes += sizeof(AovTile) + columns + s.reach_pixels * (aovs.means + 2) * kSum + 5 * Measured::kHeap;
  bytes += aovs.mattes * s.reach_pixels * (sizeof(std::vector<Coverage>) + Measured::kCovers);
  bytes += s.own_pixels * (sizeof(float) * (1 + aovs.nearest) + (aovs.statistics ? sizeof(int64_t) : 0));
  return bytes;
}

/// The finished picture, and files on their way: copies for displays in floats, in bytes, and compressed; rows of the
/// linear file.
void plan_output_memory(const FilmSize& s, const AovNumbers& aovs, const FilmNeed& need, const MemoryPart& film,
                        MemoryPlan& memory) {
  constexpr double kPixel = 3 * sizeof(float);
  const double pixels = s.width * s.height;
  const double picture = pixels * sizeof(float) * (3 + aovs.channels);
  const double display = need.display ? pixels * (3 * sizeof(float) + 3 + 3 + 3) : 0;
  const double rows = need.linear ? 2 * 256 * s.width * sizeof(float) * (3 + aovs.channels) : 0;
  StepBytes output{};
  output[static_cast<size_t>(MemoryStep::Finishing)] = picture;
  output[static_cast<size_t>(MemoryStep::Writing)] = picture + display + std::min(rows, picture);
  output[static_cast<size_t>(MemoryStep::Denoising)] = need.denoise ? picture : 0;
  output[static_cast<size_t>(MemoryStep::Rendering)] = need.kept_pictures * kPixel * pixels;
  memory.add(MemoryUse::Output, output, {picture, film.where, film.what});
  if (!need.denoise) return;
  // What it is given and makes; then that is written, as the picture was before.
  const double making = 3 * kPixel * pixels + static_cast<double>(Denoiser::memory(s.width * s.height));
  const double writing = kPixel * pixels + display + (need.linear ? std::min(2 * 256 * s.width, pixels) * kPixel : 0);
  StepBytes denoiser{};
  denoiser[static_cast<size_t>(MemoryStep::Denoising)] = std::max(making, writing);
  memory.add(MemoryUse::Denoiser, denoiser, {making, film.where, film.what});
}

}  // namespace

void plan_film_memory(const BoundScene& bound, const FilmNeed& need, MemoryPlan& memory) {
  if (!bound.film.plugin || !bound.filter.plugin) return;
  const FilmSize s = size_of(bound, need);
  const AovNumbers aovs = aov_numbers(bound, need.aovs);
  const double film = s.units * unit_bytes(s, aovs, need.blocks || aovs.blocks);
  // Where a unit's sums are mostly its neighbours' pixels, the filter is what takes them.
  const bool is_wide = s.reach_pixels > 16 * s.own_pixels;
  const Filter& filter = *bound.filter.plugin;
  const MemoryPart part =
      is_wide ? MemoryPart{film, bound.filter.where,
                           fmt::format("a filter that reaches {:g} x {:g} pixels", filter.x_width, filter.y_width)}
              : MemoryPart{film, bound.film.where, fmt::format("a film of {:g} x {:g} pixels", s.width, s.height)};
  // How far the picture is from its limit is told pixel by pixel, with a few numbers of each.
  constexpr double kJudging = 36;
  if (need.blocks) memory.add_from(MemoryStep::Rendering, MemoryUse::Film, kJudging * s.width * s.height);
  StepBytes bytes{};
  bytes[static_cast<size_t>(MemoryStep::Rendering)] = need.films * film;
  bytes[static_cast<size_t>(MemoryStep::Finishing)] = need.films * film;
  memory.add(MemoryUse::Film, bytes, part);
  plan_output_memory(s, aovs, need, part, memory);
  const int threads = need.threads > 0 ? need.threads : tbb::this_task_arena::max_concurrency();
  memory.add_from(MemoryStep::Rendering, MemoryUse::Workers, threads * Measured::kWorker);
}

}  // namespace whit
