// Four values at the corners of the unit square of texture coordinates, blended bilinearly, and extrapolated
// beyond.
#include "plugins/shared/texture_channels.h"
#include "plugins/shared/texture_mapping.h"

namespace whit {
namespace {

template <class T>
class Bilerp : public Texture2D<T> {
 public:
  T v00{}, v01{}, v10{}, v11{};

  std::optional<T> constant() const override {
    if (v00 == v01 && v00 == v10 && v00 == v11) return v00;
    return std::nullopt;
  }
  EffectSet effects() const override { return {}; }
  void evaluate(const ShadingBatch& s, const typename Texture<T>::Lanes& out) const override {
    const ArenaScope scratch(*s.arena);
    const MappedPoints m = this->map_.map(s);
    for (int c = 0; c < kChannels<T>; ++c) {
      const float a = channel(v00, c), b = channel(v01, c), d = channel(v10, c), e = channel(v11, c);
      float* const result = channel(out, c);
      for_lanes(s.n, [&](int i) {
        const float u = m.s[i], v = m.t[i];
        result[i] = (1 - u) * (1 - v) * a + (1 - u) * v * b + u * (1 - v) * d + u * v * e;
      });
    }
  }
};

constexpr const char* kDoc = "Bilinear interpolation of four values at the corners of the texture's unit square.";

template <class T>
auto corner(T Bilerp<T>::*member, const char* name, float value, const char* doc) {
  return param(member, name, T(value), Unit::None, doc);
}

template <class T>
class RegisterBilerp : public Register2D<Bilerp<T>, T> {
 public:
  RegisterBilerp()
      : Register2D<Bilerp<T>, T>("bilerp", kDoc, corner(&Bilerp<T>::v00, "v00", 0, "Value at (0, 0)."),
                                 corner(&Bilerp<T>::v01, "v01", 1, "Value at (0, 1)."),
                                 corner(&Bilerp<T>::v10, "v10", 0, "Value at (1, 0)."),
                                 corner(&Bilerp<T>::v11, "v11", 1, "Value at (1, 1).")) {}
};

const RegisterBilerp<float> bilerp_float;
const RegisterBilerp<RGB> bilerp_spectrum;

}  // namespace
}  // namespace whit
