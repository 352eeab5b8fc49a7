// What the samplers share that take their points from a (0,2)-sequence: sobol, 02sequence and maxmindist.
#pragma once

#include "core/plugin/sampler.h"

namespace whit {

/// Numbers of samples per pixel are powers of two. Every pair of dimensions is a net of its own, scrambled anew for
/// every pixel, pair and branch, and the sample numbers are shuffled so that the pairs combine at random (padding): each
/// pair has the quality of the first two Sobol dimensions, whatever its number. Source: Burley, Practical Hash-based Owen
/// Scrambling, JCGT 9(4), 2020.
class SobolSampler : public Sampler {
 public:
  int pixel_samples = 16;

  void check(Diagnostics& diagnostics, SourcePos statement) override;
  int samples_per_pixel() const override { return pixel_samples; }
  int set_samples_per_pixel(int n) override;

  void get_1d(const SampleKeys& keys, int dimension, float* u) const override;
  void get_2d(const SampleKeys& keys, int dimension, float* u, float* v) const override;

 protected:
  static constexpr int kMaxSamples = 1 << 30;
  static constexpr int kBlock = 256;

  /// Keys and shuffled sample numbers of the lanes [first, first + n), n <= kBlock; `purpose` tells uses apart.
  void begin(const SampleKeys& keys, int first, int n, uint32_t purpose, uint32_t* key, uint32_t* index) const;
};

/// The parameter all of them have.
inline auto pixelsamples_param() {
  return param(&SobolSampler::pixel_samples, "pixelsamples", 16, Unit::None,
               "Samples per pixel; rounded up to a power of two.", Range{1, 1 << 30});
}

}  // namespace whit
