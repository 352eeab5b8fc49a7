// Halton points in bases 2 and 3 with nested uniform scrambling, drawn anew for every pixel, dimension and branch, the
// sample numbers shuffled so that different dimensions combine at random (padding). Every pair of numbers has the full
// quality of the first two Halton dimensions, whatever its dimension, so there is no dimension at which quality or
// tables end; what higher Halton bases would promise for more than two dimensions at once needs more samples than a
// pixel has. Sources: Halton 1960; Owen, Randomly Permuted (t,m,s)-Nets and (t,s)-Sequences, 1995; Burley, Practical
// Hash-based Owen Scrambling, JCGT 9(4), 2020.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/radical_inverse.h"
#include "core/plugin/registry.h"
#include "core/plugin/sampler.h"
#include "plugins/shared/sample_sets.h"

namespace whit {
namespace {

constexpr int kMaxSamples = 1 << 22;  // third_of() is exact up to here
constexpr int kBlock = 256;

class Halton final : public Sampler {
 public:
  int pixel_samples = 16;
  bool pixel_centre = false;

  int samples_per_pixel() const override { return pixel_samples; }
  int set_samples_per_pixel(int n) override { return asked_ = n, pixel_samples = std::clamp(n, 1, kMaxSamples); }
  std::string rounding() const override {
    return asked_ > kMaxSamples ? fmt::format("halton takes {} at most; {} were asked for", kMaxSamples, asked_) : "";
  }
  bool extends() const override { return false; }

  void get_1d(const SampleKeys& keys, int dimension, float* u) const override {
    uint32_t key[kBlock], index[kBlock];
    for (int first = 0; first < keys.n; first += kBlock) {
      const int n = std::min(kBlock, keys.n - first);
      begin(keys, first, n, 2 * static_cast<uint32_t>(dimension) + 1, key, index);
      float* out = u + first;
      for_lanes(n, [&](int i) { out[i] = owen_base2(index[i], key[i]); });
    }
  }

  void get_2d(const SampleKeys& keys, int dimension, float* u, float* v) const override {
    uint32_t key[kBlock], index[kBlock];
    for (int first = 0; first < keys.n; first += kBlock) {
      const int n = std::min(kBlock, keys.n - first);
      begin(keys, first, n, 2 * static_cast<uint32_t>(dimension), key, index);
      float* out = u + first;
      for_lanes(n, [&](int i) { out[i] = owen_base2(index[i], key[i]); });
      scramble_base3(n, key, index, v + first);
    }
  }

  /// Film positions come from one sequence over blocks of 128 x 243 pixels: they are evenly spread across the borders
  /// of pixels too, which filters wider than a pixel see (PBR 3e, section 7.4.1).
  void pixel_offset(const SampleKeys& keys, float* u, float* v) const override {
    if (pixel_centre) {
      for_lanes(keys.n, [=](int i) { u[i] = v[i] = 0.5f; });
      return;
    }
    uint32_t x_index[kBlock], y_index[kBlock];
    for (int first = 0; first < keys.n; first += kBlock) {
      const int n = std::min(kBlock, keys.n - first);
      film_indices(keys, first, n, x_index, y_index);
      float* x = u + first;
      for_lanes(n, [&](int i) { x[i] = unit_float(reverse_bits(x_index[i])); });
      reverse_base3_lanes(n, y_index, v + first);
    }
  }

