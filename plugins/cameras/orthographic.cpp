// A camera with parallel rays. Source: Pharr, Jakob, Humphreys, Physically Based Rendering, 3rd ed., 6.2.1.
// With a lens the rays of all pixels start on one lens around the origin and meet the parallel ray of their pixel on
// the plane of focus, as in pbrt-v3: sharp things are where they were, others move in perspective.

#include "core/base/sampling.h"
#include "core/plugin/registry.h"
#include "plugins/shared/screen_camera.h"

namespace whit {
namespace {

class Orthographic final : public ScreenCamera {
 public:
  bool prepare(const PrepareContext&) override {
    screen_ = screen(1);
    return true;
  }
  std::optional<Mat4d> to_ndc() const override { return projection(screen_, true); }

  void generate(const CameraRays& rays) const override {
    const Vec3Lanes o = rays.o, d = rays.d;
    float* const weight = rays.weight;
    const Screen s = screen_;
    const float *film_x = rays.film_x, *film_y = rays.film_y, *lens_u = rays.lens_u, *lens_v = rays.lens_v;
    if (!needs_lens()) {
      for_lanes(rays.n, [=](int i) {
        o.set(i, {s.x(film_x[i]), s.y(film_y[i]), 0});
        d.set(i, {0, 0, 1});
        weight[i] = 1;
      });
      return;
    }
    const float radius = lens_radius, focus = focal_distance;
    for_lanes(rays.n, [=](int i) {
      const Vec2f disk = concentric_disk(lens_u[i], lens_v[i]);
      const Vec3f lens(radius * disk.x, radius * disk.y, 0);
      const Vec3f sharp(s.x(film_x[i]), s.y(film_y[i]), focus);
      o.set(i, lens);
      d.set(i, normalize(sharp - lens));
      weight[i] = 1;
    });
  }

 private:
  Screen screen_;
};

const Register<Orthographic> orthographic{"orthographic",           "Camera with parallel rays along +z.",
                                          frameaspectratio_param(), screenwindow_param(),
                                          lensradius_param(),       focaldistance_param(),
                                          shutteropen_param(),      shutterclose_param()};

}  // namespace
}  // namespace whit
