// Two textures in turn on the squares (or cubes) of a grid of unit size. In two dimensions the pattern is
// filtered over the footprint by its integral. Source: PBR book, 3rd ed., 10.5.2.
#include <cmath>

#include "core/base/fastmath.h"
#include "plugins/shared/texture_channels.h"
#include "plugins/shared/texture_mapping.h"

namespace whit {
namespace {

/// 1 in odd cells of a line, squares or cubes (whose indices are added), 0 in even ones.
inline float odd(float cell) { return cell - 2 * std::floor(0.5f * cell); }

/// The integral from 0 to x of the function that is 1 in odd cells.
inline float odd_integral(float x) {
  const float whole = std::floor(0.5f * x);
  return whole + 2 * max_of(0.5f * x - whole - 0.5f, 0.0f);
}

/// The share of odd cells in [x - d, x + d].
inline float odd_share(float x, float d) {
  const float share = (odd_integral(x + d) - odd_integral(x - d)) / (2 * (d > 0 ? d : 1.0f));
  return d > 0 ? clamp_to(share, 0.0f, 1.0f) : odd(std::floor(x));
}

/// The share of tex2 in the rectangle (s +- ds, t +- dt). Beyond a cell's size pbrt gives up and takes one
/// half.
inline float filtered_share(float s, float t, float ds, float dt) {
  const float edges = std::floor(s + ds) - std::floor(s - ds) + std::floor(t + dt) - std::floor(t - dt);
  const float point = odd(std::floor(s) + std::floor(t));
  const float a = odd_share(s, ds), b = odd_share(t, dt);
  const float area = max_of(ds, dt) > 1 ? 0.5f : a + b - 2 * a * b;
  return edges <= 0 ? point : area;  // Of coordinates beyond all numbers nothing is known: as pbrt, the mean.
}

template <class T>
class Checkerboard : public Texture2D<T> {
 public:
  int dimension = 2;
  Tex<T> tex1, tex2;
  Choice aamode;

  std::optional<T> constant() const override {
    if (tex1.is_constant() && tex2.is_constant() && tex1.value() == tex2.value()) return tex1.value();
    return std::nullopt;
  }
  EffectSet effects() const override {
    return dimension == 2 && aamode.index == 0 ? EffectSet{Effect::TextureFiltering} : EffectSet{};
  }
  bool prepare(const PrepareContext& ctx) override {
    map_3d_ = mapping_3d(this->texture_to_world, ctx.space);
    return Texture2D<T>::prepare(ctx);
  }
  void evaluate(const ShadingBatch& s, const typename Texture<T>::Lanes& out) const override {
    const ArenaScope scratch(*s.arena);
    float* const share = s.arena->floats(s.n);
    if (dimension == 3) share_3d(s, share);
    else share_2d(s, share);
    blend<T>(s.n, tex1(s), tex2(s), share, out);
  }

 private:
  void share_2d(const ShadingBatch& s, float* share) const {
    const MappedPoints m = this->map_.map(s);
    if (!m.dsdx || aamode.index != 0) {
      for_lanes(s.n, [&](int i) { share[i] = odd(std::floor(m.s[i]) + std::floor(m.t[i])); });
      return;
    }
    for_lanes(s.n, [&](int i) {
      const float ds = max_of(std::abs(m.dsdx[i]), std::abs(m.dsdy[i]));
      const float dt = max_of(std::abs(m.dtdx[i]), std::abs(m.dtdy[i]));
      share[i] = filtered_share(m.s[i], m.t[i], ds, dt);
    });
  }
  void share_3d(const ShadingBatch& s, float* share) const {
    for_lanes(s.n, [&](int i) {
      const Vec3f p = map_3d_.point(s.p[i]);
      share[i] = odd(std::floor(p.x) + std::floor(p.y) + std::floor(p.z));
    });
  }

  AffineMap map_3d_;
};

constexpr const char* kDoc = "Two textures in turn on the cells of a grid of unit size.";

template <class T>
class RegisterCheckerboard : public Register2D<Checkerboard<T>, T> {
  using C = Checkerboard<T>;

 public:
  RegisterCheckerboard()
      : Register2D<C, T>("checkerboard", kDoc,
                         param(&C::dimension, "dimension", 2, Unit::None,
                               "2: squares in texture coordinates; 3: cubes in space.", Range{2, 3}),
                         param(&C::tex1, "tex1", T(1.0f), Unit::None, "Value in even cells."),
                         param(&C::tex2, "tex2", T(0.0f), Unit::None, "Value in odd cells."),
                         choice(&C::aamode, "aamode", {"closedform", "none"},
                                "Antialiasing of squares: over the footprint, or none.")) {}
};

const RegisterCheckerboard<float> checkerboard_float;
const RegisterCheckerboard<RGB> checkerboard_spectrum;

}  // namespace
}  // namespace whit
