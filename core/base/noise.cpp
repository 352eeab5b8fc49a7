#include "core/base/noise.h"

#include <algorithm>

namespace whit {

namespace {

constexpr int kBlock = 128;
constexpr float kLacunarity = 1.99f;   ///< Not 2, so that the lattices of the octaves do not coincide.
constexpr float kMeanAbsolute = 0.2f;  ///< Roughly the mean of the absolute value of noise.

/// 0 below `low`, 1 above `high`, and a cubic between.
inline float smooth_step(float low, float high, float x) {
  const float t = clamp_to((x - low) / (high - low), 0.0f, 1.0f);
  return t * t * (3 - 2 * t);
}

/// How much remains of octave k where k + ahead octaves are visible.
inline float octave_share(float ahead) { return smooth_step(0.3f, 0.7f, ahead); }

/// The number of octaves to see at a point: those with a period of at least two widths. Not rounded.
inline float visible_octaves(float width2, float most) {
  constexpr float kLog2OfE = 1.44269504f;
  return clamp_to(-1 - 0.5f * kLog2OfE * log_of(width2), 0.0f, most);
}

struct Octave {
  int k;
  float lambda, strength;
  bool any_visible;  ///< False when no point of the run sees it: its noise need not be computed.
};

/// Calls add(octave, first point, count, visible octaves) for runs of points and k = 0 .. octaves.
template <class Add>
void for_octaves(const NoisePoints& points, float scale, int octaves, float roughness, const Add& add) {
  alignas(64) float visible[kBlock];
  for (int first = 0; first < points.n; first += kBlock) {
    const int n = std::min(kBlock, points.n - first);
    const float* width2 = points.width2 + first;
#pragma omp simd
    for (int i = 0; i < n; ++i) visible[i] = visible_octaves(width2[i] * (scale * scale), static_cast<float>(octaves));
    const float most = *std::max_element(visible, visible + n);
    float lambda = scale, strength = 1;
    for (int k = 0; k <= octaves; ++k, lambda *= kLacunarity, strength *= roughness) {
      add(Octave{k, lambda, strength, static_cast<float>(k) <= most}, first, n, visible);
    }
  }
}

// Flattened: a loop whose calls are not all inlined does not vectorise. Nor does one that computes noise for some lanes
// only, so octaves that are not visible count with a share of 0.

/// Adds an octave of noise, as far as it is visible, to n sums.
[[gnu::flatten]] void add_noise(const Octave& o, int n, const float* x, const float* y, const float* z,
                                const float* visible, float* sum) {
  const float lambda = o.lambda, strength = o.strength, k = static_cast<float>(o.k);
#pragma omp simd
  for (int i = 0; i < n; ++i) {
    const float share = octave_share(visible[i] - k);
    const float noise = perlin_noise(lambda * x[i], lambda * y[i], lambda * z[i]);
    sum[i] += strength * share * noise;
  }
}

/// Adds an octave of the absolute value of noise to n sums; `faded` is added where the octave is not wholly visible.
[[gnu::flatten]] void add_absolute_noise(const Octave& o, float faded, int n, const float* x, const float* y,
                                         const float* z, const float* visible, float* sum) {
  const float lambda = o.lambda, strength = o.strength, k = static_cast<float>(o.k);
#pragma omp simd
  for (int i = 0; i < n; ++i) {
    const float noise = std::abs(perlin_noise(lambda * x[i], lambda * y[i], lambda * z[i]));
    const float ahead = visible[i] - k, share = octave_share(ahead);
    const float missing = ahead >= 0 ? (1 - share) * kMeanAbsolute : 0.0f;
    sum[i] += strength * (share * noise + (ahead >= 1 ? 0.0f : missing + faded));
  }
}

}  // namespace

void fbm(const NoisePoints& points, float scale, int octaves, float roughness, float* out) {
  octaves = std::clamp(octaves, 0, kMaxOctaves);
  std::fill_n(out, points.n, 0.0f);
  for_octaves(points, scale, octaves, roughness, [&](const Octave& o, int first, int n, const float* visible) {
    if (o.any_visible) add_noise(o, n, points.x + first, points.y + first, points.z + first, visible, out + first);
  });
}

void turbulence(const NoisePoints& points, float scale, int octaves, float roughness, float* out) {
  octaves = std::clamp(octaves, 0, kMaxOctaves);
  std::fill_n(out, points.n, 0.0f);
  for_octaves(points, scale, octaves, roughness, [&](const Octave& o, int first, int n, const float* visible) {
    // The octave that is half faded out counts twice, as in pbrt-v3: faded towards the mean, and with the mean.
    const float faded = o.k < octaves ? kMeanAbsolute : 0.0f;
    float* const sum = out + first;
    if (o.any_visible) {
      add_absolute_noise(o, faded, n, points.x + first, points.y + first, points.z + first, visible, sum);
    } else {
      for (int i = 0; i < n; ++i) sum[i] += o.strength * faded;
    }
  });
}

}  // namespace whit
