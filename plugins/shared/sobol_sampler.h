// What the samplers share that take their points from a (0,2)-sequence: sobol, 02sequence and maxmindist.
#pragma once

#include <algorithm>

#include "core/plugin/sampler.h"

namespace whit {

/// Every pair of dimensions is a (0,2)-sequence of its own, scrambled anew for every pixel, pair and branch: each pair has
/// the quality of the first two Sobol dimensions, whatever its number. Which of its points goes with which of another
/// pair is settled so that every block of 2^m samples from a multiple of 2^m on is a net in every pair, and fills 2^m
/// strata of each dimension alone. Within that there are two ways:
///
/// - In the first dimensions each pair takes the sample numbers times a matrix of its own, so that numbers of different
///   pairs are evenly spread together too. Branches share the matrices: what they see is added, and never multiplied.
/// - In all others sample numbers are shuffled at random, in a nested way (padding). That has no such merit, and no limit.
///
/// Sources: Burley, Practical Hash-based Owen Scrambling, JCGT 9(4), 2020; Owen, Scrambled Net Variance for Integrals of
/// Smooth Functions, 1997, for the variance by which the matrices were chosen.
class SobolSampler : public Sampler {
 public:
  int pixel_samples = 16;

  int samples_per_pixel() const override { return pixel_samples; }
  int set_samples_per_pixel(int n) override { return pixel_samples = std::clamp(n, 1, kMaxSamples); }
  bool extends() const override { return true; }

  void get_1d(const SampleKeys& keys, int dimension, float* u) const override;
  void get_2d(const SampleKeys& keys, int dimension, float* u, float* v) const override;

 protected:
  static constexpr int kMaxSamples = 1 << 30;
  static constexpr int kBlock = 256;

  /// Keys and shuffled sample numbers of the lanes [first, first + n), n <= kBlock, for a number or a pair of numbers.
  void begin(const SampleKeys& keys, int first, int n, int dimension, bool pair, uint32_t* key, uint32_t* index) const;
};

/// The parameter all of them have.
inline auto pixelsamples_param(const char* help) {
  return param(&SobolSampler::pixel_samples, "pixelsamples", 16, Unit::None, help, Range{1, 1 << 30});
}

}  // namespace whit
