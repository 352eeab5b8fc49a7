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

  void generate(const CameraRays& rays) const override {
    generate_shifted(rays, 0, 0, rays.o, rays.d);
    if (rays.rx_d) {
      generate_shifted(rays, 1, 0, rays.rx_o, rays.rx_d);
      generate_shifted(rays, 0, 1, rays.ry_o, rays.ry_d);
    }
    float* weight = rays.weight;
    for_lanes(rays.n, [=](int i) { weight[i] = 1; });
  }

 private:
  /// Rays through the film positions plus (dx, dy), each through its own point of the lens.
  void generate_shifted(const CameraRays& rays, float dx, float dy, const Vec3Lanes& o, const Vec3Lanes& d) const {
    const Screen s = screen_;
    const float *film_x = rays.film_x, *film_y = rays.film_y, *lens_u = rays.lens_u, *lens_v = rays.lens_v;
    if (!needs_lens()) {
      for_lanes(rays.n, [=](int i) {
        o.set(i, {s.x(film_x[i] + dx), s.y(film_y[i] + dy), 0});
        d.set(i, {0, 0, 1});
      });
      return;
    }
    const float radius = lens_radius, focus = focal_distance;
    for_lanes(rays.n, [=](int i) {
      const Vec2f disk = concentric_disk(lens_u[i], lens_v[i]);
      const Vec3f lens(radius * disk.x, radius * disk.y, 0);
      const Vec3f sharp(s.x(film_x[i] + dx), s.y(film_y[i] + dy), focus);
      o.set(i, lens);
      d.set(i, normalize(sharp - lens));
    });
  }

  Screen screen_;
};

const Register<Orthographic> orthographic{"orthographic",           "Camera with parallel rays along +z.",
                                          frameaspectratio_param(), screenwindow_param(),
                                          lensradius_param(),       focaldistance_param(),
                                          shutteropen_param(),      shutterclose_param()};

}  // namespace
}  // namespace whit
