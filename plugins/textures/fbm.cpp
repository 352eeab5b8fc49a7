// Fractional Brownian motion: octaves of noise that grow weaker as they grow finer. It is not limited to [0, 1], and may
// be negative. Source: PBR book, 3rd ed., 10.6.3.
#include "plugins/shared/texture_noise.h"

namespace whit {
namespace {

template <class T>
class Fbm final : public GreyNoise<T> {
 public:
  int octaves = 8;
  float roughness = 0.5f;

 private:
  void value(const NoisePoints& points, Arena&, float* out) const override { fbm(points, 1, octaves, roughness, out); }
};

constexpr const char* kDoc = "Fractional Brownian motion: a sum of octaves of noise.";

const Register<Fbm<float>> fbm_float{"fbm", kDoc, octaves_param(&Fbm<float>::octaves),
                                     roughness_param(&Fbm<float>::roughness)};
const Register<Fbm<RGB>> fbm_spectrum{"fbm", kDoc, octaves_param(&Fbm<RGB>::octaves),
                                      roughness_param(&Fbm<RGB>::roughness)};

}  // namespace
}  // namespace whit
