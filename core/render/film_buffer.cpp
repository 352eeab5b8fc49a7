#include "core/render/film_buffer.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace whit {
namespace {

/// A film's scale may take pixels beyond what a float holds; infinity is no radiance.
constexpr float kBrightest = std::numeric_limits<float>::max();

}  // namespace

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

TileReach::TileReach(Vec2i tile, const FilterTable& filter, int size)
    : filter_(&filter),
      x0_(tile.x * size - filter.x_reach()),
      y0_(tile.y * size - filter.y_reach()),
      width_(size + 2 * filter.x_reach()),
      height_(size + 2 * filter.y_reach()),
      columns_(static_cast<size_t>(width_)) {}

int TileGrid::own_unit(Vec2i pixel) const {
  const Vec2i at(tile_of(pixel.x) - first.x, tile_of(pixel.y) - first.y);
  if (at.x < 0 || at.y < 0 || at.x >= columns || at.y >= rows) return -1;
  return (at.y * columns + at.x) * colours + (colours == 1 ? 0 : (pixel.x + pixel.y) & 1);
}

TileSums::TileSums(Vec2i tile, const FilterTable& filter, int size, bool blocks, TileMemory zeros)
    : reach_(tile, filter, size),
      blocks_(blocks ? kBlocks : 1),
      own_sums_(zeros.sums ? 0 : numbers()),
      own_rests_(zeros.rests ? 0 : numbers()),
      sums_(zeros.sums ? zeros.sums : own_sums_.data()),
      rests_(zeros.rests ? zeros.rests : own_rests_.data()) {}

void TileSums::add(float film_x, float film_y, const RGB& radiance, int block) {
  const double value[4] = {radiance.x, radiance.y, radiance.z, 1};
  reach_.each_reached(film_x, film_y, [&](int pixel, double weight) {
    const size_t first = 4 * static_cast<size_t>(pixel * blocks_ + block);
    double* const sums = &sums_[first];
    float* const rests = &rests_[first];
    for (int c = 0; c < 4; ++c) add_exactly(sums[c], rests[c], weight * value[c]);
  });
}

void TileSums::add(int n, const float* film_x, const float* film_y, const RGBLanes& radiance, const uint8_t* usable,
                   const uint8_t* block) {
  for (int first = 0; first < n; first += kBatch) {
    const int count = std::min(kBatch, n - first);
    const float *x = film_x + first, *y = film_y + first;
    const uint8_t* const b = block ? block + first : nullptr;
    if (reach_.filter().is_own_pixel()) {
      add_to_own_pixels(count, x, y, radiance.from(first), usable + first, b);
      continue;
    }
    for (int i = 0; i < count; ++i) {
      if (usable[first + i]) add(x[i], y[i], radiance[first + i], b ? b[i] : 0);
    }
  }
}

/// add() for the most common filter, a box of one pixel. Samples of a pixel follow each other: they are added up in
/// registers, because sums in memory would wait for each other.
void TileSums::add_to_own_pixels(int n, const float* film_x, const float* film_y, const RGBLanes& radiance,
                                 const uint8_t* usable, const uint8_t* block) {
  int cell[kBatch + 1];  // the pixel and the block in one number, so that a run is one of both
  const TileReach& reach = reach_;
  const int blocks = blocks_;
  for_lanes(n, [&](int i) {
    const int x = static_cast<int>(std::floor(film_x[i])), y = static_cast<int>(std::floor(film_y[i]));
    const bool inside = reach.holds(x, y) & (usable[i] != 0);
    cell[i] = inside ? reach.number(x, y) * blocks : -1;
  });
  for (int i = 0; block && i < n; ++i) {
    if (cell[i] >= 0) cell[i] += block[i];
  }
  cell[n] = -2;
  const double w = reach_.filter().weight(0, 0);
  for (int i = 0; i < n;) {
    const int at = cell[i];
    if (at < 0) {
      ++i;
      continue;
    }
    double* const sums = &sums_[4 * static_cast<size_t>(at)];
    float* const rests = &rests_[4 * static_cast<size_t>(at)];
    double sum[4] = {sums[0], sums[1], sums[2], sums[3]};
    float rest[4] = {rests[0], rests[1], rests[2], rests[3]};
    for (; cell[i] == at; ++i) {
      const double value[4] = {w * radiance.r[i], w * radiance.g[i], w * radiance.b[i], w};
      for (int c = 0; c < 4; ++c) add_exactly(sum[c], rest[c], value[c]);
    }
    std::copy_n(sum, 4, sums);
    std::copy_n(rest, 4, rests);
  }
}

