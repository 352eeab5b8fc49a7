// Building the pyramid; mipmap_lookup.cpp filters.
#include "core/image/mipmap.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace whit {
namespace {

// The coarser level of one whose numbers are value(0), value(1), ...: each texel the mean of four. A side that is 1
// already takes texel 1 from outside: the same texel again when the texture repeats or clamps, nothing when it is
// black there (as in pbrt-v3).
template <class Value>
Texels halve(int width, int height, int channels, WrapMode wrap, const Value& value) {
  Texels out{std::max(1, width / 2), std::max(1, height / 2), channels, {}};
  out.values.resize(static_cast<size_t>(out.width) * out.height * channels);
  const size_t texel = static_cast<size_t>(channels), row = texel * width;
  const size_t right = width > 1 ? texel : 0, below = height > 1 ? row : 0;
  const bool has_right = right > 0 || wrap != WrapMode::Black, has_below = below > 0 || wrap != WrapMode::Black;
  tbb::parallel_for(0, out.height, [&](int t) {
    float* to = out.values.data() + static_cast<size_t>(t) * out.width * texel;
    for (int s = 0; s < out.width; ++s) {
      const size_t first = 2 * t * row + 2 * s * texel;
      for (size_t i = first; i < first + texel; ++i) {
        float sum = value(i);
        if (has_right) sum += value(i + right);
        if (has_below) sum += value(i + below);
        if (has_right && has_below) sum += value(i + right + below);
        *to++ = 0.25f * sum;
      }
    }
  });
  return out;
}

Texels halve(const Texels& fine, WrapMode wrap) {
  return halve(fine.width, fine.height, fine.channels, wrap, [v = fine.values.data()](size_t i) { return v[i]; });
}

bool fits_half(const Texels& texels) {
  return std::all_of(texels.values.begin(), texels.values.end(), [](float v) { return std::abs(v) <= 65504.0f; });
}

// The picture's colour channels, flipped as asked for.
std::vector<uint8_t> colour_bytes(const ByteImage& image, int channels, bool flip) {
  const std::vector<int> rgb = image.rgb_channels();
  std::vector<uint8_t> bytes(static_cast<size_t>(image.width) * image.height * channels);
  uint8_t* to = bytes.data();
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const uint8_t* p = image.pixel(x, flip ? image.height - 1 - y : y);
      for (int c = 0; c < channels; ++c) *to++ = p[rgb[c]];
    }
  return bytes;
}

}  // namespace

MipMap::MipMap(Image image, const MipMapOptions& options) : wrap_(options.wrap) {
  // Halves store the unscaled values, so that no scale can drive them out of range. A negative scale meets
  // the clamp of the resampling, so there the scale has to come first.
  const bool as_half = image.format != SampleFormat::Float && options.scale >= 0;
  Texels texels = make_texels(image, options.single, options.gamma, as_half ? 1 : options.scale, options.flip);
  image.pixels = {};
  add_levels(resample_to_power_of_two(std::move(texels), wrap_), as_half, options.scale);
}

MipMap::MipMap(ByteImage image, const MipMapOptions& options) : wrap_(options.wrap) {
  const bool as_half = options.scale >= 0;
  const bool grey = image.rgb_channels()[0] == image.rgb_channels()[1];
  if (as_half && (grey || !options.single) && is_power_of_two(image.width) && is_power_of_two(image.height)) {
    channels_ = grey ? 1 : 3;
    add_byte_levels(std::move(image), options);
    return;
  }
  Texels texels = make_texels(image, options.single, options.gamma, as_half ? 1 : options.scale, options.flip);
  image.pixels = {};
  add_levels(resample_to_power_of_two(std::move(texels), wrap_), as_half, options.scale);
}

// The picture's own bytes, with the table that decodes them, and what is coarser in halves.
void MipMap::add_byte_levels(ByteImage image, const MipMapOptions& options) {
  Level& finest = levels_.emplace_back();
  finest.width = image.width;
  finest.height = image.height;
  finest.storage = Storage::Bytes;
  finest.bytes = colour_bytes(image, channels_, options.flip);
  image.pixels = {};
  const std::array<float, 256> values = byte_values(options.gamma);
  std::transform(values.begin(), values.end(), byte_values_.begin(), [&](float v) { return options.scale * v; });
  if (finest.width == 1 && finest.height == 1) return;
  const auto value = [&values, bytes = finest.bytes.data()](size_t i) { return values[bytes[i]]; };
  add_levels(halve(finest.width, finest.height, channels_, wrap_, value), true, options.scale);
}

// `texels` and all that are coarser, as halves where wanted and possible: then the scale is still to be applied.
void MipMap::add_levels(Texels texels, bool as_half, float scale) {
  if (as_half && !fits_half(texels)) {
    as_half = false;
    for (float& v : texels.values) v *= scale;
  }
  channels_ = texels.channels;
  gain_ = as_half ? scale : 1;
  for (;;) {
    Level& level = levels_.emplace_back();
    level.width = texels.width;
    level.height = texels.height;
    level.storage = as_half ? Storage::Halves : Storage::Floats;
    const bool last = texels.width == 1 && texels.height == 1;
    Texels coarser = last ? Texels{} : halve(texels, wrap_);
    if (as_half) level.halves.assign(texels.values.begin(), texels.values.end());
    else level.floats = std::move(texels.values);
    if (last) return;
    texels = std::move(coarser);
  }
}

size_t MipMap::bytes() const {
  size_t sum = 0;
  for (const Level& level : levels_)
    sum += level.bytes.size() + level.halves.size() * sizeof(Imath::half) + level.floats.size() * sizeof(float);
  return sum;
}

}  // namespace whit
