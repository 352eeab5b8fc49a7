#include "core/accuracy/report_picture.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/image/data_address.h"

namespace whit {
namespace {

using Colour = std::array<double, 3>;

bool is_empty(const CostImage& image) {
  return image.width <= 0 || image.height <= 0 ||
         image.rgb.size() != 3 * static_cast<size_t>(image.width) * static_cast<size_t>(image.height);
}

double srgb(double v) {
  if (!(v > 0)) return 0;
  return std::min(1.0, v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055);
}

const float* pixel_at(const CostImage& image, int x, int y) {
  return &image.rgb[3 * (static_cast<size_t>(y) * static_cast<size_t>(image.width) + static_cast<size_t>(x))];
}

double heat_at(const CostImage& image, int x, int y) {
  const float* p = pixel_at(image, x, y);
  return (double{p[0]} + double{p[1]} + double{p[2]}) / 3;
}

// The pixels of the picture that a pixel of the reduced one stands for.
struct Block {
  int x0, y0, x1, y1;
};

// Display values of a picture reduced by a whole number, `of` each block.
template <class Of>
std::string address_of(const CostImage& image, int most_width, const Of& of) {
  const int step = (image.width + most_width - 1) / most_width;
  DisplayPixels pixels{(image.width + step - 1) / step, (image.height + step - 1) / step, 8, {}};
  for (int y = 0; y < image.height; y += step)
    for (int x = 0; x < image.width; x += step) {
      const Colour colour = of(Block{x, y, std::min(x + step, image.width), std::min(y + step, image.height)});
      for (double c : colour) pixels.bytes.push_back(static_cast<unsigned char>(std::lround(c * 255)));
    }
  return png_address(pixels);
}

// Black, violet, red, orange, pale yellow: as bright as the value, on paper too.
Colour heat_colour(double t) {
  constexpr std::array<Colour, 6> kStops{{{0.00, 0.00, 0.02},
                                          {0.25, 0.04, 0.41},
                                          {0.58, 0.15, 0.40},
                                          {0.87, 0.32, 0.23},
                                          {0.99, 0.65, 0.04},
                                          {0.99, 1.00, 0.64}}};
  const double at = std::clamp(t, 0.0, 1.0) * (kStops.size() - 1);
  const size_t i = std::min(static_cast<size_t>(at), kStops.size() - 2);
  Colour out;
  for (size_t c = 0; c < 3; ++c) out[c] = std::lerp(kStops[i][c], kStops[i + 1][c], at - static_cast<double>(i));
  return out;
}

}  // namespace

std::string picture_address(const CostImage& image, int most_width) {
  if (is_empty(image)) return "";
  return address_of(image, most_width, [&](const Block& b) {
    Colour sum{};
    for (int y = b.y0; y < b.y1; ++y)
      for (int x = b.x0; x < b.x1; ++x)
        for (size_t c = 0; c < 3; ++c) sum[c] += srgb(double{pixel_at(image, x, y)[c]});
    for (double& s : sum) s /= (b.x1 - b.x0) * (b.y1 - b.y0);
    return sum;
  });
}

double heat_scale(const CostImage& image) {
  if (is_empty(image)) return 0;
  std::vector<double> values;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      if (const double v = heat_at(image, x, y); std::isfinite(v)) values.push_back(v);
  if (values.empty()) return 0;
  const auto at = values.end() - 1 - static_cast<ptrdiff_t>(values.size() / 200);
  std::nth_element(values.begin(), at, values.end());
  return *at > 0 ? *at : *std::max_element(values.begin(), values.end());
}

std::string heat_address(const CostImage& image, double full, int most_width) {
  if (is_empty(image)) return "";
  return address_of(image, most_width, [&](const Block& b) {
    double most = 0;
    for (int y = b.y0; y < b.y1; ++y)
      for (int x = b.x0; x < b.x1; ++x) most = std::max(most, heat_at(image, x, y));
    return heat_colour(full > 0 ? most / full : 0);
  });
}

}  // namespace whit
