// Samplers: stateless functions of (pixel, sample index, dimension), evaluated over batches.
#pragma once

#include <string>

#include "core/batch/lanes.h"
#include "core/plugin/param.h"

namespace whit {

/// Which samples numbers are wanted for.
struct SampleKeys {
  int n = 0;
  const int32_t *px = nullptr, *py = nullptr;  ///< Pixel.
  const uint32_t* index = nullptr;             ///< Sample number within the pixel: any, see Sampler::extends().
  const uint32_t* stream = nullptr;            ///< Branch of the ray tree: 0 at the camera; decorrelates branches.
};

/// Sample numbers may go on beyond samples_per_pixel(), so that a render can be extended with any sampler, and what it
/// adds is as good as what was there. There are two kinds:
///
/// - Those that extends() is true of are sequences. The numbers of sample i do not depend on samples_per_pixel(): 16
///   samples are the first 16 of 64. Every block of 2^m samples from a multiple of 2^m on is as good a set as the first.
/// - The others have sets of samples_per_pixel() samples, whose numbers depend on that. Samples beyond the first set
///   begin another, as good, and independent of the first where it is no complement of it.
class Sampler : public Plugin {
 public:
  static constexpr const char* kCategory = "sampler";
  uint32_t seed = 0;  ///< Set by the program before prepare().

  /// Samples per pixel, after the rounding the sampler needs (stratified, powers of two).
  virtual int samples_per_pixel() const = 0;
  /// Overrides the count (--spp); the sampler rounds as it must, in the same way whatever was set before. Returns the
  /// count it will use. To be prepared anew.
  virtual int set_samples_per_pixel(int n) = 0;
  /// Where samples_per_pixel() is not the count that the scene or set_samples_per_pixel() asked for: why, and what was
  /// asked ("maxmindist takes powers of two; 100 were asked for"). Otherwise empty.
  virtual std::string rounding() const { return {}; }
  /// Whether the samples are a sequence, which can be stopped and extended anywhere.
  virtual bool extends() const = 0;
  /// True when samples lie at the same place in every pixel, so that rays can be aimed exactly at vertices of a mesh.
  virtual bool is_regular() const { return false; }

  /// Numbers in [0,1) of one dimension, or of the pair (dimension, dimension + 1).
  virtual void get_1d(const SampleKeys& keys, int dimension, float* u) const = 0;
  virtual void get_2d(const SampleKeys& keys, int dimension, float* u, float* v) const = 0;

  /// Positions within the pixel, in [0,1)^2; by default dimensions 0 and 1.
  virtual void pixel_offset(const SampleKeys& keys, float* u, float* v) const { get_2d(keys, 0, u, v); }
};

}  // namespace whit
