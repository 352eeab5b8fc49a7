// A point that radiates the same in all directions; what arrives falls with the square of the distance.
// Source: Pharr, Jakob, Humphreys, Physically Based Rendering, 3rd ed., 12.3.

#include "core/base/fastmath.h"
#include "core/plugin/light.h"
#include "core/plugin/registry.h"

namespace whit {
namespace {

class PointLight final : public Light {
 public:
  RGB I{1.0f}, scale{1.0f};
  Point from;  ///< World space, from the origin of light space.

  bool is_delta() const override { return true; }
  bool is_black() const override { return whit::is_black(I * scale); }

  bool prepare(const PrepareContext& ctx) override {
    // pbrt-v3 adds "from" after the transform: a rotation or scale at the light does not act on it.
    const Vec3d world = light_to_world.translation() + from.value;
    exact_position_ = (world - ctx.space.origin) * ctx.space.scale;
    position_ = Vec3f(exact_position_);
    to_render_ = static_cast<float>(ctx.space.scale);
    intensity_ = I * scale;
    return true;
  }

  LightReach reach() const override { return reach_of_point(position_, intensity_, to_render_); }

  std::optional<Vec3d> position() const override { return exact_position_; }

  double power(double) const override {
    const auto to_render = static_cast<double>(to_render_);
    return 4 * detail::kPiD * strength_of(intensity_) * to_render * to_render;
  }

  void sample(const LightSamples& s) const override {
    const Vec3f position = position_;
    const RGB intensity = intensity_;
    const float to_render = to_render_;
    for_lanes(s.n, [=](int i) {
      const Vec3f to_light = position - s.p[i];
      const float distance = length(to_light);
      // At the light itself there is no direction, and no light.
      const float inverse = distance > 0 ? 1 / distance : 0.0f;
      // Intensity is per world length squared. One factor at a time, because the square alone could overflow.
      const float falloff = to_render * inverse;
      s.wi.set(i, to_light * inverse);
      s.distance[i] = distance;
      s.radiance.set(
          i, {intensity.x * falloff * falloff, intensity.y * falloff * falloff, intensity.z * falloff * falloff});
    });
  }

 private:
  Vec3d exact_position_{0, 0, 0};  ///< Render space.
  Vec3f position_{0, 0, 0};
  RGB intensity_{0.0f};
  float to_render_ = 1;  ///< Render lengths per world length.
};

const Register<PointLight> point{
    "point",
    "A point that radiates evenly in all directions.",
    param(&PointLight::I, "I", RGB{1.0f}, Unit::Intensity, "Intensity: radiance at distance 1."),
    param(&PointLight::scale, "scale", RGB{1.0f}, Unit::None, "Factor of I."),
    param(&PointLight::from, "from", Point{}, Unit::Length,
          "Position, from where the transform takes the origin; not turned or scaled by it (as in pbrt-v3)."),
    lightgroup_param()};

}  // namespace
}  // namespace whit
