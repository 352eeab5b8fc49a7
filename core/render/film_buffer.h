// The film while rendering: tiles that add up samples in a fixed order, merged so that the picture has the
// same bits for any number of threads, any order of tiles and any crop.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/bytes.h"
#include "core/base/vec.h"
#include "core/batch/lanes.h"
#include "core/plugin/filter.h"

namespace whit {

/// A pixel filter as a table over one quadrant, and the reach of it in whole pixels.
class FilterTable {
 public:
  explicit FilterTable(const Filter& filter);
  float x_radius() const { return x_radius_; }
  float y_radius() const { return y_radius_; }
  /// Pixels beyond a sample's own pixel that it may reach, in x and y.
  int x_reach() const { return x_reach_; }
  int y_reach() const { return y_reach_; }
  /// True for a box filter whose samples reach their own pixel only, all with the same weight.
  bool is_own_pixel() const { return is_own_pixel_; }
  /// Weight at an offset from a pixel's centre within the radii.
  float weight(float x, float y) const { return row(y)[column(x)]; }
  /// The same in two steps: the weights at an offset in y, and the place among them of an offset in x.
  const float* row(float y) const {
    return &table_[static_cast<size_t>(std::min(static_cast<int>(std::abs(y) * y_to_table_), kSize - 1) * kSize)];
  }
  int column(float x) const { return std::min(static_cast<int>(std::abs(x) * x_to_table_), kSize - 1); }

 private:
  static constexpr int kSize = 64;
  float x_radius_, y_radius_, x_to_table_, y_to_table_;
  int x_reach_, y_reach_;
  std::vector<float> table_;
  bool is_own_pixel_ = false;
};

/// The pixels that samples of one tile reach: the tile and a border around it as wide as the filter reaches. Tiles lie on
/// a grid that is fixed to the full picture, so that a crop adds the same samples in the same order.
class TileReach {
 public:
  static constexpr int kTile = 16;  ///< Pixels on each side of a tile, but where something else is said.

  TileReach(Vec2i tile, const FilterTable& filter, int size = kTile);
  size_t pixels() const { return static_cast<size_t>(width_) * static_cast<size_t>(height_); }
  bool holds(int x, int y) const { return (x >= x0_) & (y >= y0_) & (x < x0_ + width_) & (y < y0_ + height_); }
  /// The number of a pixel that it holds.
  int number(int x, int y) const { return (y - y0_) * width_ + x - x0_; }
  /// Calls body(number of the pixel, weight) for the pixels that a sample reaches, row by row.
  template <class Body>
  void each_reached(float film_x, float film_y, const Body& body);

  const FilterTable& filter() const { return *filter_; }

 private:
  const FilterTable* filter_;
  int x0_, y0_, width_, height_;
  std::vector<int> columns_;  ///< Of the filter, for the pixels that the sample being added reaches.
};

/// Columns or rows of tiles, the last one included.
struct TileSpan {
  int first, last;
};

/// The tiles of a picture, row by row, each of one unit or of two: those of its pixels whose x + y is even, and the odd.
struct TileGrid {
  Vec2i first{0, 0};  ///< The first one's place on the fixed grid.
  int columns = 0, rows = 0;
  int size = TileReach::kTile;  ///< Pixels on each side of a tile.
  int colours = 1;              ///< Units of a tile.

  size_t units() const { return static_cast<size_t>(columns) * static_cast<size_t>(rows * colours); }
  /// The column or row of tiles that a pixel's coordinate, perhaps negative, is in.
  int tile_of(int p) const { return p >= 0 ? p / size : -((-p + size - 1) / size); }
  /// The unit that a pixel's own samples are in; -1 outside.
  int own_unit(Vec2i pixel) const;
  /// Whose samples may reach pixels of that x, or of that y.
  TileSpan columns_around(int x, const FilterTable& filter) const {
    return {std::max(tile_of(x - filter.x_reach()) - first.x, 0),
            std::min(tile_of(x + filter.x_reach()) - first.x, columns - 1)};
  }
  TileSpan rows_around(int y, const FilterTable& filter) const {
    return {std::max(tile_of(y - filter.y_reach()) - first.y, 0),
            std::min(tile_of(y + filter.y_reach()) - first.y, rows - 1)};
  }
  /// Calls body(number of the unit) for those of some tiles: row by row, left to right.
  template <class Body>
  void each_in(TileSpan x, TileSpan y, const Body& body) const {
    for (int row = y.first; row <= y.last; ++row) {
      for (int unit = (row * columns + x.first) * colours; unit < (row * columns + x.last + 1) * colours; ++unit)
        body(static_cast<size_t>(unit));
    }
  }
  /// Calls body(number of the unit) for the units whose samples may reach a pixel: row by row, left to right, so that the
  /// order of additions depends on the pixel alone.
  template <class Body>
  void each_around(Vec2i pixel, const FilterTable& filter, const Body& body) const {
    each_in(columns_around(pixel.x, filter), rows_around(pixel.y, filter), body);
  }
};

/// Adds to a sum of which `rest` holds what its rounding lost (Knuth, The Art of Computer Programming 2, 4.2.2, theorem
/// B). Sum and rest together have some 77 bits: the float that is made of them does not tell in which order numbers were
/// added, nor in how many parts (docs/decisions.md).
inline void add_exactly(double& sum, float& rest, double value) {
  const double all = sum + value, of_value = all - sum;
  rest += static_cast<float>((sum - (all - of_value)) + (value - of_value));
  sum = all;
}
/// Adds another sum of that kind.
inline void add_exactly(double& sum, float& rest, double other, float others_rest) {
  add_exactly(sum, rest, other);
  rest += others_rest;
}

/// Where a tile's sums are: TileSums::numbers() doubles and as many floats, all 0.
struct TileMemory {
  double* sums = nullptr;
  float* rests = nullptr;
};

/// Sums of the samples of one unit: all together; or, where the error is to be told, in four blocks.
class TileSums {
 public:
  static constexpr int kTile = TileReach::kTile;
  static constexpr int kBlocks = 4;
  using Sums = std::array<double, 4>;  ///< Of r, g, b and weights.

