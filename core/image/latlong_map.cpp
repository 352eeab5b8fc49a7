#include "core/image/latlong_map.h"

#include <algorithm>
#include <cmath>

#include "core/base/fastmath.h"
#include "core/image/texels.h"

namespace whit {
namespace {

/// How much a colour counts in sampling: its luminance; magnitudes, because colours out of gamut have negative parts.
double importance(const float* c) {
  return static_cast<double>(luminance(RGB(std::abs(c[0]), std::abs(c[1]), std::abs(c[2]))));
}

constexpr int kBlock = 128;

/// The cell between texel centres that a map coordinate t (texel i having its centre at i + 1/2) lies in: cell k lies
/// between texels k - 1 and k, for t in [0, n] and k in [0, n]. And how far in: 0 at texel k - 1, 1 at texel k.
struct Cell {
  int k;
  float within;
};
inline Cell cell_at(float t, int n) {
  const float floor = std::floor(t - 0.5f);
  const int k = static_cast<int>(floor) + 1;
  return {k < 0 ? 0 : (k > n ? n : k), t - 0.5f - floor};
}

/// Map coordinates of unit directions: x in [0, width], y in [0, height].
inline Vec2f map_coordinates(const Vec3f& d, float width, float height) {
  const float phi = atan2_of(d.y, d.x);
  const float theta = atan2_of(std::sqrt(d.x * d.x + d.y * d.y), d.z);  // acos would lose digits at the poles
  return {(phi < 0 ? phi + kTwoPi : phi) * (0.5f * kInvPi) * width, theta * kInvPi * height};
}

}  // namespace

LatLongMap::LatLongMap(const Image& image, const RGB& factor, LatLongRule rule, size_t& bad_texels) : rule_(rule) {
  build_texels(image, factor, bad_texels);
  build_bands();
  build_cells();
}

void LatLongMap::build_texels(const Image& image, const RGB& factor, size_t& bad_texels) {
  Texels t = make_texels(image, false, false, 1, false);
  bad_texels = 0;
  for (float& v : t.values) {
    if (v >= 0 && v <= std::numeric_limits<float>::max()) continue;
    v = 0, ++bad_texels;
  }
  if (rule_ == LatLongRule::Pbrt) t = resample_to_power_of_two(std::move(t), WrapMode::Repeat);
  width_ = t.width, height_ = t.height;
  const auto count = static_cast<size_t>(width_) * static_cast<size_t>(height_);
  const auto channels = static_cast<size_t>(t.channels);
  texels_.resize(3 * count);
  for (size_t i = 0; i < count; ++i) {
    const float* v = t.values.data() + i * channels;
    for (int c = 0; c < 3; ++c) texels_[3 * i + static_cast<size_t>(c)] = v[channels == 3 ? c : 0] * factor[c];
  }
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

/// The texel rows a band lies between; at the poles by the rule.
int LatLongMap::row_above(int band) const {
  return band > 0 ? band - 1 : (rule_ == LatLongRule::Pbrt ? height_ - 1 : 0);
}
int LatLongMap::row_below(int band) const {
  return band < height_ ? band : (rule_ == LatLongRule::Pbrt ? 0 : height_ - 1);
}

void LatLongMap::build_cells() {
  const auto columns = static_cast<size_t>(width_);
  std::vector<double> weights(columns * bands_.size());
  for (int k = 0; k <= height_; ++k) {
    // The mean of a bilinear function is that of its corners; the half bands at the poles see a part of the slope.
    const double below = k == 0 ? 0.75 : (k == height_ ? 0.25 : 0.5),
                 solid_angle = 1 / static_cast<double>(bands_[k].density);
    const float* upper = texels_.data() + 3 * columns * static_cast<size_t>(row_above(k));
    const float* lower = texels_.data() + 3 * columns * static_cast<size_t>(row_below(k));
    const auto column_value = [&](size_t i) {
      return (1 - below) * importance(upper + 3 * i) + below * importance(lower + 3 * i);
    };
    double* out = weights.data() + columns * static_cast<size_t>(k);
    for (size_t i = 0; i < columns; ++i) {
      out[i] = solid_angle * 0.5 * (column_value(i) + column_value(i + 1 < columns ? i + 1 : 0));
    }
  }
  cells_ = GridDistribution(width_, height_ + 1, weights);
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
  const float* texels = texels_.data();
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

std::unique_ptr<const LatLongMap> read_latlong_map(const std::string& path, const RGB& factor, LatLongRule rule,
                                                   const PrepareContext& ctx) {
  const Result<Image> image = read_image(path);
  if (!image.ok()) {
    ctx.diagnostics->file_error(ctx.statement, image.error);
    return nullptr;
  }
  constexpr int64_t kMostTexels = int64_t{1}
                                  << 28;  // indices of their numbers are 32 bits, enlarging is by less than 4
  if (static_cast<int64_t>(image.value.width) * image.value.height > kMostTexels / 4) {
    ctx.diagnostics->file_error(ctx.statement, path + ": a map of " + std::to_string(image.value.width) + " x " +
                                                   std::to_string(image.value.height) + " pixels is too large");
    return nullptr;
  }
  size_t bad_texels = 0;
  auto map = std::make_unique<const LatLongMap>(image.value, factor, rule, bad_texels);
  if (bad_texels > 0) {
    ctx.diagnostics->warning(ctx.statement,
                             path + ": " + std::to_string(bad_texels) + " numbers are negative, infinite or NaN",
                             "they count as 0");
  }
  return map;
}

}  // namespace whit
