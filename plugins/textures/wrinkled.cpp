// Octaves of the absolute value of noise, whose creases look like wrinkles. Never negative. Source: PBR book, 3rd ed.,
// 10.6.3, after Perlin 1985.
#include "plugins/shared/texture_noise.h"

namespace whit {
namespace {

template <class T>
class Wrinkled final : public GreyNoise<T> {
 public:
  int octaves = 8;
  float roughness = 0.5f;

 private:
  void value(const NoisePoints& points, Arena&, float* out) const override {
    turbulence(points, 1, octaves, roughness, out);
  }
};

constexpr const char* kDoc = "A sum of octaves of the absolute value of noise.";

const Register<Wrinkled<float>> wrinkled_float{"wrinkled", kDoc, octaves_param(&Wrinkled<float>::octaves),
                                               roughness_param(&Wrinkled<float>::roughness)};
const Register<Wrinkled<RGB>> wrinkled_spectrum{"wrinkled", kDoc, octaves_param(&Wrinkled<RGB>::octaves),
                                                roughness_param(&Wrinkled<RGB>::roughness)};

}  // namespace
}  // namespace whit
