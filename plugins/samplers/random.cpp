// Independent random numbers: a hash of pixel, sample number, dimension, branch and seed.
// The error falls as one over the square root of the number of samples, the slowest there is, but nothing correlates.

#include <algorithm>

#include "core/base/hash.h"
#include "core/plugin/registry.h"
#include "core/plugin/sampler.h"

namespace whit {
namespace {

constexpr int kMaxSamples = 1 << 30;

class Random final : public Sampler {
 public:
  int pixel_samples = 4;

  int samples_per_pixel() const override { return pixel_samples; }
  int set_samples_per_pixel(int n) override { return pixel_samples = std::clamp(n, 1, kMaxSamples); }
  bool extends() const override { return true; }

  void get_1d(const SampleKeys& keys, int dimension, float* u) const override {
    const uint32_t key = hash_combine(mix32(seed ^ 0x52616e64u), static_cast<uint32_t>(dimension));
    const int32_t *px = keys.px, *py = keys.py;
    const uint32_t *index = keys.index, *stream = keys.stream;
    for_lanes(keys.n, [=](int i) {
      u[i] = unit_float(hash_combine(hash_combine(pixel_key(key, px[i], py[i]), stream[i]), index[i]));
    });
  }

  void get_2d(const SampleKeys& keys, int dimension, float* u, float* v) const override {
    get_1d(keys, dimension, u);
    get_1d(keys, dimension + 1, v);
  }
};

const Register<Random> random_sampler{
    "random", "Independent random numbers.",
    param(&Random::pixel_samples, "pixelsamples", 4, Unit::None, "Samples per pixel.", Range{1, kMaxSamples})};

}  // namespace
}  // namespace whit