void TileSums::halve_blocks() {
  const auto join = [this](size_t to, size_t from) { add_exactly(sums_[to], rests_[to], sums_[from], rests_[from]); };
  for (size_t p = 0; p < numbers(); p += kBlocks * kNumbers) {
    for (size_t c = p; c < p + kNumbers; ++c) {
      join(c, c + kNumbers), join(c + 2 * kNumbers, c + 3 * kNumbers);
      sums_[c + kNumbers] = sums_[c + 2 * kNumbers], rests_[c + kNumbers] = rests_[c + 2 * kNumbers];
      for (const size_t free : {c + 2 * kNumbers, c + 3 * kNumbers}) sums_[free] = 0, rests_[free] = 0;
    }
  }
}

bool TileSums::is_empty(size_t block) const {
  const auto is_zero = [](auto number) { return number == 0; };
  return std::all_of(&sums_[kNumbers * block], &sums_[kNumbers * (block + 1)], is_zero) &&
         std::all_of(&rests_[kNumbers * block], &rests_[kNumbers * (block + 1)], is_zero);
}

void TileSums::save(ByteWriter& out) const {
  std::vector<uint8_t> there(numbers() / kNumbers);
  std::vector<double> sums;
  std::vector<float> rests;
  for (size_t b = 0; b < there.size(); ++b) {
    if (is_empty(b)) continue;
    there[b] = 1;
    sums.insert(sums.end(), &sums_[kNumbers * b], &sums_[kNumbers * (b + 1)]);
    rests.insert(rests.end(), &rests_[kNumbers * b], &rests_[kNumbers * (b + 1)]);
  }
  out.numbers(std::span<const uint8_t>(there));
  out.numbers(std::span<const double>(sums));
  out.numbers(std::span<const float>(rests));
}

void TileSums::merge(ByteReader& in) {
  std::vector<uint8_t> there(numbers() / kNumbers);
  in.numbers(std::span(there));
  const auto blocks = there.size() - static_cast<size_t>(std::count(there.begin(), there.end(), 0));
  std::vector<double> sums(kNumbers * blocks);
  std::vector<float> rests(sums.size());
  in.numbers(std::span(sums));
  in.numbers(std::span(rests));
  size_t from = 0;
  for (size_t b = 0; b < there.size(); ++b) {
    if (there[b] == 0) continue;
    for (size_t i = kNumbers * b; i < kNumbers * (b + 1); ++i, ++from)
      add_exactly(sums_[i], rests_[i], sums[from], rests[from]);
  }
}

void resolve_film(const FilmUnits& film, float scale, Picture& picture) {
  const auto width = static_cast<size_t>(picture.width());
  picture.rgb.resize(3 * width * static_cast<size_t>(picture.height()));
  std::vector<TileSpan> columns;
  for (int x = picture.window.min.x; x < picture.window.max.x; ++x)
    columns.push_back(film.grid.columns_around(x, film.filter));
  tbb::parallel_for(0, picture.height(), [&](int row) {
    const int y = picture.window.min.y + row;
    const TileSpan rows = film.grid.rows_around(y, film.filter);
    float* out = picture.rgb.data() + 3 * width * static_cast<size_t>(row);
    for (size_t i = 0; i < width; ++i, out += 3) {
      const int x = picture.window.min.x + static_cast<int>(i);
      double sum[4] = {0, 0, 0, 0};
      film.each_in(columns[i], rows, [&](size_t unit) {
        const auto s = film.sums[unit].at(x, y);
        if (!s) return;
        const double weight = film.weight(unit);
        for (size_t c = 0; c < 4; ++c) sum[c] += weight * (*s)[c];
      });
      for (int c = 0; c < 3; ++c) {
        const float value = sum[3] != 0 ? static_cast<float>(std::max(0.0, sum[c] / sum[3])) * scale : 0.0f;
        out[c] = std::clamp(value, -kBrightest, kBrightest);
      }
    }
  });
}

Vec3d block_variance(const FilmUnits& film, Vec2i pixel) {
  constexpr int kBlocks = TileSums::kBlocks;
  double sum[kBlocks][4] = {};
  film.each_around(pixel, [&](size_t unit) {
    const TileSums& sums = film.sums[unit];
    if (!sums.reaches(pixel.x, pixel.y)) return;
    const double weight = film.weight(unit);
    for (int b = 0; b < kBlocks; ++b) {
      const TileSums::Sums s = sums.block_at(pixel.x, pixel.y, b);
      for (size_t c = 0; c < 4; ++c) sum[b][c] += weight * s[c];
    }
  });
  double all[4] = {0, 0, 0, 0};
  int blocks = 0;
  for (const auto& s : sum) {
    for (int c = 0; c < 4; ++c) all[c] += s[c];
    blocks += s[3] != 0;
  }
  if (blocks < 2) return Vec3d(std::numeric_limits<double>::infinity());
  Vec3d variance(0.0);
  for (const auto& s : sum) {
    for (int c = 0; s[3] != 0 && c < 3; ++c) {
      const double off = s[c] / s[3] - all[c] / all[3];
      variance[c] += s[3] / all[3] * off * off / (blocks - 1);
    }
  }
  return variance;
}

}  // namespace whit
