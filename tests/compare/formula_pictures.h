// Pictures by formulas, which other programs can make as well, to the bit.
#pragma once

#include <cmath>
#include <functional>
#include <vector>

namespace whit {

/// A number for a pixel and a channel.
using Formula = std::function<double(int x, int y, int c)>;

/// Three floats a pixel.
template <class Of>
std::vector<float> picture(int width, int height, const Of& of) {
  std::vector<float> rgb;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c) rgb.push_back(static_cast<float>(of(x, y, c)));
  return rgb;
}

inline double waves(int x, int y, int c) { return 0.5 + 0.4 * std::sin(0.3 * x * (c + 1) + 0.2 * y); }

inline double edges(int x, int y, int c) { return (x / 7 + y / 5 + c) % 2 == 0 ? 0.9 : 0.1; }
inline double noise(int x, int y, int c) { return 0.2 * std::sin(12.9898 * x + 78.233 * y + 37.719 * c); }
inline double lines(int x, int y, int) { return x == 20 || x + 2 * y == 60 ? 0.8 : 0.3; }

// Further in, so that no division is of a negative number.
inline double inner_edges(int x, int y, int c) { return edges(x + 5, y + 5, c); }
inline double blurred_edges(int x, int y, int c) {
  double sum = 0;
  for (int dx = -1; dx <= 1; ++dx)
    for (int dy = -1; dy <= 1; ++dy) sum += inner_edges(x + dx, y + dy, c);
  return sum / 9;
}

inline Formula times(double factor, const Formula& of) {
  return [=](int x, int y, int c) { return factor * of(x, y, c); };
}
inline Formula moved(int dx, int dy, const Formula& of) {
  return [=](int x, int y, int c) { return of(x + dx, y + dy, c); };
}
inline Formula with_pixel(double value, const Formula& of) {
  return [=](int x, int y, int c) { return x == 21 && y == 24 ? value : of(x, y, c); };
}
inline double swapped(int x, int y, int c) { return waves(x, y, 2 - c); }
inline double noisy(int x, int y, int c) { return waves(x, y, c) + noise(x, y, c); }
inline double grey(int, int, int) { return 0.3; }

}  // namespace whit
