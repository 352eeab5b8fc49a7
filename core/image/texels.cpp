#include "core/image/texels.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "core/base/vec.h"

namespace whit {
namespace {

constexpr int kTaps = 4;
constexpr float kRadius = 2;

// The four texels that make a new one, their wrapped indices and weights; index -1 contributes nothing.
struct Taps {
  std::array<int, kTaps> index;
  std::array<float, kTaps> weight;
};

// sinc(x) windowed by sinc(x / tau), x in units of the filter's radius.
float lanczos(float x, float tau) {
  x = std::abs(x);
  if (x < 1e-5f) return 1;
  if (x > 1) return 0;
  x *= std::numbers::pi_v<float>;
  return std::sin(x * tau) / (x * tau) * (std::sin(x) / x);
}

int wrap_index(int i, int n, WrapMode wrap) {
  if (wrap == WrapMode::Repeat) return ((i % n) + n) % n;
  if (wrap == WrapMode::Clamp) return std::clamp(i, 0, n - 1);
  return i >= 0 && i < n ? i : -1;
}

std::vector<Taps> resample_taps(int old_size, int new_size, WrapMode wrap) {
  std::vector<Taps> taps(static_cast<size_t>(new_size));
  for (int i = 0; i < new_size; ++i) {
    const float center = (static_cast<float>(i) + 0.5f) * static_cast<float>(old_size) / static_cast<float>(new_size);
    const int first = static_cast<int>(std::floor(center - kRadius + 0.5f));
    Taps& t = taps[static_cast<size_t>(i)];
    float sum = 0;
    for (int j = 0; j < kTaps; ++j) {
      t.index[j] = wrap_index(first + j, old_size, wrap);
      t.weight[j] = lanczos((static_cast<float>(first + j) + 0.5f - center) / kRadius, 2);
      sum += t.weight[j];
    }
    for (float& w : t.weight) w *= 1 / sum;  // normalised before wrapping: black borders darken
  }
  return taps;
}

// Each line of `count` texels, `step` floats apart, becomes a line of taps.size() texels.
void resample_line(const float* in, size_t in_step, float* out, size_t out_step, int channels,
                   const std::vector<Taps>& taps) {
  for (size_t i = 0; i < taps.size(); ++i)
    for (int c = 0; c < channels; ++c) {
      float sum = 0;
      for (int j = 0; j < kTaps; ++j)
        if (taps[i].index[j] >= 0) sum += taps[i].weight[j] * in[static_cast<size_t>(taps[i].index[j]) * in_step + c];
      out[i * out_step + c] = sum;
    }
}

// The channels that make the texels, each number taken through `value`; where they are weighed into a luminance, which
// is of undecoded numbers, through `raw` before that and `decode` after.
template <class Number, class Value, class Raw, class Decode>
Texels select(const PixelArray<Number>& image, bool single, bool flip, const Value& value, const Raw& raw,
              const Decode& decode) {
  const std::vector<int> rgb = image.rgb_channels();
  const bool grey = rgb[0] == rgb[1] && rgb[1] == rgb[2];
  Texels out{image.width, image.height, single || grey ? 1 : 3, {}};
  out.values.resize(static_cast<size_t>(out.width) * out.height * out.channels);
  tbb::parallel_for(0, image.height, [&](int y) {
    float* texel = out.values.data() + static_cast<size_t>(y) * out.width * out.channels;
    for (int x = 0; x < image.width; ++x) {
      const Number* p = image.pixel(x, flip ? image.height - 1 - y : y);
      if (grey) *texel++ = value(p[rgb[0]]);
      else if (single) *texel++ = decode(luminance(RGB(raw(p[rgb[0]]), raw(p[rgb[1]]), raw(p[rgb[2]]))));
      else
        for (int c : rgb) *texel++ = value(p[c]);
    }
  });
  return out;
}

std::string lower_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

float byte_value(uint8_t v) { return static_cast<float>(v) / 255; }

}  // namespace

float srgb_decode(float v) { return v <= 0.04045f ? v * (1 / 12.92f) : std::pow((v + 0.055f) * (1 / 1.055f), 2.4f); }

std::array<float, 256> byte_values(bool gamma) {
  std::array<float, 256> values;
  for (int i = 0; i < 256; ++i) {
    const float v = byte_value(static_cast<uint8_t>(i));
    values[i] = gamma ? srgb_decode(v) : v;
  }
  return values;
}

bool default_gamma(const std::string& path, const ImageInfo& info) {
  const std::string extension = lower_case(std::filesystem::path(path).extension().string());
  if (extension == ".png" || extension == ".tga") return true;
  if (info.format == SampleFormat::Half || info.format == SampleFormat::Float) return false;
  // Of all names of colour spaces, those with a linear scale have it in their name; the curves of the others (Rec709 of
  // .ppm files, Adobe RGB, Display P3) are nearer to sRGB's than to none.
  for (const char* entry : {"ICCProfile:profile_description", "oiio:ColorSpace"}) {
    const auto said = info.metadata.find(entry);
    if (said != info.metadata.end() && !said->second.empty())
      return lower_case(said->second).find("linear") == std::string::npos;
  }
  return info.format == SampleFormat::UInt8;
}

Texels make_texels(const Image& image, bool single, bool gamma, float scale, bool flip) {
  const auto decode = [=](float v) { return scale * (gamma ? srgb_decode(v) : v); };
  return select(
      image, single, flip, decode, [](float v) { return v; }, decode);
}

Texels make_texels(const ByteImage& image, bool single, bool gamma, float scale, bool flip) {
  std::array<float, 256> values = byte_values(gamma);
  for (float& v : values) v *= scale;
  return select(
      image, single, flip, [&](uint8_t v) { return values[v]; }, byte_value,
      [=](float v) { return scale * (gamma ? srgb_decode(v) : v); });
}

Texels resample_to_power_of_two(Texels in, WrapMode wrap) {
  if (is_power_of_two(in.width) && is_power_of_two(in.height)) return in;
  const int c = in.channels;
  Texels out{static_cast<int>(std::bit_ceil(static_cast<unsigned>(in.width))),
             static_cast<int>(std::bit_ceil(static_cast<unsigned>(in.height))),
             c,
             {}};
  const size_t in_row = static_cast<size_t>(in.width) * c, out_row = static_cast<size_t>(out.width) * c;

  std::vector<float> wide(out_row * static_cast<size_t>(in.height));
  const std::vector<Taps> s_taps = resample_taps(in.width, out.width, wrap_along_s(wrap));
  tbb::parallel_for(0, in.height, [&](int t) {
    resample_line(in.values.data() + in_row * t, c, wide.data() + out_row * t, c, c, s_taps);
  });
  in.values = {};

  out.values.resize(out_row * static_cast<size_t>(out.height));
  const std::vector<Taps> t_taps = resample_taps(in.height, out.height, wrap_along_t(wrap));
  tbb::parallel_for(0, out.width, [&](int s) {
    resample_line(wide.data() + static_cast<size_t>(s) * c, out_row, out.values.data() + static_cast<size_t>(s) * c,
                  out_row, c, t_taps);
  });
  tbb::parallel_for(size_t{0}, static_cast<size_t>(out.height), [&](size_t t) {
    for (size_t i = t * out_row; i < (t + 1) * out_row; ++i) out.values[i] = std::max(out.values[i], 0.0f);
  });
  return out;
}

}  // namespace whit
