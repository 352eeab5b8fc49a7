#include "plugins/shared/sobol_sampler.h"

#include <algorithm>
#include <bit>

#include "core/base/sobol.h"

namespace whit {

/// Rounds up, silently: pbrt-v3 warns, but scenes made for it are full of such numbers, and nothing is wrong with them.
void SobolSampler::check(Diagnostics&, SourcePos) { set_samples_per_pixel(pixel_samples); }

int SobolSampler::set_samples_per_pixel(int n) {
  return pixel_samples = static_cast<int>(std::bit_ceil(static_cast<uint32_t>(std::clamp(n, 1, kMaxSamples))));
}

void SobolSampler::begin(const SampleKeys& keys, int first, int n, uint32_t purpose, uint32_t* key,
                         uint32_t* index) const {
  const uint32_t base = hash_combine(mix32(seed ^ 0x536f626fu), purpose);
  const int32_t *px = keys.px + first, *py = keys.py + first;
  const uint32_t *sample = keys.index + first, *stream = keys.stream + first;
  const int bits = bits_below(static_cast<uint32_t>(pixel_samples));
  const uint32_t mask = static_cast<uint32_t>(pixel_samples) - 1;
  for_lanes(n, [=](int i) {
    key[i] = hash_combine(pixel_key(base, px[i], py[i]), stream[i]);
    // The mask is for one sample, whose number has no bit to permute.
    index[i] = permute_bits(sample[i] & mask, bits, key[i]) & mask;
  });
}

void SobolSampler::get_1d(const SampleKeys& keys, int dimension, float* u) const {
  alignas(64) uint32_t key[kBlock], index[kBlock];
  for (int first = 0; first < keys.n; first += kBlock) {
    const int n = std::min(kBlock, keys.n - first);
    begin(keys, first, n, 2 * static_cast<uint32_t>(dimension) + 1, key, index);
    float* const out = u + first;
    for_lanes(n, [&](int i) { out[i] = sobol_x(index[i], key[i]); });
  }
}

void SobolSampler::get_2d(const SampleKeys& keys, int dimension, float* u, float* v) const {
  alignas(64) uint32_t key[kBlock], index[kBlock];
  for (int first = 0; first < keys.n; first += kBlock) {
    const int n = std::min(kBlock, keys.n - first);
    begin(keys, first, n, 2 * static_cast<uint32_t>(dimension), key, index);
    float *const x = u + first, *const y = v + first;
    for_lanes(n, [&](int i) {
      x[i] = sobol_x(index[i], key[i]);
      y[i] = sobol_y(index[i], mix32(key[i] ^ 0x79u));
    });
  }
}

}  // namespace whit
