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

TileSums::TileSums(Vec2i tile, const FilterTable& filter)
    : filter_(&filter),
      x0_(tile.x * kTile - filter.x_reach()),
      y0_(tile.y * kTile - filter.y_reach()),
      width_(kTile + 2 * filter.x_reach()),
      height_(kTile + 2 * filter.y_reach()),
      sums_(4 * static_cast<size_t>(width_) * static_cast<size_t>(height_)),
      columns_(static_cast<size_t>(width_)) {}

void TileSums::add(float film_x, float film_y, const RGB& radiance) {
  // Pixel p is reached when p + 0.5 is within the radius of the sample, the rim included, so that a sample in the middle
  // of its pixel reaches as far to both sides; but never beyond the reach, so that a box of radius 0.5 gives every
  // sample to exactly one pixel.
  const float dx = film_x - 0.5f, dy = film_y - 0.5f;
  const auto first = [](float middle, float radius, int reach) {
    return std::max(static_cast<int>(std::ceil(middle - radius)), static_cast<int>(std::floor(middle + 0.5f)) - reach);
  };
  const int px0 = std::max(first(dx, filter_->x_radius(), filter_->x_reach()), x0_);
  const int px1 = std::min(static_cast<int>(std::floor(dx + filter_->x_radius())), x0_ + width_ - 1);
  const int py0 = std::max(first(dy, filter_->y_radius(), filter_->y_reach()), y0_);
  const int py1 = std::min(static_cast<int>(std::floor(dy + filter_->y_radius())), y0_ + height_ - 1);
  if (px0 > px1) return;
  for (int x = px0; x <= px1; ++x) columns_[static_cast<size_t>(x - px0)] = filter_->column(static_cast<float>(x) - dx);
  const double value[4] = {radiance.x, radiance.y, radiance.z, 1};
  for (int y = py0; y <= py1; ++y) {
    const float* weights = filter_->row(static_cast<float>(y) - dy);
    double* sums =
        &sums_[4 * (static_cast<size_t>(y - y0_) * static_cast<size_t>(width_) + static_cast<size_t>(px0 - x0_))];
    for (int x = px0; x <= px1; ++x, sums += 4) {
      const double w = weights[columns_[static_cast<size_t>(x - px0)]];
      for (int c = 0; c < 4; ++c) sums[c] += w * value[c];
    }
  }
}

void TileSums::add(int n, const float* film_x, const float* film_y, const RGBLanes& radiance, const uint8_t* usable) {
  for (int first = 0; first < n; first += kBlock) {
    const int count = std::min(kBlock, n - first);
    const float *x = film_x + first, *y = film_y + first;
    if (filter_->is_own_pixel()) {
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
  for_lanes(n, [&](int i) {
    const int x = static_cast<int>(std::floor(film_x[i])) - x0_, y = static_cast<int>(std::floor(film_y[i])) - y0_;
    const bool inside = (x >= 0) & (y >= 0) & (x < width_) & (y < height_) & (usable[i] != 0);
    cell[i] = inside ? y * width_ + x : -1;
  });
  cell[n] = -2;
  const double w = filter_->weight(0, 0);
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

namespace {

/// The tiles that reach a row or column of pixels: [first, last] in tile numbers.
std::pair<int, int> tiles_around(int pixel, int reach) {
  const auto tile_of = [](int p) { return static_cast<int>(std::floor(static_cast<float>(p) / TileSums::kTile)); };
  return {tile_of(pixel - reach), tile_of(pixel + reach)};
}

}  // namespace

void resolve_film(const std::vector<TileSums>& tiles, Vec2i first_tile, int tiles_x, const FilterTable& filter,
                  float scale, Picture& picture) {
  const int tiles_y = static_cast<int>(tiles.size()) / std::max(tiles_x, 1);
  picture.rgb.assign(3 * static_cast<size_t>(picture.width()) * static_cast<size_t>(picture.height()), 0.0f);
  tbb::parallel_for(0, picture.height(), [&](int row) {
    const int y = picture.window.min.y + row;
    const auto [ty0, ty1] = tiles_around(y, filter.y_reach());
    for (int column = 0; column < picture.width(); ++column) {
      const int x = picture.window.min.x + column;
      const auto [tx0, tx1] = tiles_around(x, filter.x_reach());
      double sum[4] = {0, 0, 0, 0};
      // Row by row, left to right: the order of additions depends on the pixel alone.
      for (int ty = std::max(ty0, first_tile.y); ty <= std::min(ty1, first_tile.y + tiles_y - 1); ++ty) {
        for (int tx = std::max(tx0, first_tile.x); tx <= std::min(tx1, first_tile.x + tiles_x - 1); ++tx) {
          const double* s = tiles[static_cast<size_t>((ty - first_tile.y) * tiles_x + tx - first_tile.x)].at(x, y);
          for (int c = 0; s && c < 4; ++c) sum[c] += s[c];
        }
      }
      float* out = &picture.rgb[3 * (static_cast<size_t>(row) * static_cast<size_t>(picture.width()) +
                                     static_cast<size_t>(column))];
      for (int c = 0; c < 3; ++c)
        out[c] = sum[3] != 0 ? static_cast<float>(std::max(0.0, sum[c] / sum[3])) * scale : 0.0f;
    }
  });
}

}  // namespace whit