 private:
  /// The numbers whose radical inverses in base 2 and 3 are the positions within the pixels. Another set of samples has
  /// those of pixels elsewhere.
  void film_indices(const SampleKeys& keys, int first, int n, uint32_t* x_index, uint32_t* y_index) const {
    const uint32_t shift_x = mix32(seed) & 127u, shift_y = mix32(seed) % 243u;
    const int32_t *px = keys.px + first, *py = keys.py + first;
    uint32_t shift[kBlock] = {}, sample[kBlock];
    split_sets(n, static_cast<uint32_t>(pixel_samples), keys.index + first, shift, sample);
    for_lanes(n, [&](int i) {
      // Pixels left of and above the picture count too (a wide filter's border): no negative remainders.
      const uint32_t x = (static_cast<uint32_t>(px[i]) + shift_x + shift[i]) & 127u;
      const uint32_t y = (static_cast<uint32_t>(py[i] + 243 * 256) + shift_y + (shift[i] >> 8)) % 243u;
      const uint32_t a = reverse_bits(x) >> 25, b = reverse_base3(y, 5);
      // The first sample that falls into this pixel of the block, by the Chinese remainder theorem:
      // 243 * 59 = 1 modulo 128, and 128 * 131 = 1 modulo 243.
      const uint32_t start = (a * (243u * 59u) + b * (128u * 131u)) % 31104u;
      x_index[i] = start / 128u + sample[i] * 243u;
      y_index[i] = start / 243u + sample[i] * 128u;
    });
  }

  /// Radical inverses in base 3, digit by digit over the block.
  void reverse_base3_lanes(int n, uint32_t* index, float* out) const {
    uint32_t value[kBlock] = {};
    const uint32_t most = 128 * (static_cast<uint32_t>(pixel_samples) + 1);
    const int digits = base3_digits(most);
    const auto take_digits = [&](const auto& third) {
      for (int d = 0; d < digits; ++d) {
        for_lanes(n, [&](int i) {
          const uint32_t rest = third(index[i]);
          value[i] = 3 * value[i] + (index[i] - 3 * rest);
          index[i] = rest;
        });
      }
    };
    if (most <= 1u << 22) take_digits([](uint32_t x) { return third_of(x); });
    else take_digits([](uint32_t x) { return x / 3u; });
    const auto width = static_cast<float>(1 / std::pow(3.0, digits));
    for_lanes(n, [&](int i) {
      const float b = static_cast<float>(value[i]) * width;
      out[i] = b < kBelowOne ? b : kBelowOne;
    });
  }

  /// Keys and shuffled sample numbers of n lanes; `purpose` tells dimensions apart.
  void begin(const SampleKeys& keys, int first, int n, uint32_t purpose, uint32_t* key, uint32_t* index) const {
    const uint32_t base = hash_combine(mix32(seed ^ 0x48616c74u), purpose);
    const int32_t *px = keys.px + first, *py = keys.py + first;
    const auto count = static_cast<uint32_t>(pixel_samples);
    const uint32_t* const stream = keys.stream + first;
    for_lanes(n, [=](int i) { key[i] = hash_combine(pixel_key(base, px[i], py[i]), stream[i]); });
    split_sets(n, count, keys.index + first, key, index);
    permute_lanes(
        n, count, [=](int i) { return key[i]; }, index);
  }

  /// The scrambled radical inverses in base 3: as many digits as the sample numbers have, and a random rest.
  void scramble_base3(int n, uint32_t* key, uint32_t* index, float* out) const {
    uint32_t value[kBlock] = {};
    for_lanes(n, [&](int i) { key[i] = hash_combine(key[i], 0x62617365u); });
    const int digits = base3_digits(static_cast<uint32_t>(pixel_samples));
    double cells = 1;
    for (int d = 0; d < digits; ++d, cells *= 3) {
      for_lanes(n, [&](int i) { owen_base3_digit(index[i], key[i], value[i]); });
    }
    const auto width = static_cast<float>(1 / cells);
    for_lanes(n, [&](int i) {
      const float position = static_cast<float>(static_cast<int32_t>(value[i])) + unit_float(key[i]);
      const float u = position * width;
      out[i] = u < kBelowOne ? u : kBelowOne;
    });
  }

  int asked_ = 0;  ///< The number of samples that has been set, if any.
};

const Register<Halton> halton{
    "halton", "Scrambled Halton points: evenly spread in every pixel, for every pair of dimensions.",
    param(&Halton::pixel_samples, "pixelsamples", 16, Unit::None, "Samples per pixel.", Range{1, kMaxSamples}),
    param(&Halton::pixel_centre, "samplepixelcenter", false, Unit::None,
          "Puts every camera sample at the centre of its pixel.")};

}  // namespace
}  // namespace whit
