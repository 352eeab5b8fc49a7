#include "core/compare/flip_eye.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <tuple>
#include <utility>

namespace whit {
namespace {

// Weights that a float's rounding of their sum hides are left out.
constexpr double kNothing = 1e-9;

template <class Of>
HalfKernel<float> make_kernel(int radius, bool odd, const Of& of) {
  HalfKernel<float> kernel{odd, {}};
  for (int i = 0; i <= radius; ++i) kernel.weights.push_back(static_cast<float>(of(i)));
  return kernel;
}

HalfKernel<float> scaled(HalfKernel<float> kernel, double factor) {
  for (float& w : kernel.weights) w *= static_cast<float>(factor);
  return kernel;
}

// Of the weights of either sign.
struct Sums {
  double positive = 0, negative = 0;
};

Sums sums_of(const HalfKernel<float>& kernel) {
  Sums sums;
  for (size_t i = 0; i < kernel.weights.size(); ++i) {
    const double w = double{kernel.weights[i]};
    (kernel.odd || w > 0 ? sums.positive : sums.negative) += std::abs(w) * (i == 0 || kernel.odd ? 1 : 2);
  }
  return sums;
}

HalfKernel<float> without_nothing(HalfKernel<float> kernel) {
  while (kernel.weights.size() > 1 && std::abs(kernel.weights.back()) < kNothing * std::abs(kernel.weights.front()))
    kernel.weights.pop_back();
  return kernel;
}

// What the eye makes of a channel: a sum of Gaussians a sqrt(pi / b) exp(-pi^2 x^2 / b), x in degrees.
struct Sensitivity {
  double a1, b1, a2, b2;
};
constexpr Sensitivity kY = {1, 0.0047, 0, 1e-5}, kCx = {1, 0.0053, 0, 1e-5}, kCz = {34.1, 0.04, 13.5, 0.025};
constexpr double kWidest = 0.04;

// Both Gaussians, their weights together one.
std::pair<EyeKernels::Gaussian, EyeKernels::Gaussian> gaussians(const Sensitivity& s, double ppd) {
  const int radius = static_cast<int>(std::ceil(3 * std::sqrt(kWidest / (2 * M_PI * M_PI)) * ppd));
  const auto gaussian = [&](double b) {
    return make_kernel(radius, false, [&](int i) { return std::exp(-M_PI * M_PI * (i / ppd) * (i / ppd) / b); });
  };
  const HalfKernel<float> one = gaussian(s.b1), two = gaussian(s.b2);
  const double w1 = s.a1 * std::sqrt(M_PI / s.b1), w2 = s.a2 * std::sqrt(M_PI / s.b2);
  const double sum1 = sums_of(one).positive, sum2 = sums_of(two).positive, sum = w1 * sum1 * sum1 + w2 * sum2 * sum2;
  const auto both = [&](const HalfKernel<float>& kernel, double w) {
    return EyeKernels::Gaussian{without_nothing(kernel), without_nothing(scaled(kernel, w / sum))};
  };
  return {both(one, w1), both(two, w2)};
}

// Weights of either sign add up to one.
HalfKernel<float> balanced(HalfKernel<float> kernel) {
  const Sums sums = sums_of(kernel);
  for (float& w : kernel.weights)
    w = static_cast<float>(double{w} / (w > 0 || kernel.odd ? sums.positive : sums.negative));
  return kernel;
}

void length_of(std::vector<float>& x, const std::vector<float>& y) {
  for (size_t i = 0; i < x.size(); ++i) x[i] = std::sqrt(x[i] * x[i] + y[i] * y[i]);
}

}  // namespace

EyeKernels::EyeKernels(double ppd) {
  y = gaussians(whit::kY, ppd).first;
  cx = gaussians(whit::kCx, ppd).first;
  std::tie(cz_narrow, cz_wide) = gaussians(whit::kCz, ppd);
  constexpr double kFeatureWidth = 0.082;  // In degrees.
  const double sigma = 0.5 * kFeatureWidth * ppd;
  const int reach = static_cast<int>(std::ceil(3 * sigma));
  const auto gaussian = [&](int i) { return std::exp(-i * i / (2 * sigma * sigma)); };
  flat = balanced(make_kernel(reach, false, gaussian));
  first = balanced(make_kernel(reach, true, [&](int i) { return i * gaussian(i); }));
  second = balanced(make_kernel(reach, false, [&](int i) { return (i * i / (sigma * sigma) - 1) * gaussian(i); }));
  for (const HalfKernel<float>* kernel : {&y.row, &cx.row, &cz_narrow.row, &cz_wide.row, &flat})
    radius = std::max(radius, kernel->radius());
}

Eye::Eye(const EyeKernels& kernels, int width)
    : kernels_(kernels),
      width_(width),
      depth_(static_cast<int>(std::bit_ceil(static_cast<unsigned>(2 * kernels.radius + 1)))),
      rings_(size_t{kPlanes} * static_cast<size_t>(depth_) * static_cast<size_t>(width)),
      other_(static_cast<size_t>(width)),
      from_(static_cast<size_t>(2 * kernels.radius + 1)) {}

float* Eye::row(Plane plane, int y) {
  return &rings_[(static_cast<size_t>(plane) * static_cast<size_t>(depth_) + static_cast<size_t>(y & (depth_ - 1))) *
                 static_cast<size_t>(width_)];
}

void Eye::filter_row(const std::vector<float>& in, const HalfKernel<float>& kernel, Plane plane) {
  const int radius = kernels_.radius;
  for (int k = -radius; k <= radius; ++k) from_[static_cast<size_t>(k + radius)] = in.data() + radius + k;
  convolve(kernel, &from_[static_cast<size_t>(radius)], other_.size(), row(plane, last_));
}

void Eye::filter_column(const HalfKernel<float>& kernel, Plane plane, std::vector<float>& out) {
  const int radius = kernels_.radius;
  for (int k = -radius; k <= radius; ++k) from_[static_cast<size_t>(k + radius)] = row(plane, last_ - radius + k);
  convolve(kernel, &from_[static_cast<size_t>(radius)], other_.size(), out.data());
}

void Eye::show(ColourRow& light) {
  to_opponent(light);
  ++last_;
  filter_row(light.a, kernels_.y.row, kY);
  filter_row(light.b, kernels_.cx.row, kCx);
  filter_row(light.c, kernels_.cz_narrow.row, kCzNarrow);
  filter_row(light.c, kernels_.cz_wide.row, kCzWide);
  filter_row(light.a, kernels_.flat, kFlat);
  filter_row(light.a, kernels_.first, kFirst);
  filter_row(light.a, kernels_.second, kSecond);
}

void Eye::see(SeenRow& out) {
  filter_column(kernels_.y.column, kY, out.colours.a);
  filter_column(kernels_.cx.column, kCx, out.colours.b);
  filter_column(kernels_.cz_narrow.column, kCzNarrow, out.colours.c);
  filter_column(kernels_.cz_wide.column, kCzWide, other_);
  for (size_t i = 0; i < other_.size(); ++i) out.colours.c[i] += other_[i];
  to_hunt_lab(out.colours);
  filter_column(kernels_.flat, kFirst, out.edges);
  filter_column(kernels_.first, kFlat, other_);
  length_of(out.edges, other_);
  filter_column(kernels_.flat, kSecond, out.points);
  filter_column(kernels_.second, kFlat, other_);
  length_of(out.points, other_);
}

}  // namespace whit
