// A point whose intensity in every direction is read from a lat-long picture, as makers of lamps measure it. y of light
// space is the picture's zenith. Source: Pharr, Jakob, Humphreys, Physically Based Rendering, 3rd ed., 12.3.3.

#include "core/base/fastmath.h"
#include "core/plugin/registry.h"
#include "plugins/shared/light_map.h"
#include "plugins/shared/point_source.h"

namespace whit {
namespace {

class GoniometricLight final : public PointSource, public NeedsMemory {
 public:
  FileName mapname;

  MemoryNeed memory_need(const MeshAttributes&) const override { return LightMap::need(mapname, WrapMode::LatLong); }

  bool prepare(const PrepareContext& ctx) override {
    return map_.prepare(ctx, mapname, WrapMode::LatLong) && place(ctx, {0, 0, 0});
  }

 private:
  void factor(int n, const Vec3Lanes& d, const RGBLanes& out) const override {
    if (!map_) {
      for_lanes(n, [=](int i) { out.set(i, RGB(1.0f)); });
      return;
    }
    alignas(64) float s[kBlock] = {}, t[kBlock] = {};
    for_lanes(n, [&](int i) {
      const float phi = atan2_of(d.z[i], d.x[i]);
      // The arc tangent keeps the digits near the poles, which the arc cosine loses.
      const float theta = atan2_of(std::sqrt(d.x[i] * d.x[i] + d.z[i] * d.z[i]), d.y[i]);
      s[i] = (phi < 0 ? phi + kTwoPi : phi) * (0.5f * kInvPi);
      t[i] = theta * kInvPi;
    });
    map_.look_up(n, s, t, out);
  }

  RGB total_factor() const override { return (map_ ? map_.mean() : RGB(1.0f)) * (4 * kPi); }

  LightMap map_;
};

const Register<GoniometricLight> goniometric{
    "goniometric",
    "A point whose intensity is measured: a picture of all directions.",
    intensity_param(),
    intensity_scale_param(),
    param(&GoniometricLight::mapname, "mapname", Unit::None,
          "Lat-long map of factors of I, +y of light space at its top. Without one, the same in all directions."),
    lightgroup_param()};

}  // namespace
}  // namespace whit
