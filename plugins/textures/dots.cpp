// Round dots, in about half of the cells of a unit grid, each off its cell's centre by chance. Not antialiased. As in
// pbrt-v3, "inside" is what lies between the dots. Source: PBR book, 3rd ed., 10.6.2.
#include "core/base/noise.h"
#include "plugins/shared/texture_channels.h"
#include "plugins/shared/texture_mapping.h"

namespace whit {
namespace {

/// 1 inside a dot, 0 outside.
inline float dot_at(float s, float t) {
  constexpr float kRadius = 0.35f, kMaxShift = 0.5f - kRadius;
  const float column = std::floor(s + 0.5f), row = std::floor(t + 0.5f);
  const bool has_dot = perlin_noise(column + 0.5f, row + 0.5f) > 0;
  const float ds = s - (column + kMaxShift * perlin_noise(column + 1.5f, row + 2.8f));
  const float dt = t - (row + kMaxShift * perlin_noise(column + 4.5f, row + 9.8f));
  return has_dot && ds * ds + dt * dt < kRadius * kRadius ? 1.0f : 0.0f;
}

template <class T>
class Dots : public Texture2D<T> {
 public:
  Tex<T> inside, outside;

  std::optional<T> constant() const override {
    if (inside.is_constant() && outside.is_constant() && inside.value() == outside.value()) return inside.value();
    return std::nullopt;
  }
  EffectSet effects() const override { return {}; }
  void evaluate(const ShadingBatch& s, const typename Texture<T>::Lanes& out) const override {
    const ArenaScope scratch(*s.arena);
    const MappedPoints m = this->map_.map(s);
    float* const share = s.arena->floats(s.n);
    for_lanes(s.n, [=](int i) { share[i] = dot_at(m.s[i], m.t[i]); });
    // pbrt-v3 hands the two to its texture in the wrong order, and scenes are made for what that shows.
    blend<T>(s.n, inside(s), outside(s), share, out);
  }
};

constexpr const char* kDoc = "Round dots at random places, one texture inside, another outside.";

template <class T>
class RegisterDots : public Register2D<Dots<T>, T> {
  using D = Dots<T>;

 public:
  RegisterDots()
      : Register2D<D, T>("dots", kDoc,
                         param(&D::inside, "inside", T(1.0f), Unit::None,
                               "Value between the dots (as in pbrt-v3, which swaps the two)."),
                         param(&D::outside, "outside", T(0.0f), Unit::None, "Value of the dots (as in pbrt-v3).")) {}
};

const RegisterDots<float> dots_float;
const RegisterDots<RGB> dots_spectrum;

}  // namespace
}  // namespace whit
