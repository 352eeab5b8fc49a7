// Waves on water in a wind that is not the same everywhere: fine octaves of noise times the absolute value of coarse
// ones. Source: PBR book, 3rd ed., 10.6.4.
#include "plugins/shared/texture_noise.h"

namespace whit {
namespace {

template <class T>
class Windy final : public GreyNoise<T> {
 private:
  void value(const NoisePoints& points, Arena& scratch, float* out) const override {
    float* const wind = scratch.floats(points.n);
    fbm(points, 0.1f, 3, 0.5f, wind);
    fbm(points, 1, 6, 0.5f, out);
    for_lanes(points.n, [=](int i) { out[i] *= std::abs(wind[i]); });
  }
};

constexpr const char* kDoc = "Waves of noise, their height modulated by coarser noise. Has no parameters.";

const Register<Windy<float>> windy_float{"windy", kDoc};
const Register<Windy<RGB>> windy_spectrum{"windy", kDoc};

}  // namespace
}  // namespace whit
