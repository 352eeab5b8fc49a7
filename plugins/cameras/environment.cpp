// A camera that sees all directions, as a lat-long picture: film x is the azimuth, film y the angle from +y.
// Source: Pharr, Jakob, Humphreys, Physically Based Rendering, 3rd ed., 6.3. Lens and screen window have no effect.

#include "core/base/fastmath.h"
#include "core/plugin/registry.h"
#include "plugins/shared/screen_camera.h"

namespace whit {
namespace {

class Environment final : public ScreenCamera {
 public:
  bool needs_lens() const override { return false; }
  std::vector<Ineffective> ineffective() const override {
    constexpr const char* why = "the environment camera sees all directions, without a lens";
    return {{"frameaspectratio", why}, {"screenwindow", why}, {"lensradius", why}, {"focaldistance", why}};
  }

  void generate(const CameraRays& rays) const override {
    const Vec3Lanes o = rays.o, d = rays.d;
    float* const weight = rays.weight;
    const float x_turn = static_cast<float>(1.0 / film.resolution.x);
    const float y_turn = static_cast<float>(0.5 / film.resolution.y);
    const float *film_x = rays.film_x, *film_y = rays.film_y;
    for_lanes(rays.n, [=](int i) {
      const SinCos theta = sin_cos_2pi(y_turn * film_y[i]);
      const SinCos phi = sin_cos_2pi(x_turn * film_x[i]);
      o.set(i, {0, 0, 0});
      d.set(i, {theta.sin * phi.cos, theta.cos, theta.sin * phi.sin});
      weight[i] = 1;
    });
  }
};

const Register<Environment> environment{
    "environment",
    "Camera that sees all directions, as a lat-long picture with +y at the top. Has no lens or screen window.",
    frameaspectratio_param(),
    screenwindow_param(),
    lensradius_param(),
    focaldistance_param(),
    shutteropen_param(),
    shutterclose_param()};

}  // namespace
}  // namespace whit
