#include "plugins/shared/latlong_map.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>
#include <new>

#include "core/base/fastmath.h"
#include "core/image/image.h"
#include "core/image/picture_need.h"
#include "core/image/signature.h"
#include "core/plugin/memory_limit.h"

namespace whit {
namespace {

/// How much a colour counts in sampling: its luminance, in double because floats could overflow; of magnitudes,
/// because colours out of gamut have negative parts.
double importance(const float* c) {
  const auto part = [&](int i) { return std::abs(static_cast<double>(c[i])); };
  return 0.212671 * part(0) + 0.715160 * part(1) + 0.072169 * part(2);
}

constexpr const char* kSmallerMap = "a smaller map takes less";
constexpr int kBlock = 128;
constexpr size_t kGrain = size_t{1} << 15;  ///< What a thread takes of many numbers.

/// Makes 0 of what is negative, infinite or NaN; returns how many there were.
size_t clear_bad_numbers(std::vector<float>& values) {
  constexpr float kMost = std::numeric_limits<float>::max();
  std::atomic<size_t> bad = 0;
  tbb::parallel_for(tbb::blocked_range<size_t>(0, values.size(), kGrain), [&](const auto& some) {
    int found = 0;
    for (size_t i = some.begin(); i < some.end(); ++i) {
      const float v = values[i];
      found += v >= 0 && v <= kMost ? 0 : 1;
    }
    if (found == 0) return;
    bad += static_cast<size_t>(found);
    for (size_t i = some.begin(); i < some.end(); ++i) {
      if (!(values[i] >= 0 && values[i] <= kMost)) values[i] = 0;
    }
  });
  return bad;
}

/// The numbers of a picture as they are. No copy is made of one that is R, G, B, for maps are large.
Texels take_texels(Image&& image) {
  if (image.channels != 3 || image.rgb_channels() != std::vector<int>{0, 1, 2})
    return make_texels(image, false, false, 1, false);
  return {image.width, image.height, 3, std::move(image.pixels)};
}

/// The cell between texel centres that a map coordinate t (texel i having its centre at i + 1/2) lies in: cell k lies
/// between texels k - 1 and k, for t in [0, n] and k in [0, n]. And how far in: 0 at texel k - 1, 1 at texel k. A
/// coordinate that is no number, as directions far from everything may give, is in cell 0 and no number in there.
struct Cell {
  int k;
  float within;
};
inline Cell cell_at(float t, int n) {
  const float floor = std::floor(t - 0.5f), k = floor + 1, last = static_cast<float>(n);
  return {static_cast<int>(k > 0 ? (k < last ? k : last) : 0.0f), t - 0.5f - floor};
}

/// Map coordinates of unit directions: x in [0, width], y in [0, height].
inline Vec2f map_coordinates(const Vec3f& d, float width, float height) {
  const float phi = atan2_of(d.y, d.x);
  const float theta = atan2_of(std::sqrt(d.x * d.x + d.y * d.y), d.z);  // acos would lose digits at the poles
  return {(phi < 0 ? phi + kTwoPi : phi) * (0.5f * kInvPi) * width, theta * kInvPi * height};
}

}  // namespace

namespace {

bool is_resampled(int width, int height, LatLongRule rule) {
  return rule == LatLongRule::Pbrt && !(is_power_of_two(width) && is_power_of_two(height));
}

/// Numbers of the map: of its cells, and of its texels for each channel.
struct MapSize {
  size_t texels, cells;
  MapSize(int width, int height, LatLongRule rule) {
    const bool larger = is_resampled(width, height, rule);
    const auto side = [&](int n) { return larger ? std::bit_ceil(static_cast<size_t>(n)) : static_cast<size_t>(n); };
    texels = side(width) * side(height), cells = (side(width) + 1) * (side(height) + 1);
  }
};

}  // namespace

LatLongMap::LatLongMap(Texels texels, const RGB& factor, LatLongRule rule, size_t& bad_numbers) {
  build_radiance(std::move(texels), factor, rule, bad_numbers);
  build_bands();
  build_cells();
}

void LatLongMap::build_radiance(Texels texels, const RGB& factor, LatLongRule rule, size_t& bad_numbers) {
  bad_numbers = clear_bad_numbers(texels.values);
  const bool resampled = is_resampled(texels.width, texels.height, rule);
  if (resampled) texels = resample_to_power_of_two(std::move(texels), WrapMode::LatLong);
  width_ = texels.width, height_ = texels.height;
  const size_t pixels = static_cast<size_t>(width_) * static_cast<size_t>(height_);
  if (texels.channels == 1) {
    std::vector<float> rgb(3 * pixels);
    for (size_t i = 0; i < rgb.size(); ++i) rgb[i] = texels.values[i / 3];
    texels.values = std::move(rgb);
  }
  radiance_ = std::move(texels.values);
  if (!resampled && factor == RGB(1.0f)) return;
  tbb::parallel_for(tbb::blocked_range<size_t>(0, pixels, kGrain), [&](const auto& some) {
    constexpr float kMost = std::numeric_limits<float>::max();
    float* texel = radiance_.data() + 3 * some.begin();
    for (size_t i = 0; i < some.size(); ++i, texel += 3) {
      for (int c = 0; c < 3; ++c) texel[c] = clamp_to(texel[c] * factor[c], -kMost, kMost);
    }
  });
}

size_t LatLongMap::bytes(int width, int height, LatLongRule rule) {
  const MapSize size(width, height, rule);
  return sizeof(float) * (3 * size.texels + size.cells);
}

size_t LatLongMap::bytes_to_build(int width, int height, int channels, LatLongRule rule) {
  const MapSize size(width, height, rule);
  const size_t given = static_cast<size_t>(width) * static_cast<size_t>(height) * static_cast<size_t>(channels);
  // Each step gives back what it was made of: enlarging, going from one channel to three, and the cells.
  const bool resampled = is_resampled(width, height, rule);
  const size_t copy = resampled ? size.texels * static_cast<size_t>(channels) : 0, of = resampled ? copy : given;
  const size_t most = std::max({given + copy, channels == 1 ? of + 3 * size.texels : 0, 3 * size.texels + size.cells});
  return sizeof(float) * (most - std::min(most, given));
}

void LatLongMap::build_bands() {
  bands_.reserve(static_cast<size_t>(height_) + 1);
  const double step = detail::kPiD / height_;
  for (int k = 0; k <= height_; ++k) {
    const double low = std::max(0.0, (k - 0.5) * step), high = std::min(detail::kPiD, (k + 0.5) * step);
    const bool north = low + high < detail::kPiD;
    // 1 - cos a = 2 sin^2(a/2), measured from the nearer pole, keeps its digits at the poles.
    const auto from_pole = [&](double theta) {
      const double s = std::sin(0.5 * (north ? theta : detail::kPiD - theta));
      return 2 * s * s;
    };
    const double solid_angle = 2 * detail::kPiD / width_ * std::abs(from_pole(high) - from_pole(low));
    bands_.push_back({north ? 1.0f : -1.0f, static_cast<float>(from_pole(low)), static_cast<float>(from_pole(high)),
                      static_cast<float>(1 / solid_angle)});
  }
}

/// The texel rows a band lies between. Those at the poles lie between a row and itself: rows do not go around.
int LatLongMap::row_above(int band) const { return std::max(band - 1, 0); }
int LatLongMap::row_below(int band) const { return std::min(band, height_ - 1); }

void LatLongMap::build_cells() {
  const auto columns = static_cast<size_t>(width_);
  cells_ = GridDistribution(width_, height_ + 1);
  const auto importances = [&](int row, std::vector<double>& out) {
    const float* texel = radiance_.data() + 3 * columns * static_cast<size_t>(row);
    for (size_t i = 0; i < columns; ++i) out[i] = importance(texel + 3 * i);
  };
  constexpr int kBands = 32;
  tbb::parallel_for(tbb::blocked_range<int>(0, height_ + 1, kBands), [&](const auto& some) {
    std::vector<double> upper(columns), lower(columns), values(columns + 1), weights(columns);
    int lower_row = -1;  // The next band lies below it.
    for (int k = some.begin(); k < some.end(); ++k) {
      if (lower_row == row_above(k)) std::swap(upper, lower);
      else importances(row_above(k), upper);
      importances(lower_row = row_below(k), lower);
      // The mean of a bilinear function is that of its corners; the half bands at the poles see half of the slope.
      const double below = k == 0 ? 0.75 : (k == height_ ? 0.25 : 0.5);
      const double solid_angle = 1 / static_cast<double>(bands_[static_cast<size_t>(k)].density);
      for (size_t i = 0; i < columns; ++i) values[i] = (1 - below) * upper[i] + below * lower[i];
      values[columns] = values[0];
      for (size_t i = 0; i < columns; ++i) weights[i] = solid_angle * 0.5 * (values[i] + values[i + 1]);
      cells_.set_row(k, weights);
    }
  });
  cells_.finish();
}

/// Texels count by the height of their row's zone of the sphere.
double LatLongMap::mean() const {
  const auto columns = static_cast<size_t>(width_);
  double sum = 0;
  for (int row = 0; row < height_; ++row) {
    const double zone = std::cos(detail::kPiD * row / height_) - std::cos(detail::kPiD * (row + 1) / height_);
    const float* texel = radiance_.data() + 3 * columns * static_cast<size_t>(row);
    double of_row = 0;
    for (size_t i = 0; i < columns; ++i) of_row += importance(texel + 3 * i);
    sum += 0.5 * zone * of_row / static_cast<double>(columns);
  }
  return sum;
}

void LatLongMap::evaluate(int n, const Vec3Lanes& d, const RGBLanes& radiance, float* pdf) const {
  float x[kBlock], y[kBlock];
  const auto width = static_cast<float>(width_), height = static_cast<float>(height_);
  for (int first = 0; first < n; first += kBlock) {
    const int count = std::min(kBlock, n - first);
    for_lanes(count, [&, in = d.from(first)](int i) {
      const Vec2f at = map_coordinates(in[i], width, height);
      x[i] = at.x, y[i] = at.y;
    });
    look_up(count, x, y, radiance.from(first));
    if (pdf) find_density(count, x, y, pdf + first);
  }
}

/// The bilinear radiance at n map coordinates.
void LatLongMap::look_up(int n, const float* x, const float* y, const RGBLanes& out) const {
  const float* texels = radiance_.data();
  const int columns = width_, rows = height_, above_top = row_above(0), below_bottom = row_below(height_);
  for_lanes(n, [=](int i) {
    const Cell cx = cell_at(x[i], columns), cy = cell_at(y[i], rows);
    const int left = 3 * (cx.k > 0 ? cx.k - 1 : columns - 1), right = 3 * (cx.k < columns ? cx.k : 0);
    const int upper = 3 * columns * (cy.k > 0 ? cy.k - 1 : above_top);
    const int lower = 3 * columns * (cy.k < rows ? cy.k : below_bottom);
    const auto blend = [&](int channel) {
      const float* t = texels + channel;
      return lerp(cy.within, lerp(cx.within, t[upper + left], t[upper + right]),
                  lerp(cx.within, t[lower + left], t[lower + right]));
    };
    out.r[i] = blend(0), out.g[i] = blend(1), out.b[i] = blend(2);
  });
}

/// The density of sample() per steradian at n map coordinates.
void LatLongMap::find_density(int n, const float* x, const float* y, float* pdf) const {
  const GridDistribution::View cells = cells_.view();
  const Band* bands = bands_.data();
  const int columns = width_, rows = height_;
  for_lanes(n, [=](int i) {
    const int k = cell_at(x[i], columns).k, band = cell_at(y[i], rows).k;
    pdf[i] = cells.probability(k > 0 ? k - 1 : columns - 1, band) * bands[band].density;
  });
}

void LatLongMap::sample(int n, const float* u, const float* v, const Vec3Lanes& d) const {
  int column[kBlock], band[kBlock];
  float du[kBlock], dv[kBlock];
  const Band* bands = bands_.data();
  const float turn = 1 / static_cast<float>(width_);
  for (int first = 0; first < n; first += kBlock) {
    const int count = std::min(kBlock, n - first);
    cells_.sample(count, u + first, v + first, column, band, du, dv);
    for_lanes(count, [&, out = d.from(first)](int i) {
      const Band b = bands[band[i]];
      const float h = lerp(dv[i], b.low, b.high);  // 1 - |cos theta|: areas on the sphere are proportional to it
      const float sin_theta = safe_sqrt(h * (2 - h));
      // Column k lies between the centres of texels k and k + 1.
      const SinCos phi = sin_cos_2pi((static_cast<float>(column[i]) + 0.5f + du[i]) * turn);
      out.set(i, {sin_theta * phi.cos, sin_theta * phi.sin, b.pole * (1 - h)});
    });
  }
}

MemoryNeed latlong_need(const std::string& path, LatLongRule rule) {
  const std::optional<PictureHeader> header = path.empty() ? std::nullopt : quick_header(path);
  if (!header) return {};
  const ImageInfo* const info = &header->info;
  const int channels = info->rgb_channels()[0] == info->rgb_channels()[1] ? 1 : 3;
  MemoryNeed need;
  const size_t map = LatLongMap::bytes(info->width, info->height, rule);
  // The picture's numbers, which its texels may take the place of; of others there are both for a while.
  const size_t pixels = sizeof(float) * static_cast<size_t>(info->width) * static_cast<size_t>(info->height);
  const size_t texels = pixels * static_cast<size_t>(channels), picture = pixels * static_cast<size_t>(info->channels);
  const size_t reading = picture + std::max(header->reading, info->channels == 3 ? 0 : texels);
  const size_t all = std::max(reading, texels + LatLongMap::bytes_to_build(info->width, info->height, channels, rule));
  need.light_map = map, need.making = all - std::min(all, map);
  // What OpenImageIO takes with all its libraries, once it has been asked for.
  constexpr uint64_t kOpenImageIO = uint64_t{80} << 20;
  if (kind_of_picture(path) == PictureKind::Other) need.light_map += kOpenImageIO;
  return need;
}

std::unique_ptr<const LatLongMap> read_latlong_map(const std::string& path, const RGB& factor, LatLongRule rule,
                                                   const PrepareContext& ctx) {
  Texels texels;
  {
    const Stopwatch watch;
    Result<Image> image = read_image(path);
    if (ctx.reading_pictures) *ctx.reading_pictures += watch.elapsed();
    if (!image.ok()) {
      if (image.out_of_memory) ctx.diagnostics->add(limit_error(ctx.statement, image.error, kSmallerMap));
      else ctx.diagnostics->file_error(ctx.statement, image.error);
      return nullptr;
    }
    // Numbers of texels, enlarged to powers of two, are counted in 32 bits.
    const auto enlarged = [](int side) { return int64_t{std::bit_ceil(static_cast<uint32_t>(side))}; };
    if (enlarged(image.value.width) * enlarged(image.value.height) > int64_t{1} << 29) {
      ctx.diagnostics->file_error(ctx.statement, path + ": " + std::to_string(image.value.width) + " x " +
                                                     std::to_string(image.value.height) +
                                                     " pixels are too many for an environment map");
      return nullptr;
    }
    texels = take_texels(std::move(image.value));
  }  // the picture goes here: large maps are not held twice
  size_t bad_numbers = 0;
  std::unique_ptr<const LatLongMap> map;
  try {
    need_memory(LatLongMap::bytes_to_build(texels.width, texels.height, texels.channels, rule),
                "what light is made of");
    map = std::make_unique<const LatLongMap>(std::move(texels), factor, rule, bad_numbers);
  } catch (const std::bad_alloc& e) {
    ctx.diagnostics->add(limit_error(ctx.statement, path + ": " + e.what(), kSmallerMap));
    return nullptr;
  }
  if (bad_numbers > 0) {
    ctx.diagnostics->warning(ctx.statement,
                             path + ": " + std::to_string(bad_numbers) + " numbers are negative, infinite or NaN",
                             "they count as 0");
  }
  return map;
}

}  // namespace whit
