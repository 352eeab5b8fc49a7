// Perspective, orthographic and environment cameras against rays worked out by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/plugin/camera.h"
#include "tests/plugins/make_plugin.h"

namespace whit {
namespace {

using namespace test;

struct Rays {
  explicit Rays(int n)
      : film_x(n),
        film_y(n),
        lens_u(n, 0.5f),
        lens_v(n, 0.5f),
        weight(n),
        o(n),
        d(n),
        rx_o(n),
        rx_d(n),
        ry_o(n),
        ry_d(n) {}
  void generate(const Camera& camera, int first = 0, int count = -1) {
    CameraRays r;
    r.n = count < 0 ? static_cast<int>(film_x.size()) : count;
    r.film_x = film_x.data() + first, r.film_y = film_y.data() + first;
    if (camera.needs_lens()) r.lens_u = lens_u.data() + first, r.lens_v = lens_v.data() + first;
    r.o = o.vec3().from(first), r.d = d.vec3().from(first), r.weight = weight.data() + first;
    camera.generate(r);
    camera.generate_neighbours(r, 0, rx_o.vec3().from(first), rx_d.vec3().from(first));
    camera.generate_neighbours(r, 1, ry_o.vec3().from(first), ry_d.vec3().from(first));
  }
  std::vector<float> film_x, film_y, lens_u, lens_v, weight;
  Triples o, d, rx_o, rx_d, ry_o, ry_d;
};

Made<Camera> make_camera(const char* name, Vec2i resolution, ParameterList parameters = {}) {
  Made<Camera> c = make_plugin<Camera>("camera", name, std::move(parameters));
  EXPECT_TRUE(c.silent());
  c->film.resolution = resolution;
  EXPECT_TRUE(c.prepare());
  return c;
}

void expect_near(const Vec3f& a, const Vec3d& b, double tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

/// The ray through one film position.
Rays one(const Camera& camera, float x, float y, float u = 0.5f, float v = 0.5f) {
  Rays r(1);
  r.film_x[0] = x, r.film_y[0] = y, r.lens_u[0] = u, r.lens_v[0] = v;
  r.generate(camera);
  return r;
}

TEST(Perspective, CentreLooksAlongZ) {
  const auto c = make_camera("perspective", {100, 60});
  const Rays r = one(*c.plugin, 50, 30);
  expect_near(r.o[0], {0, 0, 0}, 0);
  expect_near(r.d[0], {0, 0, 1}, 0);
  EXPECT_EQ(r.weight[0], 1);
}

TEST(Perspective, FovIsAlongTheShorterSide) {
  // 90 degrees on the short side: the screen's edge there is at tan 45 = 1, the long one's at the aspect.
  const auto wide = make_camera("perspective", {200, 100});
  expect_near(one(*wide.plugin, 100, 0).d[0], Vec3d(0, 1, 1).normalized(), 1e-7);  // film y runs down
  expect_near(one(*wide.plugin, 200, 50).d[0], Vec3d(2, 0, 1).normalized(), 1e-7);
  expect_near(one(*wide.plugin, 0, 100).d[0], Vec3d(-2, -1, 1).normalized(), 1e-7);
  const auto tall = make_camera("perspective", {100, 300});
  expect_near(one(*tall.plugin, 100, 0).d[0], Vec3d(1, 3, 1).normalized(), 1e-7);
}

TEST(Perspective, HalfFovReplacesFov) {
  const auto c = make_camera("perspective", {64, 64}, {floats("fov", {10}), floats("halffov", {30})});
  expect_near(one(*c.plugin, 64, 32).d[0], {0.5, 0, std::sqrt(0.75)}, 1e-7);  // 30 degrees off the axis
}

TEST(Perspective, FrameAspectAndScreenWindow) {
  // Aspect 4 on a square film: x from -4 to 4, y from -1 to 1.
  const auto aspect = make_camera("perspective", {10, 10}, {floats("frameaspectratio", {4})});
  expect_near(one(*aspect.plugin, 10, 0).d[0], Vec3d(4, 1, 1).normalized(), 1e-7);
  const auto window = make_camera("perspective", {10, 20}, {floats("screenwindow", {-1, 3, 0.5, 2})});
  expect_near(one(*window.plugin, 0, 0).d[0], Vec3d(-1, 2, 1).normalized(), 1e-7);
  expect_near(one(*window.plugin, 10, 20).d[0], Vec3d(3, 0.5, 1).normalized(), 1e-7);
}

TEST(Perspective, DifferentialsAreTheNextPixelsRays) {
  for (const double lens : {0.0, 0.3}) {
    const auto c = make_camera("perspective", {50, 40}, {floats("lensradius", {lens}), floats("focaldistance", {4})});
    const Rays r = one(*c.plugin, 11.25f, 7.5f, 0.9f, 0.2f);
    const Rays x = one(*c.plugin, 12.25f, 7.5f, 0.9f, 0.2f), y = one(*c.plugin, 11.25f, 8.5f, 0.9f, 0.2f);
    EXPECT_EQ(r.rx_o, x.o);
    EXPECT_EQ(r.rx_d, x.d);
    EXPECT_EQ(r.ry_o, y.o);
    EXPECT_EQ(r.ry_d, y.d);
  }
}

TEST(Perspective, LensRaysMeetAtTheFocus) {
  // Whatever the lens point, the ray passes the point of the pinhole's ray at z = 7, and starts on the lens.
  const auto c = make_camera("perspective", {80, 60}, {floats("lensradius", {0.5}), floats("focaldistance", {7})});
  EXPECT_TRUE(c->needs_lens());
  EXPECT_TRUE(c->effects().has(Effect::DepthOfField));
  const Vec3d pinhole(7 * (2 * 20.5 / 80 - 1) * 80 / 60, 7 * (1 - 2 * 44.0 / 60), 7);
  std::mt19937 random(1);
  std::uniform_real_distribution<float> uniform(0, 1);
  for (int i = 0; i < 200; ++i) {
    const Rays r = one(*c.plugin, 20.5f, 44, uniform(random), uniform(random));
    const Vec3f o = r.o[0], d = r.d[0];
    EXPECT_LE(std::hypot(o.x, o.y), 0.5f * (1 + 1e-6f));
    EXPECT_EQ(o.z, 0);
    expect_near(o + d * (7 / d.z), pinhole, 3e-6);
    EXPECT_NEAR(d.length(), 1, 2e-7);
  }
}

TEST(Orthographic, RaysAreParallel) {
  const auto c = make_camera("orthographic", {200, 100}, {});
  for (const auto& [x, y] : {std::pair{0.0f, 0.0f}, {200.0f, 100.0f}, {60.0f, 25.0f}}) {
    const Rays r = one(*c.plugin, x, y);
    expect_near(r.o[0], {2 * (x / 100 - 1), 1 - y / 50, 0}, 1e-6);
    expect_near(r.d[0], {0, 0, 1}, 0);
    expect_near(r.rx_o[0] - r.o[0], {0.02, 0, 0}, 1e-6);
    expect_near(r.ry_o[0] - r.o[0], {0, -0.02, 0}, 1e-6);
  }
}

TEST(Orthographic, LensRaysMeetOnThePlaneOfFocus) {
  // As in pbrt-v3 the lens is around the origin for every pixel.
  const auto c = make_camera("orthographic", {100, 100}, {floats("lensradius", {0.25}), floats("focaldistance", {3})});
  for (const float u : {0.01f, 0.5f, 0.97f}) {
    const Rays r = one(*c.plugin, 75, 50, u, 0.3f);
    EXPECT_LE(std::hypot(r.o[0].x, r.o[0].y), 0.25f * (1 + 1e-6f));
    expect_near(r.o[0] + r.d[0] * (3 / r.d[0].z), {0.5, 0, 3}, 1e-6);
  }
}

TEST(EnvironmentCamera, SeesAllDirections) {
  // Rows are the angle from +y, columns the azimuth from +x towards +z.
  const auto c = make_camera("environment", {80, 40});
  expect_near(one(*c.plugin, 0, 20).d[0], {1, 0, 0}, 1e-7);
  expect_near(one(*c.plugin, 20, 20).d[0], {0, 0, 1}, 1e-7);
  expect_near(one(*c.plugin, 33, 0).d[0], {0, 1, 0}, 1e-7);
  expect_near(one(*c.plugin, 40, 10).d[0], Vec3d(-1, 1, 0).normalized(), 1e-7);
}

TEST(Cameras, ABatchIsItsRaysOneByOne) {
  for (const char* name : {"perspective", "orthographic", "environment"}) {
    const auto c = make_camera(name, {300, 200}, {floats("lensradius", {0.1}), floats("focaldistance", {5})});
    constexpr int kCount = 103;
    Rays all(kCount);
    std::mt19937 random(2);
    std::uniform_real_distribution<float> uniform(0, 1);
    for (int i = 0; i < kCount; ++i) {
      all.film_x[i] = 300 * uniform(random), all.film_y[i] = 200 * uniform(random);
      all.lens_u[i] = uniform(random), all.lens_v[i] = uniform(random);
    }
    Rays single = all;
    all.generate(*c.plugin);
    for (int i = 0; i < kCount; ++i) single.generate(*c.plugin, i, 1);
    EXPECT_EQ(all.d, single.d) << name;
    EXPECT_EQ(all.o, single.o) << name;
    EXPECT_EQ(all.rx_d, single.rx_d) << name;
    EXPECT_EQ(all.ry_o, single.ry_o) << name;
  }
}

TEST(Cameras, WrongParametersAreErrors) {
  const auto bad = [](ParameterList p) { return !make_plugin<Camera>("camera", "perspective", std::move(p)).good(); };
  EXPECT_TRUE(bad({floats("screenwindow", {0, 1, 0})}));
  EXPECT_TRUE(bad({floats("screenwindow", {0, 0, 0, 1})}));
  EXPECT_TRUE(bad({floats("fov", {0})}));
  EXPECT_TRUE(bad({floats("fov", {180})}));
  EXPECT_TRUE(bad({floats("lensradius", {-1})}));
  EXPECT_FALSE(bad({floats("fov", {1e-3})}));
  const auto swapped =
      make_plugin<Camera>("camera", "perspective", {floats("shutteropen", {2}), floats("shutterclose", {1})});
  EXPECT_EQ(swapped.diagnostics.all().size(), 1u);
  EXPECT_EQ(swapped->shutter_open, 1);
  EXPECT_EQ(swapped->shutter_close, 2);
}

}  // namespace
}  // namespace whit
