// The film while rendering: tiles that add up samples in a fixed order, merged so that the picture has the
// same bits for any number of threads, any order of tiles and any crop.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

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

/// Sums of one tile and a border around it as wide as the filter reaches. Tiles lie on a grid that is fixed
/// to the full picture, so that a crop adds the same samples in the same order.
class TileSums {
 public:
  static constexpr int kTile = 16;

  TileSums(Vec2i tile, const FilterTable& filter);
  /// Adds one sample: film position (continuous raster coordinates) and weighted radiance.
  void add(float film_x, float film_y, const RGB& radiance);
  /// Adds n samples in their order, those that are `usable`.
  void add(int n, const float* film_x, const float* film_y, const RGBLanes& radiance, const uint8_t* usable);

  /// Sums at a pixel: (r, g, b, weight), or null outside the tile's reach.
  const double* at(int x, int y) const {
    if (x < x0_ || y < y0_ || x >= x0_ + width_ || y >= y0_ + height_) return nullptr;
    return &sums_[4 * (static_cast<size_t>(y - y0_) * static_cast<size_t>(width_) + static_cast<size_t>(x - x0_))];
  }

 private:
  static constexpr int kBlock = 256;  ///< So many samples are looked at together.
  void add_to_own_pixels(int n, const float* film_x, const float* film_y, const RGBLanes& radiance,
                         const uint8_t* usable);

  const FilterTable* filter_;
  int x0_, y0_, width_, height_;
  std::vector<double> sums_;  ///< Double: a million floats of one size are added with an error of 1 %.
  std::vector<int> columns_;  ///< Of the filter, for the pixels that the sample being added reaches.
};

/// The finished picture: linear RGB of the cropped window, row by row.
struct Picture {
  Vec2i resolution{0, 0};  ///< Of the full picture.
  Box2i window;            ///< Rendered part: min inclusive, max exclusive.
  std::vector<float> rgb;  ///< 3 per pixel of the window.
  int width() const { return window.max.x - window.min.x; }
  int height() const { return window.max.y - window.min.y; }
};

/// Divides sums by weights; negative results become 0; scaled by the film's scale.
/// `tiles` is a grid (row-major, tiles_x wide) whose first tile is `first_tile`.
void resolve_film(const std::vector<TileSums>& tiles, Vec2i first_tile, int tiles_x, const FilterTable& filter,
                  float scale, Picture& picture);

}  // namespace whit
