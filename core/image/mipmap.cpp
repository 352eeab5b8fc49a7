// Building the pyramid; mipmap_lookup.cpp filters.
#include "core/image/mipmap.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
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

bool is_grey(const ImageInfo& image) { return image.rgb_channels()[0] == image.rgb_channels()[1]; }

// Whether level 0 can be the file's bytes: nothing is computed of them but one value each.
bool keeps_bytes(const ImageInfo& image, const MipMapOptions& options) {
  return image.format == SampleFormat::UInt8 && options.scale >= 0 && (is_grey(image) || !options.single) &&
         is_power_of_two(image.width) && is_power_of_two(image.height);
}

// The picture's colour channels, flipped as asked for.
auto colour_bytes(const ByteImage& image, int channels, bool flip) {
  const std::vector<int> rgb = image.rgb_channels();
  std::vector<uint8_t, PageAllocator<uint8_t>> bytes(static_cast<size_t>(image.width) * image.height * channels);
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
  if (keeps_bytes(image, options)) {
    channels_ = is_grey(image) ? 1 : 3;
    add_byte_levels(std::move(image), options);
    return;
  }
  const bool as_half = options.scale >= 0;
  Texels texels = make_texels(image, options.single, options.gamma, as_half ? 1 : options.scale, options.flip);
  image.pixels = {};
  add_levels(resample_to_power_of_two(std::move(texels), wrap_), as_half, options.scale);
}

// The picture's own bytes, with the table that decodes them, and what is coarser in halves.
void MipMap::add_byte_levels(ByteImage image, const MipMapOptions& options) {
  const auto finest = std::make_shared<Level>();
  levels_.push_back(finest);
  finest->width = image.width;
  finest->height = image.height;
  finest->storage = Storage::Bytes;
  finest->bytes = colour_bytes(image, channels_, options.flip);
  image.pixels = {};
  const std::array<float, 256> values = byte_values(options.gamma);
  std::transform(values.begin(), values.end(), byte_values_.begin(), [&](float v) { return options.scale * v; });
  if (finest->width == 1 && finest->height == 1) return;
  const auto value = [&values, bytes = finest->bytes.data()](size_t i) { return values[bytes[i]]; };
  add_levels(halve(finest->width, finest->height, channels_, wrap_, value), true, options.scale);
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
    const auto level = std::make_shared<Level>();
    levels_.push_back(level);
    level->width = texels.width;
    level->height = texels.height;
    level->storage = as_half ? Storage::Halves : Storage::Floats;
    const bool last = texels.width == 1 && texels.height == 1;
    Texels coarser = last ? Texels{} : halve(texels, wrap_);
    if (as_half) {
      level->halves.reserve(texels.values.size() + 1);  // lookups read a texel of three as four
      level->halves.assign(texels.values.begin(), texels.values.end());
    } else {
      level->floats = std::move(texels.values);
    }
    if (last) return;
    texels = std::move(coarser);
  }
}

MipMap::MipMap(const MipMap& whole, int first) : MipMap(whole) {
  first_ = first;
  for (int i = 0; i < first; ++i) {
    const auto gone = std::make_shared<Level>();
    gone->width = width(i);
    gone->height = height(i);
    levels_[i] = gone;
  }
}

size_t MipMap::bytes_to_build(const ImageInfo& image, const MipMapOptions& options) {
  const auto area = [](auto w, auto h) { return static_cast<size_t>(w) * static_cast<size_t>(h); };
  const size_t pixels = area(image.width, image.height), channels = options.single || is_grey(image) ? 1 : 3;
  const size_t read = pixels * image.channels * (image.format == SampleFormat::UInt8 ? 1 : sizeof(float));
  // The file's bytes and level 0; later level 0, two levels in floats, and the halves of one.
  if (keeps_bytes(image, options)) return std::max(read + channels * pixels, 3 * channels * pixels);
  // The picture and its texels; later those and what they are resampled to, or the next level and the halves of both.
  const size_t texels = area(std::bit_ceil(unsigned(image.width)), std::bit_ceil(unsigned(image.height)));
  return sizeof(float) * channels * std::max(pixels, 2 * texels) + read;
}

size_t MipMap::bytes() const {
  size_t sum = 0;
  for (const auto& level : levels_)
    sum += level->bytes.size() + level->halves.size() * sizeof(Imath::half) + level->floats.size() * sizeof(float);
  return sum;
}

}  // namespace whit
