#include "core/compare/flip.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>

#include "core/base/fastmath.h"
#include "core/compare/flip_colour.h"
#include "core/compare/flip_eye.h"

namespace whit {
namespace {

// Two pictures, and how their numbers become light on a display.
struct Pictures {
  std::span<const float> ref, test;
  int width, height;
  std::function<void(ColourRow&)> to_light;
};

// Pictures are looked at in tiles, whose numbers stay in the processor's cache.
constexpr int kTileWidth = 384, kTileHeight = 216;

struct Tile {
  int x0, x1, y0, y1;
  int width() const { return x1 - x0; }
};

// The light of a row of a tile and of `border` pixels on either side; beyond the picture it goes on as its last pixel.
void read_row(const Pictures& pictures, std::span<const float> rgb, const Tile& tile, int border, int y,
              ColourRow& out) {
  const auto first = static_cast<size_t>(std::clamp(y, 0, pictures.height - 1)) * static_cast<size_t>(pictures.width);
  for (size_t i = 0; i < out.a.size(); ++i) {
    const int x = std::clamp(tile.x0 - border + static_cast<int>(i), 0, pictures.width - 1);
    const float* pixel = &rgb[3 * (first + static_cast<size_t>(x))];
    out.a[i] = pixel[0];
    out.b[i] = pixel[1];
    out.c[i] = pixel[2];
  }
  pictures.to_light(out);
}

// What of a tile is seen is equal where what is shown is.
bool shows_the_same(const Pictures& pictures, const Tile& tile, int border, ColourRow& one, ColourRow& other) {
  for (int y = tile.y0 - border; y < tile.y1 + border; ++y) {
    read_row(pictures, pictures.ref, tile, border, y, one);
    read_row(pictures, pictures.test, tile, border, y, other);
    if (one.a != other.a || one.b != other.b || one.c != other.c) return false;
  }
  return true;
}

// Keeps the largest difference there has been, NaN above all. `differences` holds those of the colours.
void add_differences(const SeenRow& a, const SeenRow& b, const std::vector<float>& differences, float* map) {
  const float *a_edges = a.edges.data(), *b_edges = b.edges.data(), *colours = differences.data();
  const float *a_points = a.points.data(), *b_points = b.points.data();
  const size_t width = differences.size();
#pragma omp simd
  for (size_t i = 0; i < width; ++i) {
    const float feature = max_of(std::abs(a_edges[i] - b_edges[i]), std::abs(a_points[i] - b_points[i]));
    const float seen = flip_power(colours[i], double{1 - std::sqrt(static_cast<float>(M_SQRT1_2) * feature)});
    map[i] = seen <= map[i] ? map[i] : seen + (map[i] - map[i]);
  }
}

void look_at_tile(const Pictures& pictures, const EyeKernels& kernels, const Tile& tile, std::vector<float>& map) {
  const int border = kernels.radius;
  const auto width = static_cast<size_t>(tile.width()), shown_width = width + 2 * static_cast<size_t>(border);
  ColourRow ref_light(shown_width), test_light(shown_width);
  if (shows_the_same(pictures, tile, border, ref_light, test_light)) return;
  Eye ref_eye(kernels, tile.width()), test_eye(kernels, tile.width());
  SeenRow ref_seen(width), test_seen(width);
  std::vector<float> differences(width);
  for (int y = tile.y0 - border; y < tile.y1 + border; ++y) {
    read_row(pictures, pictures.ref, tile, border, y, ref_light);
    read_row(pictures, pictures.test, tile, border, y, test_light);
    ref_eye.show(ref_light);
    test_eye.show(test_light);
    if (y - border < tile.y0) continue;
    ref_eye.see(ref_seen);
    test_eye.see(test_seen);
    colour_differences(ref_seen.colours, test_seen.colours, differences);
    const size_t at =
        static_cast<size_t>(y - border) * static_cast<size_t>(pictures.width) + static_cast<size_t>(tile.x0);
    add_differences(ref_seen, test_seen, differences, &map[at]);
  }
}

// Adds what is seen to what has been seen in a map.
void look(const Pictures& pictures, const EyeKernels& kernels, std::vector<float>& map) {
  const int columns = (pictures.width + kTileWidth - 1) / kTileWidth;
  const int rows = (pictures.height + kTileHeight - 1) / kTileHeight;
  tbb::parallel_for(0, columns * rows, [&](int i) {
    const int x0 = i % columns * kTileWidth, y0 = i / columns * kTileHeight;
    const Tile tile{x0, std::min(x0 + kTileWidth, pictures.width), y0, std::min(y0 + kTileHeight, pictures.height)};
    look_at_tile(pictures, kernels, tile, map);
  });
}

double mean_of(const std::vector<float>& map) {
  double sum = 0;
  for (float v : map) sum += double{v};
  return sum / static_cast<double>(map.size());
}

bool is_nan(const float* pixel) { return std::isnan(pixel[0]) || std::isnan(pixel[1]) || std::isnan(pixel[2]); }

// Of finite pixels; NaN has none, and infinity would leave everything else black.
std::vector<float> finite_luminances(std::span<const float> rgb) {
  std::vector<float> out;
  out.reserve(rgb.size() / 3);
  for (size_t i = 0; i < rgb.size(); i += 3) {
    const float y = luminance(std::max(rgb[i], 0.0f), std::max(rgb[i + 1], 0.0f), std::max(rgb[i + 2], 0.0f));
    if (!is_nan(&rgb[i]) && std::isfinite(y)) out.push_back(y);
  }
  return out;
}

}  // namespace

Flip flip(std::span<const float> ref, std::span<const float> test, int width, int height, double pixels_per_degree) {
  const Pictures pictures{ref, test, width, height, decode_srgb};
  Flip result{std::vector<float>(ref.size() / 3), 0};
  assert(result.map.size() == static_cast<size_t>(width) * static_cast<size_t>(height) && test.size() == ref.size());
  look(pictures, EyeKernels(pixels_per_degree), result.map);
  result.mean = mean_of(result.map);
  return result;
}

FlipExposures flip_exposures(std::span<const float> rgb) {
  std::vector<float> y = finite_luminances(rgb);
  if (y.empty()) return {};
  const auto middle = y.begin() + static_cast<std::ptrdiff_t>(y.size() / 2);
  std::nth_element(y.begin(), middle, y.end());
  const float brightest = *std::max_element(middle, y.end());
  if (!(brightest > 0)) return {};
  // In floats throughout, as the authors' program does it, so that the count is the same.
  const float bright = tone_map_inverse(0.85f), median = std::max(*middle, std::numeric_limits<float>::epsilon());
  const float start = std::log2(bright / brightest), stop = std::max(start, std::log2(bright / median));
  return {double{start}, double{stop}, std::max(2, static_cast<int>(std::ceil(stop - start)))};
}

Flip hdr_flip(std::span<const float> ref, std::span<const float> test, int width, int height,
              double pixels_per_degree) {
  Flip result{std::vector<float>(ref.size() / 3), 0};
  assert(result.map.size() == static_cast<size_t>(width) * static_cast<size_t>(height) && test.size() == ref.size());
  FlipExposures exposures = flip_exposures(ref);
  if (exposures.count == 0) exposures = flip_exposures(test);
  if (exposures.count == 0) exposures.count = 1;
  const EyeKernels kernels(pixels_per_degree);
  const double step = (exposures.stop - exposures.start) / std::max(exposures.count - 1, 1);
  for (int i = 0; i < (step > 0 ? exposures.count : 1); ++i) {
    const float scale = static_cast<float>(std::exp2(exposures.start + i * step));
    look({ref, test, width, height, [&](ColourRow& row) { tone_map(row, scale); }}, kernels, result.map);
  }
  result.mean = mean_of(result.map);
  return result;
}

}  // namespace whit
