#include "core/accuracy/cost_pictures.h"

#include <algorithm>

namespace whit {

Box2i heaviest_place(const Picture& picture, const std::vector<double>& weights, int side) {
  const int width = picture.width(), height = picture.height();
  const int w = std::min(side, width), h = std::min(side, height);
  const int step = std::max(1, side / 2);
  Vec2i best(0, 0);
  double most = -1;
  for (int y = 0; y <= height - h; y += step) {
    for (int x = 0; x <= width - w; x += step) {
      double sum = 0;
      for (int j = y; j < y + h; ++j) {
        for (int i = x; i < x + w; ++i)
          sum += weights[static_cast<size_t>(j) * static_cast<size_t>(width) + static_cast<size_t>(i)];
      }
      if (sum > most) most = sum, best = Vec2i(x, y);
    }
  }
  return {best, best + Vec2i(w, h)};
}

CostImage crop_of(const Picture& picture, const Box2i& place) {
  CostImage out;
  out.width = place.max.x - place.min.x, out.height = place.max.y - place.min.y;
  for (int y = place.min.y; y < place.max.y; ++y) {
    const size_t first =
        static_cast<size_t>(y) * static_cast<size_t>(picture.width()) + static_cast<size_t>(place.min.x);
    const auto from = picture.rgb.begin() + static_cast<std::ptrdiff_t>(3 * first);
    out.rgb.insert(out.rgb.end(), from, from + 3 * out.width);
  }
  return out;
}

CostImage image_of(int width, int height, std::span<const float> rgb, int most) {
  const int step = most > 0 ? std::max(1, (std::max(width, height) + most - 1) / most) : 1;
  CostImage out;
  out.width = (width + step - 1) / step, out.height = (height + step - 1) / step;
  out.rgb.reserve(3 * static_cast<size_t>(out.width) * static_cast<size_t>(out.height));
  for (int y = 0; y < out.height; ++y) {
    for (int x = 0; x < out.width; ++x) {
      const int x1 = std::min(width, (x + 1) * step), y1 = std::min(height, (y + 1) * step);
      double sum[3] = {0, 0, 0};
      for (int j = y * step; j < y1; ++j) {
        for (int i = x * step; i < x1; ++i) {
          const size_t at = 3 * (static_cast<size_t>(j) * static_cast<size_t>(width) + static_cast<size_t>(i));
          for (size_t c = 0; c < 3; ++c) sum[c] += static_cast<double>(rgb[at + c]);
        }
      }
      const double n = (x1 - x * step) * (y1 - y * step);
      for (double s : sum) out.rgb.push_back(static_cast<float>(s / n));
    }
  }
  return out;
}

}  // namespace whit
