#include "core/image/texels.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <utility>

#include "core/base/plain_text.h"
#include "core/base/vec.h"
#include "core/batch/lanes.h"

namespace whit {
namespace {

constexpr float kRadius = 2;

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
  if (wrap == WrapMode::Mirror) {
    const int twice = ((i % (2 * n)) + 2 * n) % (2 * n);
    return std::min(twice, 2 * n - 1 - twice);
  }
  return i >= 0 && i < n ? i : -1;
}

constexpr size_t area(int width, int height) { return static_cast<size_t>(width) * static_cast<size_t>(height); }

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
  // pbrt-v3 and glTF do not look at it, so a PNG of another name, or of none, must not depend on it either.
  if (info.metadata.count("png:gAMA")) return true;
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

TexelRows::TexelRows(const ImageInfo& image, Take take, bool gamma, float scale)
    : width_(image.width), pixel_(image.channels), gamma_(gamma), scale_(scale) {
  const std::vector<int> rgb = image.rgb_channels();
  std::copy_n(rgb.begin(), 3, rgb_.begin());
  if (take == Take::Alpha) {
    one_everywhere_ = image.alpha_channel() < 0;
    rgb_.fill(std::max(0, image.alpha_channel()));
  }
  grey_ = rgb[0] == rgb[1] && rgb[1] == rgb[2];
  channels_ = take != Take::Rgb || grey_ ? 1 : 3;
  of_byte_ = byte_values(gamma);
  for (float& v : of_byte_) v *= scale;
  for (int i = 0; i < 256; ++i) of_grey_[i] = decode(luminance(RGB(byte_value(static_cast<uint8_t>(i)))));
}

template <class Number, class Out, class Value, class Luminance>
void TexelRows::select(const Number* p, Out* to, const Value& value, const Luminance& luminance_of) const {
  const auto [r, g, b] = rgb_;
  if (grey_) {
    for_lanes(width_, [&, n = pixel_, first = r](int x) { to[x] = value(p[x * n + first]); });
  } else if (channels_ == 1) {
    for (int x = 0; x < width_; ++x, p += pixel_) to[x] = luminance_of(p[r], p[g], p[b]);
  } else if (pixel_ == 3 && r == 0 && g == 1 && b == 2) {
    for_lanes(3 * width_, [&](int i) { to[i] = value(p[i]); });
  } else {
    for (int x = 0; x < width_; ++x, p += pixel_, to += 3)
      to[0] = value(p[r]), to[1] = value(p[g]), to[2] = value(p[b]);
  }
}

// The luminance is of undecoded numbers. Most pictures for numbers are grey, whatever they are stored as.
void TexelRows::convert(const uint8_t* pixels, float* texels) const {
  if (one_everywhere_) return static_cast<void>(std::fill_n(texels, width_, decode(1)));
  select(
      pixels, texels, [table = of_byte_.data()](uint8_t v) { return table[v]; },
      [this](uint8_t r, uint8_t g, uint8_t b) {
        return r == g && g == b ? of_grey_[r] : decode(luminance(RGB(byte_value(r), byte_value(g), byte_value(b))));
      });
}

void TexelRows::convert(const float* pixels, float* texels) const {
  if (one_everywhere_) return static_cast<void>(std::fill_n(texels, width_, decode(1)));
  select(
      pixels, texels, [this](float v) { return decode(v); },
      [this](float r, float g, float b) { return decode(luminance(RGB(r, g, b))); });
}

void TexelRows::pick(const uint8_t* pixels, uint8_t* numbers) const {
  if (one_everywhere_) return static_cast<void>(std::fill_n(numbers, width_, uint8_t{255}));
  const auto same = [](uint8_t v) { return v; };
  select(pixels, numbers, same, [](uint8_t r, uint8_t, uint8_t) { return r; });
}

Texels make_texels(const Image& image, bool single, bool gamma, float scale, bool flip) {
  const TexelRows rows(image, single ? TexelRows::Take::Luminance : TexelRows::Take::Rgb, gamma, scale);
  Texels out{image.width, image.height, rows.channels(), {}};
  const size_t row = area(out.width, out.channels);
  out.values.resize(row * image.height);
  tbb::parallel_for(0, image.height, [&](int t) {
    rows.convert(image.pixel(0, flip ? image.height - 1 - t : t), out.values.data() + row * t);
  });
  return out;
}

EnlargedRows::EnlargedRows(int width, int height, int channels, WrapMode wrap, std::function<void(int, float*)> row)
    : channels_(channels), row_(std::move(row)), narrow_(area(width, channels)) {
  const auto enlarged = [](int n) { return static_cast<int>(std::bit_ceil(static_cast<unsigned>(n))); };
  s_taps_ = taps(width, enlarged(width), wrap_along_s(wrap));
  t_taps_ = taps(height, enlarged(height), wrap_along_t(wrap));
  for (std::vector<float>& w : wide_) w.resize(s_taps_.size() * channels);
}

std::vector<EnlargedRows::Taps> EnlargedRows::taps(int old_size, int new_size, WrapMode wrap) {
  std::vector<Taps> taps(static_cast<size_t>(new_size));
  for (int i = 0; i < new_size; ++i) {
    const float center = (static_cast<float>(i) + 0.5f) * static_cast<float>(old_size) / static_cast<float>(new_size);
    Taps& t = taps[static_cast<size_t>(i)];
    t.first = static_cast<int>(std::floor(center - kRadius + 0.5f));
    float sum = 0;
    for (int j = 0; j < kTaps; ++j) {
      t.index[j] = wrap_index(t.first + j, old_size, wrap);
      t.weight[j] = lanczos((static_cast<float>(t.first + j) + 0.5f - center) / kRadius, 2);
      sum += t.weight[j];
    }
    for (float& w : t.weight) w *= 1 / sum;  // normalised before wrapping: black borders darken
  }
  return taps;
}

template <int kChannels>
void EnlargedRows::widen(const float* from, float* to) const {
  for (const Taps& t : s_taps_) {
    float sum[kChannels] = {};
    for (int j = 0; j < kTaps; ++j) {
      if (t.index[j] < 0) continue;
      const float* const texel = from + t.index[j] * kChannels;
      for (int c = 0; c < kChannels; ++c) sum[c] += t.weight[j] * texel[c];
    }
    to = std::copy_n(sum, kChannels, to);
  }
}

const float* EnlargedRows::wide_row(const Taps& taps, int j) {
  const size_t place = static_cast<size_t>(taps.first + j) % kTaps;
  if (std::exchange(number_[place], taps.index[j]) != taps.index[j]) {
    row_(taps.index[j], narrow_.data());
    if (channels_ == 1) widen<1>(narrow_.data(), wide_[place].data());
    else widen<3>(narrow_.data(), wide_[place].data());
  }
  return wide_[place].data();
}

void EnlargedRows::make(int t, float* to) {
  const size_t n = s_taps_.size() * channels_;
  std::fill_n(to, n, 0.0f);
  const Taps& taps = t_taps_[static_cast<size_t>(t)];
  for (int j = 0; j < kTaps; ++j) {
    if (taps.index[j] < 0) continue;
    const float* const from = wide_row(taps, j);
    const float weight = taps.weight[j];
    for (size_t i = 0; i < n; ++i) to[i] += weight * from[i];
  }
  for (size_t i = 0; i < n; ++i) to[i] = std::max(to[i], 0.0f);
}

Texels resample_to_power_of_two(Texels in, WrapMode wrap) {
  if (is_power_of_two(in.width) && is_power_of_two(in.height)) return in;
  const size_t in_row = area(in.width, in.channels);
  const auto row = [&](int t, float* to) { std::copy_n(in.values.data() + in_row * t, in_row, to); };
  const EnlargedRows plan(in.width, in.height, in.channels, wrap, row);
  Texels out{plan.width(), plan.height(), in.channels, {}};
  const size_t out_row = area(out.width, out.channels);
  out.values.resize(out_row * out.height);
  constexpr int kRowsAtATime = 64;
  tbb::parallel_for(tbb::blocked_range<int>(0, out.height, kRowsAtATime), [&](const tbb::blocked_range<int>& range) {
    EnlargedRows rows = plan;
    for (int t = range.begin(); t < range.end(); ++t) rows.make(t, out.values.data() + out_row * t);
  });
  return out;
}

}  // namespace whit
