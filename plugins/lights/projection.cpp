// A slide projector: a point that throws a picture along +z of light space, and nothing beside it. Source: Pharr, Jakob,
// Humphreys, Physically Based Rendering, 3rd ed., 12.3.2.

#include <algorithm>
#include <cmath>

#include "core/base/fastmath.h"
#include "core/plugin/registry.h"
#include "plugins/shared/light_map.h"
#include "plugins/shared/point_source.h"

namespace whit {
namespace {

class ProjectionLight final : public PointSource, public NeedsMemory {
 public:
  FileName mapname;
  float fov = 45;

  MemoryNeed memory_need(const MeshAttributes&) const override { return LightMap::need(mapname, WrapMode::Repeat); }

  bool prepare(const PrepareContext& ctx) override {
    if (!map_.prepare(ctx, mapname, WrapMode::Repeat)) return false;
    const double half = std::tan(static_cast<double>(fov) * detail::kPiD / 360), aspect = map_.aspect();
    x_extent_ = static_cast<float>(half * std::max(aspect, 1.0));
    y_extent_ = static_cast<float>(half * std::max(1 / aspect, 1.0));
    if (!place(ctx, {0, 0, 0})) return false;
    // The cone through the picture's corners.
    const double corner = std::hypot(static_cast<double>(x_extent_), static_cast<double>(y_extent_));
    const double slant = std::hypot(1.0, corner);
    limit_to_cone({0, 0, 1}, 1 / slant, corner / slant);
    solid_angle_ = static_cast<float>(2 * detail::kPiD * (1 - 1 / slant));
    return true;
  }

 private:
  void factor(int n, const Vec3Lanes& d, const RGBLanes& out) const override {
    alignas(64) float s[kBlock] = {}, t[kBlock] = {}, inside[kBlock];
    const float x_extent = x_extent_, y_extent = y_extent_;
    for_lanes(n, [&](int i) {
      // Compared before the division, which may overflow beside the light.
      const float width = x_extent * d.z[i], height = y_extent * d.z[i];
      const float beside = max_of(std::abs(d.x[i]) - width, std::abs(d.y[i]) - height);
      const bool hit = (d.z[i] > 0 ? beside : 1.0f) <= 0;
      inside[i] = hit ? 1.0f : 0.0f;
      s[i] = 0.5f + 0.5f * (hit ? d.x[i] : 0.0f) / (hit ? width : 1.0f);
      t[i] = 0.5f + 0.5f * (hit ? d.y[i] : 0.0f) / (hit ? height : 1.0f);
    });
    if (!map_) {
      for_lanes(n, [&](int i) { out.set(i, RGB(inside[i])); });
      return;
    }
    map_.look_up(n, s, t, out);
    for_lanes(n, [&](int i) { out.set(i, out[i] * inside[i]); });
  }

  /// As pbrt: the picture's mean all over the cone.
  RGB total_factor() const override { return (map_ ? map_.mean() : RGB(1.0f)) * solid_angle_; }

  LightMap map_;
  float x_extent_ = 1, y_extent_ = 1;  ///< Of the picture at z = 1, half.
  float solid_angle_ = 0;              ///< Of the cone through the picture's corners.
};

constexpr Range kFullAngle{kPositive.min, 179.999};

const Register<ProjectionLight> projection{
    "projection",
    "A slide projector that throws a picture along +z.",
    intensity_param(),
    intensity_scale_param(),
    param(&ProjectionLight::fov, "fov", 45.0f, Unit::Degrees, "Angle of the picture's shorter side.", kFullAngle),
    param(&ProjectionLight::mapname, "mapname", Unit::None,
          "The picture, its top row towards -y of light space. Without one, a white square."),
    lightgroup_param()};

}  // namespace
}  // namespace whit