  /// In memory of its own where none is given.
  TileSums(Vec2i tile, const FilterTable& filter, int size = kTile, bool blocks = false, TileMemory zeros = {});
  TileSums(TileSums&&) = default;
  /// How many numbers a tile sums up.
  static size_t numbers(const FilterTable& filter, int size, bool blocks) {
    return 4 * (blocks ? kBlocks : 1) * TileReach({0, 0}, filter, size).pixels();
  }
  /// Adds one sample: film position (continuous raster coordinates) and weighted radiance.
  void add(float film_x, float film_y, const RGB& radiance, int block = 0);
  /// Adds n samples in their order, those that are `usable`. `block` says which each belongs to; null without blocks.
  void add(int n, const float* film_x, const float* film_y, const RGBLanes& radiance, const uint8_t* usable,
           const uint8_t* block = nullptr);
  /// Makes room for as many samples again: four blocks become the first two.
  void halve_blocks();

  /// Sums at a pixel. Nothing outside the tile's reach.
  std::optional<Sums> at(int x, int y) const {
    if (!reach_.holds(x, y)) return {};
    Sums all = block_at(x, y, 0);
    for (int b = 1; b < blocks_; ++b) {
      const Sums more = block_at(x, y, b);
      for (size_t c = 0; c < 4; ++c) all[c] += more[c];
    }
    return all;
  }
  bool reaches(int x, int y) const { return reach_.holds(x, y); }
  /// Those of one block, at a pixel within reach.
  Sums block_at(int x, int y, int block) const {
    const size_t first = 4 * static_cast<size_t>(reach_.number(x, y) * blocks_ + block);
    Sums out;
    for (size_t c = 0; c < 4; ++c) out[c] = sums_[first + c] + static_cast<double>(rests_[first + c]);
    return out;
  }

  /// All of it to bytes. A pixel's block without samples takes one: of the pixels of a chessboard every other one is such,
  /// and half of the blocks of those that a pass has doubled.
  void save(ByteWriter& out) const;
  /// Adds what another tile of the same size saved, of other samples. Where there were none, all is as it was saved.
  void merge(ByteReader& in);

 private:
  static constexpr int kBatch = 256;     ///< So many samples are looked at together.
  static constexpr size_t kNumbers = 4;  ///< Of a pixel's block.
  bool is_empty(size_t block) const;
  void add_to_own_pixels(int n, const float* film_x, const float* film_y, const RGBLanes& radiance,
                         const uint8_t* usable, const uint8_t* block);
  size_t numbers() const { return 4 * reach_.pixels() * static_cast<size_t>(blocks_); }

  TileReach reach_;
  int blocks_;
  std::vector<double> own_sums_;
  std::vector<float> own_rests_;
  double* sums_;  ///< Of a pixel's blocks, pixel by pixel.
  float* rests_;  ///< add_exactly()
};

/// The finished picture: linear RGB of the cropped window, row by row.
struct Picture {
  Vec2i resolution{0, 0};  ///< Of the full picture.
  Box2i window;            ///< Rendered part: min inclusive, max exclusive.
  std::vector<float> rgb;  ///< 3 per pixel of the window.
  int width() const { return window.max.x - window.min.x; }
  int height() const { return window.max.y - window.min.y; }
};

/// The units of a film, and how much the samples of each count: one over their number, so that a unit with many pulls
/// no pixel's filter to its side.
struct FilmUnits {
  const TileGrid& grid;
  const FilterTable& filter;
  std::span<const TileSums> sums;
  std::span<const double> weights;  ///< By unit; empty where all have the same number.
  int colour = -1;                  ///< 0 or 1: the units of this colour alone.

  double weight(size_t unit) const { return weights.empty() ? 1.0 : weights[unit]; }
  template <class Body>
  void each_in(TileSpan x, TileSpan y, const Body& body) const {
    grid.each_in(x, y, [&](size_t unit) {
      if (colour < 0 || static_cast<int>(unit & 1) == colour) body(unit);
    });
  }
  template <class Body>
  void each_around(Vec2i pixel, const Body& body) const {
    each_in(grid.columns_around(pixel.x, filter), grid.rows_around(pixel.y, filter), body);
  }
};

/// Divides sums by weights; negative results become 0; scaled by the film's scale.
void resolve_film(const FilmUnits& film, float scale, Picture& picture);

/// The variance of a pixel's channels, before scaling: that of the mean of blocks of samples which are independent of each
/// other, sum (w_b / w) (x_b - x)^2 / (blocks - 1). Infinite with fewer than two blocks.
Vec3d block_variance(const FilmUnits& film, Vec2i pixel);

template <class Body>
void TileReach::each_reached(float film_x, float film_y, const Body& body) {
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
  for (int y = py0; y <= py1; ++y) {
    const float* weights = filter_->row(static_cast<float>(y) - dy);
    const int row = number(px0, y);
    for (int k = 0; k <= px1 - px0; ++k) body(row + k, weights[columns_[static_cast<size_t>(k)]]);
  }
}

}  // namespace whit
