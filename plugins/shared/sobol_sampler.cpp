#include "plugins/shared/sobol_sampler.h"

#include <algorithm>
#include <bit>
#include <iterator>

#include "core/base/sobol.h"

namespace whit {

namespace {

/// The film's are the first two dimensions, whose sample numbers stay as they are. What the matrices of the next are
/// hashed from was found by search: of 40,000 candidates each is the one that goes best with the film and all before it,
/// by the exact variance of products of linear and of quadratic functions of two numbers, of 8 to 4096 samples, 16 above
/// all. The first six are those of even dimensions, where most pairs begin.
constexpr int kFilmDimensions = 2;
constexpr uint32_t kMatrices[] = {21608, 10726, 9108, 24886, 5507, 29013, 34400, 29655, 33947, 35187, 3068, 3045};

/// Replaces sample numbers by their products with a matrix of bits. Column j has ones in row j and, at random, above: so
/// a bit of the product depends on that bit and on more significant ones alone, as with shuffle_nested().
void multiply_bits(int n, uint32_t matrix, const uint32_t* sample, uint32_t* product) {
  uint32_t used = 0;
#pragma omp simd reduction(| : used)
  for (int i = 0; i < n; ++i) {
    product[i] = 0;
    used |= sample[i];
  }
  for (; used != 0; used &= used - 1) {
    const auto j = static_cast<uint32_t>(std::countr_zero(used));
    const uint32_t column = (1u << j) | (hash_combine(matrix, j) & ((1u << j) - 1));
    for_lanes(n, [=](int i) { product[i] ^= (0u - ((sample[i] >> j) & 1u)) & column; });
  }
}

}  // namespace

void SobolSampler::begin(const SampleKeys& keys, int first, int n, int dimension, bool pair, uint32_t* key,
                         uint32_t* index) const {
  const uint32_t purpose = 2 * static_cast<uint32_t>(dimension) + (pair ? 0 : 1);
  const uint32_t base = hash_combine(mix32(seed ^ 0x536f626fu), purpose);
  const int32_t *px = keys.px + first, *py = keys.py + first;
  const uint32_t *sample = keys.index + first, *stream = keys.stream + first;
  for_lanes(n, [=](int i) { key[i] = hash_combine(pixel_key(base, px[i], py[i]), stream[i]); });
  if (dimension < kFilmDimensions) {
    std::copy_n(sample, n, index);
  } else if (dimension < kFilmDimensions + static_cast<int>(std::size(kMatrices))) {
    multiply_bits(n, kMatrices[dimension - kFilmDimensions], sample, index);
  } else {
    // Another key than the scramble's, which would undo a part of the shuffle.
    for_lanes(n, [=](int i) { index[i] = shuffle_nested(sample[i], mix32(key[i] ^ 0x73687566u)); });
  }
}

void SobolSampler::get_1d(const SampleKeys& keys, int dimension, float* u) const {
  alignas(64) uint32_t key[kBlock], index[kBlock];
  for (int first = 0; first < keys.n; first += kBlock) {
    const int n = std::min(kBlock, keys.n - first);
    begin(keys, first, n, dimension, false, key, index);
    float* const out = u + first;
    for_lanes(n, [&](int i) { out[i] = sobol_x(index[i], key[i]); });
  }
}

void SobolSampler::get_2d(const SampleKeys& keys, int dimension, float* u, float* v) const {
  alignas(64) uint32_t key[kBlock], index[kBlock];
  for (int first = 0; first < keys.n; first += kBlock) {
    const int n = std::min(kBlock, keys.n - first);
    begin(keys, first, n, dimension, true, key, index);
    float *const x = u + first, *const y = v + first;
    for_lanes(n, [&](int i) {
      x[i] = sobol_x(index[i], key[i]);
      y[i] = sobol_y(index[i], mix32(key[i] ^ 0x79u));
    });
  }
}

}  // namespace whit
