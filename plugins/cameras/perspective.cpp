// A pinhole or thin-lens camera. Source: Pharr, Jakob, Humphreys, Physically Based Rendering, 3rd ed., 6.2.
// The lens is ideal: everything on the plane of focus is sharp, without vignetting.

#include <cmath>

#include "core/base/sampling.h"
#include "core/plugin/registry.h"
#include "plugins/shared/screen_camera.h"

namespace whit {
namespace {

class Perspective final : public ScreenCamera {
 public:
  float fov = 90;      ///< Degrees, full angle along the shorter side of the frame.
  float half_fov = 0;  ///< Degrees; replaces fov when above 0.

  bool prepare(const PrepareContext&) override {
    const double degrees = half_fov > 0 ? static_cast<double>(half_fov) : 0.5 * static_cast<double>(fov);
    screen_ = screen(std::tan(degrees * detail::kPiD / 180));
    return true;
  }
  std::vector<Ineffective> ineffective() const override {
    std::vector<Ineffective> all = ScreenCamera::ineffective();
    if (half_fov > 0) all.push_back({"fov", "\"halffov\" goes before it"});
    return all;
  }
  std::optional<Mat4d> to_ndc() const override { return projection(screen_, false); }

  void generate(const CameraRays& rays) const override {
    const Vec3Lanes o = rays.o, d = rays.d;
    float* const weight = rays.weight;
    const Screen s = screen_;
    const float *film_x = rays.film_x, *film_y = rays.film_y, *lens_u = rays.lens_u, *lens_v = rays.lens_v;
    if (!needs_lens()) {
      for_lanes(rays.n, [=](int i) {
        o.set(i, {0, 0, 0});
        d.set(i, normalize(Vec3f(s.x(film_x[i]), s.y(film_y[i]), 1)));
        weight[i] = 1;
      });
      return;
    }
    const float radius = lens_radius, focus = focal_distance;
    for_lanes(rays.n, [=](int i) {
      const Vec2f disk = concentric_disk(lens_u[i], lens_v[i]);
      const Vec3f lens(radius * disk.x, radius * disk.y, 0);
      const Vec3f sharp(focus * s.x(film_x[i]), focus * s.y(film_y[i]), focus);
      o.set(i, lens);
      d.set(i, normalize(sharp - lens));
      weight[i] = 1;
    });
  }

 private:
  Screen screen_;
};

constexpr Range kFullAngle{kPositive.min, 179.999};
constexpr Range kHalfAngle{0, 89.9995};

const Register<Perspective> perspective{
    "perspective",
    "Pinhole or thin-lens camera that looks along +z.",
    param(&Perspective::fov, "fov", 90.0f, Unit::Degrees, "Angle of view along the shorter side.", kFullAngle),
    param(&Perspective::half_fov, "halffov", 0.0f, Unit::Degrees,
          "Half the angle of view, in place of fov when above 0.", kHalfAngle),
    frameaspectratio_param(),
    screenwindow_param(),
    lensradius_param(),
    focaldistance_param(),
    shutteropen_param(),
    shutterclose_param()};

}  // namespace
}  // namespace whit
