// A point that lights a cone, at full intensity inside and fading towards its edge by a power, pbrt-v3's the fourth.
// Source: Pharr, Jakob, Humphreys, Physically Based Rendering, 3rd ed., 12.3.1. In glTF's KHR_lights_punctual it is the
// second.

#include <cmath>

#include "core/base/fastmath.h"
#include "core/plugin/registry.h"
#include "plugins/shared/point_source.h"

namespace whit {
namespace {

class SpotLight final : public PointSource {
 public:
  Point from, to;
  float coneangle = 30, conedeltaangle = 5, falloff = 4;

  void check(Diagnostics& diagnostics, SourcePos statement) override {
    if (from.value == to.value) diagnostics.error(statement, "\"from\" and \"to\" of the spotlight are the same point");
  }

  bool prepare(const PrepareContext& ctx) override {
    axis_ = Vec3f((to.value - from.value).normalized());
    const auto angle = static_cast<double>(coneangle);
    edge_ = one_minus_cos(angle), full_ = one_minus_cos(angle - static_cast<double>(conedeltaangle));
    if (!place(ctx, from.value)) return false;
    // Of the edge that factor() compares with, whatever angle it came from.
    const auto edge = static_cast<double>(edge_);
    limit_to_cone(Vec3d(axis_), 1 - edge, std::sqrt(edge * (2 - edge)));
    return true;
  }

 private:
  /// 1 - cos keeps the digits of narrow cones, which the cosine loses.
  static float one_minus_cos(double degrees) {
    const double s = std::sin(degrees * detail::kPiD / 360);
    return static_cast<float>(2 * s * s);
  }

  void factor(int n, const Vec3Lanes& d, const RGBLanes& out) const override {
    if (falloff == 4) {  // the usual one, without powers
      fade(n, d, out, [](float delta) { return delta * delta * (delta * delta); });
    } else {
      fade(n, d, out, [k = falloff](float delta) { return pow_of(max_of(delta, 0.0f), k); });
    }
  }

  /// faded(x) is the light at x of the way from the edge to the full light, in cosines.
  template <class Faded>
  void fade(int n, const Vec3Lanes& d, const RGBLanes& out, const Faded& faded) const {
    const Vec3f axis = axis_;
    const float edge = edge_, full = full_;
    const float slope = edge > full ? 1 / (edge - full) : 0.0f;
    for_lanes(n, [=](int i) {
      const Vec3f off = normalize(d[i]) - axis;
      const float x = 0.5f * dot(off, off);  // 1 - cos of the angle to the axis
      const float fading = faded((edge - x) * slope);
      const float inside = x <= full ? 1.0f : fading;
      out.set(i, RGB(x <= edge ? inside : 0.0f));
    });
  }

  /// As pbrt: that of a cone with a sharp edge half way through the soft one.
  RGB total_factor() const override { return RGB(kPi * (edge_ + full_)); }

  Vec3f axis_{0, 0, 1};        ///< Light space, unit.
  float edge_ = 0, full_ = 0;  ///< 1 - cos of the angles where the light ends, and where it begins to fade.
};

const Register<SpotLight> spot{
    "spot",
    "A point that lights a cone with a soft edge.",
    intensity_param(),
    intensity_scale_param(),
    param(&SpotLight::from, "from", Point{}, Unit::Length, "Position."),
    param(&SpotLight::to, "to", Point{{0, 0, 1}}, Unit::Length, "A point on the cone's axis."),
    param(&SpotLight::coneangle, "coneangle", 30.0f, Unit::Degrees, "Angle between the cone's axis and its edge."),
    param(&SpotLight::conedeltaangle, "conedeltaangle", 5.0f, Unit::Degrees,
          "Angle inside the edge over which the light fades."),
    param(&SpotLight::falloff, "falloff", 4.0f, Unit::None,
          "The power of the cosine, from 0 at the edge to 1 where the light is full, by which it fades.", kPositive),
    lightgroup_param()};

}  // namespace
}  // namespace whit
