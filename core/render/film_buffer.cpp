#include "core/render/film_buffer.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace whit {

FilterTable::FilterTable(const Filter& filter)
    : x_radius_(filter.x_width),
      y_radius_(filter.y_width),
      x_to_table_(static_cast<float>(kSize) / filter.x_width),
      y_to_table_(static_cast<float>(kSize) / filter.y_width),
      x_reach_(std::max(0, static_cast<int>(std::ceil(filter.x_width - 0.5f)))),
      y_reach_(std::max(0, static_cast<int>(std::ceil(filter.y_width - 0.5f)))),
      table_(kSize * kSize) {
  for (int j = 0; j < kSize; ++j) {
    for (int i = 0; i < kSize; ++i) {
      table_[static_cast<size_t>(j * kSize + i)] = filter.evaluate((static_cast<float>(i) + 0.5f) * x_radius_ / kSize,
                                                                   (static_cast<float>(j) + 0.5f) * y_radius_ / kSize);
    }
  }
  const auto is_first = [this](float w) { return w == table_.front(); };
  is_own_pixel_ = x_radius_ == 0.5f && y_radius_ == 0.5f && std::all_of(table_.begin(), table_.end(), is_first);
}

TileReach::TileReach(Vec2i tile, const FilterTable& filter)
    : filter_(&filter),
      x0_(tile.x * kTile - filter.x_reach()),
      y0_(tile.y * kTile - filter.y_reach()),
      width_(kTile + 2 * filter.x_reach()),
      height_(kTile + 2 * filter.y_reach()),
      columns_(static_cast<size_t>(width_)) {}

TileSums::TileSums(Vec2i tile, const FilterTable& filter) : reach_(tile, filter), sums_(4 * reach_.pixels()) {}

void TileSums::add(float film_x, float film_y, const RGB& radiance) {
  const double value[4] = {radiance.x, radiance.y, radiance.z, 1};
  reach_.each_reached(film_x, film_y, [&](int pixel, double weight) {
    double* const sums = &sums_[4 * static_cast<size_t>(pixel)];
    for (int c = 0; c < 4; ++c) sums[c] += weight * value[c];
  });
}

void TileSums::add(int n, const float* film_x, const float* film_y, const RGBLanes& radiance, const uint8_t* usable) {
  for (int first = 0; first < n; first += kBlock) {
    const int count = std::min(kBlock, n - first);
    const float *x = film_x + first, *y = film_y + first;
    if (reach_.filter().is_own_pixel()) {
      add_to_own_pixels(count, x, y, radiance.from(first), usable + first);
      continue;
    }
    for (int i = 0; i < count; ++i) {
      if (usable[first + i]) add(x[i], y[i], radiance[first + i]);
    }
  }
}

/// add() for the most common filter, a box of one pixel. Samples of a pixel follow each other: they are added up in
/// registers, because sums in memory would wait for each other.
void TileSums::add_to_own_pixels(int n, const float* film_x, const float* film_y, const RGBLanes& radiance,
                                 const uint8_t* usable) {
  int cell[kBlock + 1];
  const TileReach& reach = reach_;
  for_lanes(n, [&](int i) {
    const int x = static_cast<int>(std::floor(film_x[i])), y = static_cast<int>(std::floor(film_y[i]));
    const bool inside = reach.holds(x, y) & (usable[i] != 0);
    cell[i] = inside ? reach.number(x, y) : -1;
  });
  cell[n] = -2;
  const double w = reach_.filter().weight(0, 0);
  for (int i = 0; i < n;) {
    const int at = cell[i];
    if (at < 0) {
      ++i;
      continue;
    }
    double* const sums = &sums_[4 * static_cast<size_t>(at)];
    double r = sums[0], g = sums[1], b = sums[2], weight = sums[3];
    for (; cell[i] == at; ++i) {
      r += w * radiance.r[i], g += w * radiance.g[i], b += w * radiance.b[i];
      weight += w;
    }
    sums[0] = r, sums[1] = g, sums[2] = b, sums[3] = weight;
  }
}

void resolve_film(const std::vector<TileSums>& tiles, const TileGrid& grid, const FilterTable& filter, float scale,
                  Picture& picture) {
  picture.rgb.assign(3 * static_cast<size_t>(picture.width()) * static_cast<size_t>(picture.height()), 0.0f);
  tbb::parallel_for(0, picture.height(), [&](int row) {
    for (int column = 0; column < picture.width(); ++column) {
      const Vec2i pixel = picture.window.min + Vec2i(column, row);
      double sum[4] = {0, 0, 0, 0};
      grid.each_around(pixel, filter, [&](size_t tile) {
        const double* s = tiles[tile].at(pixel.x, pixel.y);
        for (int c = 0; s && c < 4; ++c) sum[c] += s[c];
      });
      float* out = &picture.rgb[3 * (static_cast<size_t>(row) * static_cast<size_t>(picture.width()) +
                                     static_cast<size_t>(column))];
      for (int c = 0; c < 3; ++c)
        out[c] = sum[3] != 0 ? static_cast<float>(std::max(0.0, sum[c] / sum[3])) * scale : 0.0f;
    }
  });
}

}  // namespace whit
