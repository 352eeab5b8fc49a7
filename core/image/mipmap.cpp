// Building the pyramid; mipmap_lookup.cpp filters.
#include "core/image/mipmap.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace whit {
namespace {

// The coarser level: each texel the mean of four. A side that is 1 already takes texel 1 from outside: the same
// texel again when the texture repeats or clamps, nothing when it is black there (as in pbrt-v3).
Texels halve(const Texels& fine, WrapMode wrap) {
  Texels out{std::max(1, fine.width / 2), std::max(1, fine.height / 2), fine.channels, {}};
  out.values.resize(static_cast<size_t>(out.width) * out.height * out.channels);
  const auto fetch = [&](int s, int t, int c) {
    if (s >= fine.width || t >= fine.height) {
      if (wrap == WrapMode::Black) return 0.0f;
      s = std::min(s, fine.width - 1);
      t = std::min(t, fine.height - 1);
    }
    return fine.values[(static_cast<size_t>(t) * fine.width + s) * fine.channels + c];
  };
  tbb::parallel_for(0, out.height, [&](int t) {
    float* texel = out.values.data() + static_cast<size_t>(t) * out.width * out.channels;
    for (int s = 0; s < out.width; ++s)
      for (int c = 0; c < out.channels; ++c)
        *texel++ = 0.25f * (fetch(2 * s, 2 * t, c) + fetch(2 * s + 1, 2 * t, c) + fetch(2 * s, 2 * t + 1, c) +
                            fetch(2 * s + 1, 2 * t + 1, c));
  });
  return out;
}

bool fits_half(const Texels& texels) {
  return std::all_of(texels.values.begin(), texels.values.end(), [](float v) { return std::abs(v) <= 65504.0f; });
}

// Level 0 in its own bytes: the picture's colour channels, flipped as asked for.
std::vector<uint8_t> image_bytes(const Image& image, int channels, bool flip) {
  const std::vector<int> rgb = image.rgb_channels();
  std::vector<uint8_t> bytes;
  bytes.reserve(static_cast<size_t>(image.width) * image.height * channels);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const float* p = image.pixel(x, flip ? image.height - 1 - y : y);
      for (int c = 0; c < channels; ++c) bytes.push_back(static_cast<uint8_t>(std::lround(255 * p[rgb[c]])));
    }
  return bytes;
}

}  // namespace

// The steps of the constructor, with access to the private level type.
struct MipMapBuilder {
  static MipMap::Level store(const Texels& texels, bool as_half) {
    MipMap::Level level;
    level.width = texels.width;
    level.height = texels.height;
    level.storage = as_half ? MipMap::Storage::Halves : MipMap::Storage::Floats;
    if (as_half) level.halves.assign(texels.values.begin(), texels.values.end());
    else level.floats = texels.values;
    return level;
  }

  // Swaps the halves of level 0 for the picture's bytes and the table that decodes them.
  static void use_bytes(MipMap& map, const Image& image, const MipMapOptions& options) {
    MipMap::Level& level = map.levels_[0];
    level.storage = MipMap::Storage::Bytes;
    level.halves = {};
    level.bytes = image_bytes(image, map.channels_, options.flip);
    for (int i = 0; i < 256; ++i) {
      const float v = static_cast<float>(i) / 255;
      map.byte_values_[i] = options.scale * (options.gamma ? srgb_decode(v) : v);
    }
  }
};

MipMap::MipMap(const Image& image, const MipMapOptions& options) : wrap_(options.wrap) {
  // Halves store the unscaled values, so that no scale can drive them out of range. A negative scale meets
  // the clamp of the resampling, so there the scale has to come first.
  bool as_half = image.format != SampleFormat::Float && options.scale >= 0;
  Texels texels = make_texels(image, options.single, options.gamma, as_half ? 1 : options.scale, options.flip);
  const bool grey = image.rgb_channels()[0] == image.rgb_channels()[1];
  const bool own_bytes = as_half && image.format == SampleFormat::UInt8 && (grey || !options.single) &&
                         is_power_of_two(image.width) && is_power_of_two(image.height);
  texels = resample_to_power_of_two(std::move(texels), options.wrap);
  if (as_half && !fits_half(texels)) {
    as_half = false;
    for (float& v : texels.values) v *= options.scale;
  }
  channels_ = texels.channels;
  gain_ = as_half ? options.scale : 1;
  for (;;) {
    levels_.push_back(MipMapBuilder::store(texels, as_half));
    if (levels_.size() == 1 && own_bytes) MipMapBuilder::use_bytes(*this, image, options);
    if (texels.width == 1 && texels.height == 1) break;
    texels = halve(texels, options.wrap);
  }
}

size_t MipMap::bytes() const {
  size_t sum = 0;
  for (const Level& level : levels_)
    sum += level.bytes.size() + level.halves.size() * sizeof(Imath::half) + level.floats.size() * sizeof(float);
  return sum;
}

}  // namespace whit
