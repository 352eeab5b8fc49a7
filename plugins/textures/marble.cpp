// Veins of marble: a spline of colours, run through by a sine of the height, which noise disturbs. As in pbrt-v3 the
// spline extrapolates beyond its second segment, up to values of about 10. Source: PBR book, 3rd ed., 10.6.5.
#include "plugins/shared/texture_noise.h"

namespace whit {
namespace {

constexpr int kColours = 9;
constexpr float kMarble[3][kColours] = {{0.58f, 0.58f, 0.58f, 0.5f, 0.6f, 0.58f, 0.58f, 0.2f, 0.58f},
                                        {0.58f, 0.58f, 0.58f, 0.5f, 0.59f, 0.58f, 0.58f, 0.2f, 0.58f},
                                        {0.6f, 0.6f, 0.6f, 0.5f, 0.58f, 0.6f, 0.6f, 0.33f, 0.6f}};

/// The spline's value, three rounds of blending neighbours (de Casteljau), t in [0, 1]. `c` are its colours.
inline float marble_spline(const float* c, float t) {
  const float at = t * (kColours - 3);
  const bool second = at >= 1;  // pbrt-v3 knows two segments only
  const float c0 = second ? c[1] : c[0], c1 = second ? c[2] : c[1], c2 = second ? c[3] : c[2];
  const float c3 = second ? c[4] : c[3], x = second ? at - 1 : at;
  const float a = lerp(x, c0, c1), b = lerp(x, c1, c2), d = lerp(x, c2, c3);
  return 1.5f * lerp(x, lerp(x, a, b), lerp(x, b, d));
}

class Marble final : public NoiseTexture<RGB> {
 public:
  int octaves = 8;
  float roughness = 0.5f, scale = 1, variation = 0.2f;

  void evaluate(const ShadingBatch& s, const RGBLanes& out) const override {
    const ArenaScope scratch(*s.arena);
    const NoisePoints points = noise_points(s);
    float* const t = s.arena->floats(s.n);
    fbm(points, scale, octaves, roughness, t);
    const float amount = variation, size = scale;
    for_lanes(s.n, [=](int i) { t[i] = 0.5f + 0.5f * sin_of(size * points.y[i] + amount * t[i]); });
    for (int c = 0; c < 3; ++c) {
      float* const result = channel(out, c);
      for_lanes(s.n, [=](int i) { result[i] = marble_spline(kMarble[c], t[i]); });
    }
  }
};

const Register<Marble> marble{
    "marble",
    "Veins of marble along y of the texture's space.",
    octaves_param(&Marble::octaves),
    roughness_param(&Marble::roughness),
    param(&Marble::scale, "scale", 1.0f, Unit::None, "Factor of the points: veins per length."),
    param(&Marble::variation, "variation", 0.2f, Unit::None, "How much noise disturbs the veins.")};

}  // namespace
}  // namespace whit
