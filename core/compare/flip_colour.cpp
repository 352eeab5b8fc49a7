#include "core/compare/flip_colour.h"

#include <array>
#include <cmath>
#include <cstddef>

#include "core/base/fastmath.h"

namespace whit {
namespace {

// XYZ relative to that of white, (1, 1, 1) in linear Rec.709.
constexpr std::array<std::array<double, 3>, 3> kToXyz = {{
    {10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794},
    {2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897},
    {1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382},
}};

struct Colour {
  float x, y, z;
};

using Matrix = std::array<std::array<float, 3>, 3>;

constexpr Matrix relative_matrix() {
  Matrix m{};
  for (size_t i = 0; i < 3; ++i)
    for (size_t j = 0; j < 3; ++j)
      m[i][j] = static_cast<float>(kToXyz[i][j] / (kToXyz[i][0] + kToXyz[i][1] + kToXyz[i][2]));
  return m;
}

constexpr Matrix inverse(const Matrix& m) {
  const auto minor = [&](size_t r, size_t c) {
    const size_t r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
    return double{m[r1][c1]} * double{m[r2][c2]} - double{m[r1][c2]} * double{m[r2][c1]};
  };
  double determinant = 0;
  for (size_t c = 0; c < 3; ++c) determinant += double{m[0][c]} * minor(0, c);
  Matrix out{};
  for (size_t r = 0; r < 3; ++r)
    for (size_t c = 0; c < 3; ++c) out[c][r] = static_cast<float>(minor(r, c) / determinant);
  return out;
}

constexpr Matrix kFromLinear = relative_matrix();
constexpr Matrix kToLinear = inverse(kFromLinear);

inline Colour times(const Matrix& m, const Colour& c) {
  const auto row = [&](size_t r) { return m[r][0] * c.x + m[r][1] * c.y + m[r][2] * c.z; };
  return {row(0), row(1), row(2)};
}

// NaN stays.
inline float unit(float v) { return min_of(1.0f, max_of(0.0f, v)); }

inline float linear_of_srgb(float v) {
  const float s = unit(v), curved = flip_power((s + 0.055f) / 1.055f, 2.4);
  return s <= 0.04045f ? s / 12.92f : curved;
}

inline float lab_curve(float t) {
  constexpr float kDelta = 6.0f / 29, kKnee = kDelta * kDelta * kDelta;
  const float root = flip_power(max_of(t, kKnee), 1.0 / 3);
  return t > kKnee ? root : t / (3 * kDelta * kDelta) + 4.0f / 29;
}

// From what lab_curve() makes of XYZ.
inline Colour hunt_lab(const Colour& f) {
  const float l = 116 * f.y - 16;
  return {l, 0.01f * l * 500 * (f.x - f.y), 0.01f * l * 200 * (f.y - f.z)};
}

// A city block's distance in lightness and Euclid's in colour.
inline float distance(const Colour& one, const Colour& other) {
  const float a = one.y - other.y, b = one.z - other.z;
  return std::abs(one.x - other.x) + std::sqrt(a * a + b * b);
}

constexpr double kPower = 0.7;

// Green and blue are furthest apart.
float largest_difference() {
  const auto lab = [](const Colour& linear) {
    const Colour xyz = times(kFromLinear, linear);
    return hunt_lab({lab_curve(xyz.x), lab_curve(xyz.y), lab_curve(xyz.z)});
  };
  return flip_power(distance(lab({0, 1, 0}), lab({0, 0, 1})), kPower);
}

// Krzysztof Narkowicz: "ACES Filmic Tone Mapping Curve", 2016; of light times 0.6, as he advises for ACES's exposure.
constexpr double kScale = 0.6;
constexpr double kTone[] = {2.51 * kScale * kScale, 0.03 * kScale, 2.43 * kScale* kScale, 0.59 * kScale, 0.14};
// Where the curve has long been white, and no power of it overflows.
constexpr float kWhite = 1e6f;

inline float tone_mapped(float v) {
  constexpr float k0 = kTone[0], k1 = kTone[1], k2 = kTone[2], k3 = kTone[3], k4 = kTone[4];
  const float positive = v < 0 ? 0.0f : v;
  const float x = positive > kWhite ? kWhite : positive;
  return unit(x * (k0 * x + k1) / (x * (k2 * x + k3) + k4));
}

// Loops that do one thing are those that the compiler vectorises.
template <class Of>
void map_each(std::vector<float>& plane, const Of& of) {
  float* v = plane.data();
  const size_t size = plane.size();
#pragma omp simd
  for (size_t i = 0; i < size; ++i) v[i] = of(v[i]);
}

template <class Of>
void map_all(ColourRow& row, const Of& of) {
  for (std::vector<float>* plane : {&row.a, &row.b, &row.c}) map_each(*plane, of);
}

template <class Of>
void map_colours(ColourRow& row, const Of& of) {
  float *a = row.a.data(), *b = row.b.data(), *c = row.c.data();
  const size_t size = row.a.size();
#pragma omp simd
  for (size_t i = 0; i < size; ++i) {
    const Colour out = of(Colour{a[i], b[i], c[i]});
    a[i] = out.x;
    b[i] = out.y;
    c[i] = out.z;
  }
}

}  // namespace

void decode_srgb(ColourRow& row) { map_all(row, linear_of_srgb); }

void tone_map(ColourRow& row, float scale) {
  map_all(row, [=](float v) { return tone_mapped(v * scale); });
}

float tone_map_inverse(float shown) {
  const auto at = [&](size_t i, size_t j) {
    return static_cast<float>(kTone[i]) - shown * static_cast<float>(kTone[j]);
  };
  const float a = at(0, 2), half = 0.5f * at(1, 3) / a, c = -shown * static_cast<float>(kTone[4]) / a;
  return std::sqrt(half * half - c) - half;
}

float luminance(float r, float g, float b) { return times(kFromLinear, {r, g, b}).y; }

void to_opponent(ColourRow& row) {
  map_colours(row, [](const Colour& linear) {
    const Colour xyz = times(kFromLinear, linear);
    return Colour{xyz.y, xyz.x - xyz.y, xyz.y - xyz.z};
  });
}

void to_hunt_lab(ColourRow& row) {
  map_colours(row, [](const Colour& seen) { return times(kToLinear, {seen.y + seen.x, seen.x, seen.x - seen.z}); });
  map_all(row, unit);
  map_colours(row, [](const Colour& linear) { return times(kFromLinear, linear); });
  map_all(row, lab_curve);
  map_colours(row, hunt_lab);
}

void colour_differences(const ColourRow& one, const ColourRow& other, std::vector<float>& out) {
  const float *a0 = one.a.data(), *b0 = one.b.data(), *c0 = one.c.data();
  const float *a1 = other.a.data(), *b1 = other.b.data(), *c1 = other.c.data();
  float* to = out.data();
  const size_t size = out.size();
#pragma omp simd
  for (size_t i = 0; i < size; ++i) to[i] = distance({a0[i], b0[i], c0[i]}, {a1[i], b1[i], c1[i]});
  static const float largest = largest_difference();
  constexpr float kAtKnee = 0.95f;
  const float knee = 0.4f * largest, below = kAtKnee / knee, above = (1 - kAtKnee) / (largest - knee);
  map_each(out, [=](float d) {
    const float difference = flip_power(d, kPower);
    return difference < knee ? below * difference : kAtKnee + (difference - knee) * above;
  });
}

}  // namespace whit
