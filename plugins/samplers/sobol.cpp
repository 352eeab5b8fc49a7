// The Sobol sequence with nested uniform (Owen) scrambling; the default. Positions on the film come from one (0,2)
// sequence over blocks of 256 x 256 pixels, so that samples are evenly spread across the borders of pixels too, which
// filters wider than a pixel see; further dimensions are pairs of SobolSampler's. Sources: Sobol 1967; Grünschloß,
// Raab, Keller, Enumerating Quasi-Monte Carlo Point Sequences in Elementary Intervals, 2010; Burley, JCGT 9(4), 2020;
// Ahmed and Wonka, Screen-Space Blue-Noise Diffusion of Monte Carlo Sampling Error via Hierarchical Ordering of Pixels,
// 2020, on sequences over the film.

#include "core/base/sobol.h"

#include <algorithm>

#include "core/plugin/registry.h"
#include "plugins/shared/sobol_sampler.h"

namespace whit {
namespace {

class Sobol final : public SobolSampler {
 public:
  /// The sample-th point of the sequence that falls into the pixel: 2^m samples from a multiple of 2^m on, of all pixels
  /// of the block, are points that follow each other from a multiple of 2^(16 + m) on, and so a net over the block.
  void pixel_offset(const SampleKeys& keys, float* u, float* v) const override {
    const uint32_t base = mix32(seed ^ 0x46696c6du);
    for_lanes(keys.n, [=, px = keys.px, py = keys.py, sample = keys.index](int i) {
      const auto x = static_cast<uint32_t>(px[i]), y = static_cast<uint32_t>(py[i]);
      const uint32_t block = hash_combine(hash_combine(base, x >> 8), y >> 8);
      const uint32_t turn = sample[i] >> 16;  // The sequence, 2^32 points long, begins anew after so many samples.
      const uint32_t index = film_index((x ^ block) & 255u, (y ^ (block >> 8)) & 255u, sample[i] & 0xffffu);
      // The pixel's column and row are the first eight digits of the nested scrambles, so they choose those of the rest.
      u[i] = owen_base2(index >> 8, hash_combine(block ^ turn, 2 * (x & 255u)));
      v[i] = owen_base2(sobol_second(index) >> 8, hash_combine(block ^ turn, 2 * (y & 255u) + 1));
    });
  }

 private:
  /// The number of the sample-th point that falls into a pixel of the block. A point's column is the lowest byte of its
  /// number, reversed; its row the lowest byte of the second dimension's word, reversed, which is sobol_second() of all
  /// four bytes' sum: so the second byte follows from the others.
  static uint32_t film_index(uint32_t column, uint32_t row, uint32_t sample) {
    const uint32_t first = reverse_bits(column) >> 24;
    const uint32_t sum = sobol_second(reverse_bits(row) >> 24);
    const uint32_t second = sum ^ first ^ (sample & 255u) ^ (sample >> 8);
    return first | (second << 8) | (sample << 16);
  }
};

const Register<Sobol> sobol{"sobol", "Scrambled Sobol points: the film and every pair of dimensions evenly covered.",
                            pixelsamples_param("Samples per pixel.")};

}  // namespace
}  // namespace whit
