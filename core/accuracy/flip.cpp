#include "core/accuracy/flip.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>

namespace whit {
namespace {

using Plane = std::vector<float>;
using Planes = std::array<Plane, 3>;

struct Size {
  int width, height;
  size_t pixels() const { return static_cast<size_t>(width) * static_cast<size_t>(height); }
};

// A kernel of one dimension, from -radius to radius.
struct Kernel {
  int radius = 0;
  std::vector<float> weights;
};

template <class Of>
Kernel make_kernel(int radius, const Of& of) {
  Kernel kernel{radius, {}};
  for (int i = -radius; i <= radius; ++i) kernel.weights.push_back(static_cast<float>(of(i)));
  return kernel;
}

Kernel scaled(Kernel kernel, double factor) {
  for (float& w : kernel.weights) w *= static_cast<float>(factor);
  return kernel;
}

double sum_of(const Kernel& kernel) {
  double sum = 0;
  for (float w : kernel.weights) sum += double{w};
  return sum;
}

// Beyond the border the picture goes on as its last pixel.
void filter_rows(const Plane& in, Size size, const Kernel& kernel, Plane& out) {
  const auto width = static_cast<size_t>(size.width), radius = static_cast<size_t>(kernel.radius);
  std::vector<float> row(width + 2 * radius);
  out.assign(size.pixels(), 0);
  for (size_t y = 0; y < static_cast<size_t>(size.height); ++y) {
    const float* from = &in[y * width];
    std::fill_n(row.begin(), radius, from[0]);
    std::copy_n(from, width, row.begin() + kernel.radius);
    std::fill_n(row.end() - kernel.radius, radius, from[width - 1]);
    float* to = &out[y * width];
    for (size_t k = 0; k < kernel.weights.size(); ++k)
      for (size_t x = 0; x < width; ++x) to[x] += kernel.weights[k] * row[x + k];
  }
}

void add_filtered_columns(const Plane& in, Size size, const Kernel& kernel, Plane& out) {
  const auto width = static_cast<size_t>(size.width);
  for (int y = 0; y < size.height; ++y)
    for (int k = -kernel.radius; k <= kernel.radius; ++k) {
      const float* from = &in[static_cast<size_t>(std::clamp(y + k, 0, size.height - 1)) * width];
      const float weight = kernel.weights[static_cast<size_t>(k + kernel.radius)];
      float* to = &out[static_cast<size_t>(y) * width];
      for (size_t x = 0; x < width; ++x) to[x] += weight * from[x];
    }
}

Plane filtered(const Plane& in, Size size, const Kernel& rows, const Kernel& columns) {
  Plane between, out(size.pixels());
  filter_rows(in, size, rows, between);
  add_filtered_columns(between, size, columns, out);
  return out;
}

// Colours: XYZ relative to that of white, (1, 1, 1) in linear Rec.709.
constexpr std::array<std::array<double, 3>, 3> kToXyz = {{
    {10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794},
    {2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897},
    {1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382},
}};

struct Colour {
  float x, y, z;
};

std::array<std::array<float, 3>, 3> relative_matrix() {
  std::array<std::array<float, 3>, 3> m{};
  for (size_t i = 0; i < 3; ++i)
    for (size_t j = 0; j < 3; ++j)
      m[i][j] = static_cast<float>(kToXyz[i][j] / (kToXyz[i][0] + kToXyz[i][1] + kToXyz[i][2]));
  return m;
}

std::array<std::array<float, 3>, 3> inverse(const std::array<std::array<float, 3>, 3>& m) {
  const auto minor = [&](size_t r, size_t c) {
    const size_t r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
    return double{m[r1][c1]} * double{m[r2][c2]} - double{m[r1][c2]} * double{m[r2][c1]};
  };
  double determinant = 0;
  for (size_t c = 0; c < 3; ++c) determinant += double{m[0][c]} * minor(0, c);
  std::array<std::array<float, 3>, 3> out{};
  for (size_t r = 0; r < 3; ++r)
    for (size_t c = 0; c < 3; ++c) out[c][r] = static_cast<float>(minor(r, c) / determinant);
  return out;
}

const std::array<std::array<float, 3>, 3> kFromLinear = relative_matrix();
const std::array<std::array<float, 3>, 3> kToLinear = inverse(kFromLinear);

Colour times(const std::array<std::array<float, 3>, 3>& m, const Colour& c) {
  const auto row = [&](size_t r) { return m[r][0] * c.x + m[r][1] * c.y + m[r][2] * c.z; };
  return {row(0), row(1), row(2)};
}

float linear_of_srgb(float v) {
  v = std::clamp(v, 0.0f, 1.0f);
  return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
}

Colour ycxcz_of_xyz(const Colour& c) { return {116 * c.y - 16, 500 * (c.x - c.y), 200 * (c.y - c.z)}; }

Colour xyz_of_ycxcz(const Colour& c) {
  const float y = (c.x + 16) / 116;
  return {c.y / 500 + y, y, y - c.z / 200};
}

float lab_curve(float t) {
  constexpr float kDelta = 6.0f / 29;
  return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + 4.0f / 29;
}

// L*a*b* with the Hunt effect: colours are less colourful in the dark.
Colour hunt_lab(const Colour& linear) {
  const Colour xyz = times(kFromLinear, linear);
  const float fx = lab_curve(xyz.x), fy = lab_curve(xyz.y), fz = lab_curve(xyz.z);
  const float l = 116 * fy - 16;
  return {l, 0.01f * l * 500 * (fx - fy), 0.01f * l * 200 * (fy - fz)};
}

float hyab(const Colour& a, const Colour& b) { return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z); }

Planes ycxcz_planes(std::span<const float> srgb, Size size) {
  Planes planes{Plane(size.pixels()), Plane(size.pixels()), Plane(size.pixels())};
  for (size_t i = 0; i < size.pixels(); ++i) {
    const Colour linear{linear_of_srgb(srgb[3 * i]), linear_of_srgb(srgb[3 * i + 1]), linear_of_srgb(srgb[3 * i + 2])};
    const Colour c = ycxcz_of_xyz(times(kFromLinear, linear));
    planes[0][i] = c.x;
    planes[1][i] = c.y;
    planes[2][i] = c.z;
  }
  return planes;
}

// What the eye makes of a channel: a sum of Gaussians a sqrt(pi / b) exp(-pi^2 x^2 / b), x in degrees.
struct Sensitivity {
  double a1, b1, a2, b2;
};
constexpr Sensitivity kSensitivities[] = {{1, 0.0047, 0, 1e-5}, {1, 0.0053, 0, 1e-5}, {34.1, 0.04, 13.5, 0.025}};
constexpr double kWidest = 0.04;

Plane blurred(const Plane& in, Size size, const Sensitivity& s, double ppd) {
  const int radius = static_cast<int>(std::ceil(3 * std::sqrt(kWidest / (2 * M_PI * M_PI)) * ppd));
  const auto gaussian = [&](double b) {
    return make_kernel(radius, [&](int i) { return std::exp(-M_PI * M_PI * (i / ppd) * (i / ppd) / b); });
  };
  const Kernel k1 = gaussian(s.b1), k2 = gaussian(s.b2);
  const double w1 = s.a1 * std::sqrt(M_PI / s.b1), w2 = s.a2 * std::sqrt(M_PI / s.b2);
  const double sum = w1 * sum_of(k1) * sum_of(k1) + w2 * sum_of(k2) * sum_of(k2);
  Plane between, out(size.pixels());
  filter_rows(in, size, k1, between);
  add_filtered_columns(between, size, scaled(k1, w1 / sum), out);
  if (s.a2 == 0) return out;
  filter_rows(in, size, k2, between);
  add_filtered_columns(between, size, scaled(k2, w2 / sum), out);
  return out;
}

// The picture as it is seen from afar, as colours between which distances mean something.
std::vector<Colour> perceived(const Planes& planes, Size size, double ppd) {
  const Plane y = blurred(planes[0], size, kSensitivities[0], ppd);
  const Plane cx = blurred(planes[1], size, kSensitivities[1], ppd);
  const Plane cz = blurred(planes[2], size, kSensitivities[2], ppd);
  std::vector<Colour> out(size.pixels());
  const auto unit = [](float v) { return std::clamp(v, 0.0f, 1.0f); };
  for (size_t i = 0; i < out.size(); ++i) {
    const Colour linear = times(kToLinear, xyz_of_ycxcz({y[i], cx[i], cz[i]}));
    out[i] = hunt_lab({unit(linear.x), unit(linear.y), unit(linear.z)});
  }
  return out;
}

constexpr float kColourPower = 0.7f;

// Differences of colours in [0, 1]: most of the range is for those below 0.4 of the largest there are.
float colour_difference(const Colour& a, const Colour& b, float largest) {
  constexpr float kKnee = 0.4f, kAtKnee = 0.95f;
  const float difference = std::pow(hyab(a, b), kColourPower), knee = kKnee * largest;
  return difference < knee ? kAtKnee / knee * difference
                           : kAtKnee + (difference - knee) / (largest - knee) * (1 - kAtKnee);
}

// How strong edges and points are, by the first and second derivatives of a Gaussian.
struct Features {
  Plane edges, points;
};

// Weights of either sign add up to one.
Kernel balanced(Kernel kernel) {
  double positive = 0, negative = 0;
  for (float w : kernel.weights) (w > 0 ? positive : negative) += double{w};
  for (float& w : kernel.weights) w = static_cast<float>(double{w} / (w > 0 ? positive : -negative));
  return kernel;
}

Plane length_of(const Plane& x, const Plane& y) {
  Plane out(x.size());
  for (size_t i = 0; i < x.size(); ++i) out[i] = std::sqrt(x[i] * x[i] + y[i] * y[i]);
  return out;
}

Features features_of(const Plane& y_plane, Size size, double ppd) {
  constexpr double kFeatureWidth = 0.082;  // In degrees.
  const double sigma = 0.5 * kFeatureWidth * ppd;
  const int radius = static_cast<int>(std::ceil(3 * sigma));
  const auto gaussian = [&](int i) { return std::exp(-i * i / (2 * sigma * sigma)); };
  const Kernel blur = make_kernel(radius, gaussian);
  const Kernel flat = scaled(blur, 1 / sum_of(blur));
  const Kernel first = balanced(make_kernel(radius, [&](int i) { return -i * gaussian(i); }));
  const Kernel second =
      balanced(make_kernel(radius, [&](int i) { return (i * i / (sigma * sigma) - 1) * gaussian(i); }));
  Plane grey(y_plane.size());
  for (size_t i = 0; i < grey.size(); ++i) grey[i] = (y_plane[i] + 16) / 116;
  return {length_of(filtered(grey, size, first, flat), filtered(grey, size, flat, first)),
          length_of(filtered(grey, size, second, flat), filtered(grey, size, flat, second))};
}

float feature_difference(const Features& a, const Features& b, size_t i) {
  const float edges = std::abs(a.edges[i] - b.edges[i]), points = std::abs(a.points[i] - b.points[i]);
  return std::sqrt(static_cast<float>(M_SQRT1_2) * std::max(edges, points));
}

}  // namespace

Flip flip(std::span<const float> ref, std::span<const float> test, int width, int height, double pixels_per_degree) {
  const Size size{width, height};
  assert(ref.size() == 3 * size.pixels() && test.size() == ref.size());
  const Planes ref_planes = ycxcz_planes(ref, size), test_planes = ycxcz_planes(test, size);
  const std::vector<Colour> ref_seen = perceived(ref_planes, size, pixels_per_degree);
  const std::vector<Colour> test_seen = perceived(test_planes, size, pixels_per_degree);
  const Features ref_features = features_of(ref_planes[0], size, pixels_per_degree);
  const Features test_features = features_of(test_planes[0], size, pixels_per_degree);
  // Green and blue are furthest apart.
  const float largest = std::pow(hyab(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1})), kColourPower);
  Flip result{Plane(size.pixels()), 0};
  double sum = 0;
  for (size_t i = 0; i < size.pixels(); ++i) {
    const float colour = colour_difference(ref_seen[i], test_seen[i], largest);
    result.map[i] = std::pow(colour, 1 - feature_difference(ref_features, test_features, i));
    sum += double{result.map[i]};
  }
  result.mean = sum / static_cast<double>(size.pixels());
  return result;
}

}  // namespace whit
