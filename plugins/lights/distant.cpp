// Light from one direction, the same everywhere, as from the sun seen as a point.
// Source: Pharr, Jakob, Humphreys, Physically Based Rendering, 3rd ed., 12.4.

#include <algorithm>
#include <cmath>

#include "core/base/fastmath.h"
#include "core/plugin/light.h"
#include "core/plugin/registry.h"

namespace whit {
namespace {

class DistantLight final : public Light {
 public:
  RGB L{1.0f}, scale{1.0f};
  Point from, to;  ///< Light space; the light travels from `from` to `to`.

  bool is_delta() const override { return true; }
  bool is_black() const override { return whit::is_black(L * scale); }

  void check(Diagnostics& d, SourcePos statement) override {
    if (from.value == to.value) d.error(statement, "\"from\" and \"to\" of the distant light are the same point");
  }

  bool prepare(const PrepareContext& ctx) override {
    // The render space is world space moved and scaled, so directions are the same in both.
    const Vec3d direction = transform_vector(light_to_world, from.value - to.value).normalized();
    if (!(direction.length() > 0.5)) {
      ctx.diagnostics->error(ctx.statement, "the transform leaves the distant light no direction");
      return false;
    }
    to_light_ = Vec3f(direction);
    radiance_ = L * scale;
    return true;
  }

  LightReach reach() const override {
    LightReach reach;
    const float strongest = std::max({std::abs(radiance_.x), std::abs(radiance_.y), std::abs(radiance_.z)});
    if (static_cast<double>(strongest) < LightReach::kStrongest) reach.from = LightReach::From::Direction;
    reach.normal = to_light_;
    return reach;
  }

  /// Through a disk as large as the scene.
  double power(double scene_radius) const override {
    return detail::kPiD * scene_radius * scene_radius * strength_of(radiance_);
  }

  void sample(const LightSamples& s) const override {
    const Vec3f to_light = to_light_;
    const RGB radiance = radiance_;
    for_lanes(s.n, [=](int i) {
      s.wi.set(i, to_light);
      s.distance[i] = std::numeric_limits<float>::infinity();
      s.radiance.set(i, radiance);
    });
  }

 private:
  Vec3f to_light_{0, 0, 1};  ///< Unit.
  RGB radiance_{0.0f};
};

const Register<DistantLight> distant{
    "distant",
    "Parallel light from one direction.",
    param(&DistantLight::L, "L", RGB{1.0f}, Unit::Irradiance, "Irradiance on a surface that faces the light."),
    param(&DistantLight::scale, "scale", RGB{1.0f}, Unit::None, "Factor of L."),
    param(&DistantLight::from, "from", Point{}, Unit::Length, "Where the light comes from."),
    param(&DistantLight::to, "to", Point{{0, 0, 1}}, Unit::Length, "Where the light goes."),
    lightgroup_param()};

}  // namespace
}  // namespace whit
