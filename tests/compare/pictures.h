// Pictures made in memory, and pairs of them.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "core/compare/compare.h"

namespace whit {

/// A picture of float channels; `value` of a channel's number and a pixel.
inline PicturePlanes picture(int width, int height, std::vector<std::string> names,
                             const std::function<float(size_t channel, int x, int y)>& value) {
  PicturePlanes p;
  p.width = p.full_width = width;
  p.height = p.full_height = height;
  p.channels = static_cast<int>(names.size());
  p.channel_names = std::move(names);
  p.formats.assign(p.channel_names.size(), SampleFormat::Float);
  for (size_t c = 0; c < p.channel_names.size(); ++c) {
    std::vector<float>& plane = p.planes.emplace_back();
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) plane.push_back(value(c, x, y));
  }
  return p;
}

/// R, G and B of one value.
inline PicturePlanes grey(int width, int height, float value) {
  return picture(width, height, {"R", "G", "B"}, [=](size_t, int, int) { return value; });
}

inline float& at(PicturePlanes& p, size_t channel, int x, int y) {
  return p.planes[channel][static_cast<size_t>(y) * static_cast<size_t>(p.width) + static_cast<size_t>(x)];
}

inline void say_in_header(PicturePlanes& p, const std::string& entry, const std::string& value) {
  p.metadata.insert_or_assign(entry, value);
}

/// The pair of them, which there must be.
inline PicturePair pair_of(const PicturePlanes& a, const PicturePlanes& b, const PairRequest& request = {}) {
  Result<PicturePair> pair = make_pair_of(a, b, "a.exr", "b.exr", request);
  EXPECT_EQ(pair.error, "");
  return std::move(pair.value);
}

/// Why there is none.
inline std::string pair_error(const PicturePlanes& a, const PicturePlanes& b, const PairRequest& request = {}) {
  return make_pair_of(a, b, "a.exr", "b.exr", request).error;
}

inline Comparison compared(const PicturePlanes& a, const PicturePlanes& b, const Limits& limits = {}) {
  CompareRequest request;
  request.limits = limits;
  request.pair.statistics = limits.exact;
  return compare_pair(pair_of(a, b, request.pair), request);
}

/// What a measure came to; NaN where there is none.
inline double value_of(const Comparison& c, const std::string& measure, const std::string& layer = "") {
  const Measured* m = c.find(measure, layer);
  return m ? m->value : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace whit
