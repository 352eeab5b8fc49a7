// Lights: what arrives, from where, and that sampling, radiance and density tell the same story.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <random>

#include "core/plugin/light.h"
#include "tests/base/temp_folder.h"
#include "tests/channels.h"
#include "tests/plugins/make_plugin.h"

namespace whit {
namespace {

using namespace test;

constexpr double kPi = 3.14159265358979323846;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// One sample of a light at one point.
struct Sample {
  Vec3f wi;
  float distance;
  RGB radiance;
};

/// Samples at n points (or one for all), with the numbers u and v.
std::vector<Sample> sample(const Light& light, std::vector<Vec3f> p, std::vector<float> u, std::vector<float> v) {
  const int n = static_cast<int>(std::max(p.size(), u.size()));
  if (p.size() == 1) p.resize(static_cast<size_t>(n), p[0]);
  Triples points(n), wi(n), radiance(n);
  std::vector<float> distance(static_cast<size_t>(n));
  for (int i = 0; i < n; ++i) points.vec3().set(i, p[static_cast<size_t>(i)]);
  LightSamples s;
  s.n = n, s.p = points.vec3(), s.wi = wi.vec3(), s.radiance = radiance.rgb(), s.distance = distance.data();
  if (!light.is_delta()) s.u = u.data(), s.v = v.data();
  light.sample(s);
  std::vector<Sample> out;
  for (int i = 0; i < n; ++i) out.push_back({wi[i], distance[static_cast<size_t>(i)], radiance.rgb()[i]});
  return out;
}

RGB escaped(const Light& light, Vec3f o, Vec3f d) {
  RGB out{0.0f};
  light.add_escaped(1, {&o.x, &o.y, &o.z}, {&d.x, &d.y, &d.z}, {&out.x, &out.y, &out.z}, nullptr);
  return out;
}

Vec3f direction(double theta, double phi) {
  return Vec3f(Vec3d(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)));
}

void expect_colour(const RGB& c, double r, double g, double b, double relative) {
  EXPECT_NEAR(c.x, r, std::abs(r) * relative);
  EXPECT_NEAR(c.y, g, std::abs(g) * relative);
  EXPECT_NEAR(c.z, b, std::abs(b) * relative);
}

Made<Light> make_light(const char* name, ParameterList parameters = {}, const Mat4d& light_to_world = {},
                       const RenderSpace& space = {}) {
  Made<Light> l = make_plugin<Light>("light", name, std::move(parameters));
  EXPECT_TRUE(l.silent());
  l->light_to_world = light_to_world;
  PrepareContext ctx;
  ctx.space = space;
  EXPECT_TRUE(l.prepare(ctx));
  return l;
}

// --- Point and distant lights.

TEST(PointLight, InverseSquareInWorldUnits) {
  // The light stands at (1, 2, 3) + (10, 0, 0) in the world; the point at (11, 2, 1), two below it. Intensity 8, 4, 2
  // over 2^2 is 2, 1, 0.5 whatever the render space.
  for (const double scale : {1.0, 4.0, 1.0 / 1024}) {
    RenderSpace space;
    space.origin = {5, -5, 2}, space.scale = scale;
    const auto l = make_light("point", {rgb("I", 4, 2, 1), rgb("scale", 2, 2, 2), point("from", 1, 2, 3)},
                              Mat4d().setTranslation(Vec3d(10, 0, 0)), space);
    const Vec3f p(transform_point(space.from_world(), {11, 2, 1}));
    const Sample s = sample(*l.plugin, {p}, {}, {})[0];
    EXPECT_EQ(s.wi, Vec3f(0, 0, 1));
    EXPECT_FLOAT_EQ(s.distance, static_cast<float>(2 * scale));
    expect_colour(s.radiance, 2, 1, 0.5, 1e-6);
  }
}

TEST(PointLight, ExtremeScalesStayFinite) {
  // A scene of size 1e-25: the square of the scale alone would overflow.
  RenderSpace space;
  space.scale = 0x1p83;
  const auto l = make_light("point", {rgb("I", 1e-30, 1e-30, 1e-30)}, {}, space);
  const Sample s = sample(*l.plugin, {Vec3f(0, static_cast<float>(3e-25 * 0x1p83), 0)}, {}, {})[0];
  EXPECT_NEAR(s.radiance.x / (1e-30 / 9e-50), 1, 1e-5);
  const Sample at_light = sample(*l.plugin, {Vec3f(0, 0, 0)}, {}, {})[0];
  EXPECT_EQ(at_light.radiance, RGB(0.0f));
}

TEST(DistantLight, DirectionIsTransformed) {
  // from - to = +x; the transform turns x to z (rows are the images of the axes) and stretches.
  Mat4d turn(0, 0, 3, 0, 0, 3, 0, 0, -3, 0, 0, 0, 7, 7, 7, 1);
  const auto l = make_light(
      "distant", {rgb("L", 1, 2, 3), rgb("scale", 2, 1, 1), point("from", 5, 1, 1), point("to", 3, 1, 1)}, turn);
  const Sample s = sample(*l.plugin, {Vec3f(1e6f, -4, 9)}, {}, {})[0];
  EXPECT_EQ(s.wi, Vec3f(0, 0, 1));
  EXPECT_EQ(s.distance, kInfinity);
  EXPECT_EQ(s.radiance, RGB(2, 2, 3));
  EXPECT_FALSE(make_plugin<Light>("light", "distant", {point("from", 0, 0, 1)}).good());
}

TEST(Lights, EffectsAndBlackness) {
  for (const char* name : {"point", "distant", "infinite", "skybox"}) {
    const auto l = make_plugin<Light>("light", name);
    EXPECT_FALSE(l->is_black()) << name;
    EXPECT_EQ(l->is_delta(), l->effects().has(Effect::DeltaLights)) << name;
    EXPECT_EQ(l->is_environment(), l->effects().has(Effect::EnvironmentLights)) << name;
    EXPECT_NE(l->is_delta(), l->is_environment()) << name;
    EXPECT_TRUE(make_plugin<Light>("light", name, {rgb("scale", 0, 0, 0)})->is_black()) << name;
  }
  const auto area = make_plugin<AreaLight>(
      "area light", "diffuse",
      {rgb("L", 1, 2, 3), rgb("scale", 2, 2, 2), boolean("twosided", true), integer("nsamples", 4)});
  ASSERT_TRUE(area.silent());
  EXPECT_EQ(area->radiance(), RGB(2, 4, 6));
  EXPECT_TRUE(area->two_sided());
}

// --- Lights all around.

/// A lat-long map in a .pfm file (raw floats, so nothing is lost) that goes when the test does.
class MapFile {
 public:
  MapFile(int width, int height, const std::function<RGB(int, int)>& texel, bool grey = false) {
    static int count = 0;
    path_ = std::filesystem::path(temp_folder()) / ("light_" + std::to_string(count++) + ".pfm");
    std::ofstream out(path_, std::ios::binary);
    out << (grey ? "Pf\n" : "PF\n") << width << ' ' << height << "\n-1.0\n";
    for (int y = height - 1; y >= 0; --y) {  // the format's first row is the bottom one
      for (int x = 0; x < width; ++x) {
        const RGB c = texel(x, y);
        out.write(reinterpret_cast<const char*>(&c), grey ? sizeof(float) : sizeof c);
      }
    }
  }
  ~MapFile() { std::filesystem::remove(path_); }
  Parameter parameter() const { return text("mapname", path_.string()); }

 private:
  std::filesystem::path path_;
};

RGB rough_sky(int x, int y) {
  const double a = std::abs(std::sin(12.9898 * x + 78.233 * y) * 43758.5453);
  const double r = a - std::floor(a);
  return RGB(static_cast<float>(r * r * 3), static_cast<float>(0.5 * r), static_cast<float>(0.1 + r * r));
}
RGB hot_texel(int x, int y) { return x == 5 && y == 2 ? RGB(900, 800, 700) : RGB(0.0f); }

/// A light and a point at which to look at it.
struct Scene {
  const char* name;
  std::function<Made<Light>()> make;
  Vec3f p{0, 0, 0};
};

Mat4d skewed() { return Mat4d(0.9, 0.3, -0.2, 0, 0.4, -1.3, 0.1, 0, 0.2, 0.5, 0.7, 0, 3, 2, 1, 1); }

std::vector<Scene> scenes() {
  static const MapFile rough(16, 8, rough_sky), odd(7, 5, rough_sky), hot(16, 8, hot_texel), single(1, 1, rough_sky);
  static const MapFile grey(6, 3, rough_sky, true);
  const auto light = [](const char* name, ParameterList parameters, Mat4d m = {}) {
    return [=] { return make_light(name, parameters, m); };
  };
  const Parameter radius = floats("radius", {2}), center = point("center", 0.3, 0.2, -0.1);
  return {
      {"infinite constant", light("infinite", {rgb("L", 1, 2, 3)})},
      {"infinite rough", light("infinite", {rough.parameter(), rgb("L", 2, 1, 1)})},
      {"infinite, sides no powers of two", light("infinite", {odd.parameter()})},
      {"infinite, skewed", light("infinite", {rough.parameter()}, skewed())},
      {"infinite, one hot texel", light("infinite", {hot.parameter()})},
      {"infinite, one texel", light("infinite", {single.parameter()})},
      {"infinite, grey", light("infinite", {grey.parameter()})},
      {"sky gradient", light("skybox", {rgb("L", 1, 1, 1)})},
      {"sky gradient, one colour", light("skybox", {rgb("L", 0, 0, 2)})},
      {"sky map", light("skybox", {odd.parameter()})},
      {"sky hot texel", light("skybox", {hot.parameter()}, skewed())},
      {"sphere gradient", light("skybox", {radius, center}), Vec3f(0.5f, -0.7f, 0.9f)},
      {"sphere gradient, centre", light("skybox", {radius, center}), Vec3f(0.3f, 0.2f, -0.1f)},
      {"sphere map, near the wall", light("skybox", {odd.parameter(), radius, center}), Vec3f(0.3f, 2.1f, -0.1f)},
      {"sphere map, skewed", light("skybox", {odd.parameter(), radius}, skewed()), Vec3f(3.4f, 1.1f, 1.3f)},
      {"huge sphere", light("skybox", {rough.parameter(), floats("radius", {1e20})}), Vec3f(5, 6, 7)},
  };
}

/// The integrals over all directions of the density and of the radiance, by the midpoint rule in (cos theta, phi);
/// steps are multiples of the maps' cells so that maps of powers of two have no jump inside a step.
struct Integrals {
  double density = 0;
  Vec3d radiance{0, 0, 0};
};
Integrals integrate(const Light& light, const Vec3f& p, int rows = 560, int columns = 1120) {
  Integrals sum;
  for (int r = 0; r < rows; ++r) {
    const double low = kPi * r / rows, high = kPi * (r + 1) / rows;
    const double solid_angle = 2 * kPi / columns * (std::cos(low) - std::cos(high));
    for (int c = 0; c < columns; ++c) {
      const Vec3f d = direction(0.5 * (low + high), 2 * kPi * (c + 0.5) / columns);
      sum.density += static_cast<double>(light.pdf(p, d)) * solid_angle;
      sum.radiance += test::channels(escaped(light, p, d)) * solid_angle;
    }
  }
  return sum;
}

struct Draws {
  std::vector<float> u, v;
};
/// A jittered grid of numbers.
Draws jittered(int side) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> uniform(0, 1);
  Draws d;
  for (int i = 0; i < side * side; ++i) {
    d.u.push_back(
        std::min(0x1.fffffep-1f, (static_cast<float>(i % side) + uniform(random)) / static_cast<float>(side)));
    d.v.push_back(
        std::min(0x1.fffffep-1f, (static_cast<float>(i / side) + uniform(random)) / static_cast<float>(side)));
  }
  return d;
}

TEST(Environment, DensityIntegratesToOneAndSamplesToTheRadiance) {
  for (const Scene& scene : scenes()) {
    SCOPED_TRACE(scene.name);
    const auto light = scene.make();
    const Integrals exact = integrate(*light.plugin, scene.p);
    EXPECT_NEAR(exact.density, 1, 1e-3);  // transforms put jumps of the density inside steps
    const Draws draws = jittered(400);
    Vec3d mean{0, 0, 0};
    for (const Sample& s : sample(*light.plugin, {scene.p}, draws.u, draws.v))
      mean += test::channels(s.radiance) / 160000.0;
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(mean[c], exact.radiance[c], 1e-3 * exact.radiance[c] + 1e-12) << c;
  }
}

TEST(Environment, SamplesAgreeWithRadianceAndDensityInTheirDirection) {
  for (const Scene& scene : scenes()) {
    SCOPED_TRACE(scene.name);
    const auto light = scene.make();
    const Draws draws = jittered(40);
    for (const Sample& s : sample(*light.plugin, {scene.p}, draws.u, draws.v)) {
      const RGB seen = escaped(*light.plugin, scene.p, s.wi);
      const double pdf = light->pdf(scene.p, s.wi);
      ASSERT_GT(pdf, 0);
      for (int c = 0; c < 3; ++c) {
        ASSERT_TRUE(std::isfinite(s.radiance[c]));
        EXPECT_NEAR(s.radiance[c] * pdf, seen[c], 3e-7 * static_cast<double>(seen[c]));
      }
      EXPECT_NEAR(s.wi.length(), 1, 3e-7);
    }
  }
}

TEST(Environment, DensityIsPositiveWhereverThereIsRadiance) {
  for (const Scene& scene : scenes()) {
    SCOPED_TRACE(scene.name);
    const auto light = scene.make();
    for (int i = 0; i < 20000; ++i) {
      const Vec3f d = direction(std::acos(1 - 2 * (i + 0.5) / 20000), 2.399963 * i);
      const bool black = escaped(*light.plugin, scene.p, d) == RGB(0.0f);
      ASSERT_TRUE(black || light->pdf(scene.p, d) > 0);
    }
  }
}

TEST(Environment, ABatchIsItsLanesOneByOne) {
  for (const Scene& scene : scenes()) {
    SCOPED_TRACE(scene.name);
    const auto light = scene.make();
    const Draws draws = jittered(17);
    std::vector<Vec3f> p(draws.u.size(), scene.p);
    for (size_t i = 0; i < p.size(); ++i) p[i].x += 0.01f * static_cast<float>(i % 7);
    const auto all = sample(*light.plugin, p, draws.u, draws.v);
    for (size_t i = 0; i < all.size(); ++i) {
      const Sample one = sample(*light.plugin, {p[i]}, {draws.u[i]}, {draws.v[i]})[0];
      ASSERT_EQ(one.wi, all[i].wi);
      ASSERT_EQ(one.distance, all[i].distance);
      ASSERT_EQ(one.radiance, all[i].radiance);
    }
  }
}

TEST(Environment, TexelCentresSeamAndPoles) {
  // At the centre of texel (x, y), theta = pi (y + 1/2)/8 and phi = 2 pi (x + 1/2)/16, the map is its texel; the seam
  // at phi = 0 is the mean of the outer columns from both sides. At the poles there is the mean of the end row's two
  // nearest texels; pbrt's infinite light takes the row at the other pole in, which is no part of what is seen there.
  const MapFile file(16, 8, rough_sky);
  const auto sky = make_light("skybox", {file.parameter()}), infinite = make_light("infinite", {file.parameter()});
  for (const auto* light : {&sky, &infinite}) {
    const Light& l = *light->plugin;
    for (int y = 0; y < 8; ++y) {
      for (int x = 0; x < 16; ++x) {
        const RGB c = rough_sky(x, y),
                  seen = escaped(l, {0, 0, 0}, direction(kPi * (y + 0.5) / 8, 2 * kPi * (x + 0.5) / 16));
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(seen[k], c[k], 1e-5) << x << ' ' << y;
      }
    }
    for (const double phi : {0.0, 1e-9, -1e-9, -1e-6}) {
      const RGB mean = (rough_sky(15, 3) + rough_sky(0, 3)) * 0.5f;
      expect_colour(escaped(l, {0, 0, 0}, direction(kPi * 3.5 / 8, phi)), mean.x, mean.y, mean.z, 3e-5);
    }
  }
  const RGB top = (rough_sky(15, 0) + rough_sky(0, 0)) * 0.5f, bottom = (rough_sky(15, 7) + rough_sky(0, 7)) * 0.5f;
  for (const auto* light : {&sky, &infinite}) {
    expect_colour(escaped(*light->plugin, {0, 0, 0}, {0, 0, 1}), top.x, top.y, top.z, 1e-5);
    expect_colour(escaped(*light->plugin, {0, 0, 0}, {0, 0, -1}), bottom.x, bottom.y, bottom.z, 1e-5);
  }
}

TEST(Environment, ExtremeNumbersStayFinite) {
  const float last = 0x1.fffffep-1f;
  for (const Scene& scene : scenes()) {
    SCOPED_TRACE(scene.name);
    const auto light = scene.make();
    for (const Sample& s : sample(*light.plugin, {scene.p}, {0, last, 0, last, 0.5f}, {0, 0, last, last, 0x1p-24f})) {
      EXPECT_NEAR(s.wi.length(), 1, 3e-7);
      for (int c = 0; c < 3; ++c) EXPECT_TRUE(std::isfinite(s.radiance[c]));
    }
  }
}

TEST(Environment, DirectionsThatAreNoneGiveNoRadianceAndNoLookOutsideOfTheMap) {
  // Rays from far outside of what floats can do may have lost their direction. No texel is theirs, so that their sample
  // counts as invalid (Statistics::invalid_samples), or nothing is seen; a number made up for them would be a silent one.
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const Scene& scene : scenes()) {
    SCOPED_TRACE(scene.name);
    const auto light = scene.make();
    const bool constant = std::string(scene.name) == "infinite constant";
    for (const Vec3f& d : {Vec3f(nan, 0, 1), Vec3f(0, nan, 0), Vec3f(nan, nan, nan)}) {
      const RGB seen = escaped(*light.plugin, scene.p, d);
      for (int c = 0; c < 3; ++c) EXPECT_TRUE(constant || seen[c] == 0 || std::isnan(seen[c])) << seen[c];
    }
  }
}

TEST(Environment, MapsAreSampledWhereTheyAreBright) {
  // One hot texel: its tent of radiance over four cells. The relative deviation of Li / pdf inside a cell is that of
  // a product of two linear ramps, sqrt((4/3)^2 - 1) = 0.88, and all cells have the same mean, whatever the sphere
  // around; uniform sampling would give sqrt(128 / (4/3)^2...) > 8.
  const MapFile hot(16, 8, hot_texel);
  const auto light = make_light("infinite", {hot.parameter()});
  const Draws draws = jittered(200);
  double sum = 0, sum2 = 0;
  const auto all = sample(*light.plugin, {Vec3f(0, 0, 0)}, draws.u, draws.v);
  for (const Sample& s : all) sum += s.radiance.y, sum2 += static_cast<double>(s.radiance.y) * s.radiance.y;
  const double n = static_cast<double>(all.size()), mean = sum / n;
  EXPECT_LT(std::sqrt(sum2 / n - mean * mean) / mean, 0.95);
}

TEST(Environment, BadTexelsAreReportedAndBlack) {
  const MapFile file(4, 2, [](int x, int y) {
    if (x == 0 && y == 0) return RGB(std::numeric_limits<float>::quiet_NaN(), 1, 1);
    if (x == 1 && y == 0) return RGB(kInfinity, 1, -2);
    return RGB(1.0f);
  });
  auto l = make_plugin<Light>("light", "infinite", {file.parameter()});
  ASSERT_TRUE(l.prepare());
  ASSERT_EQ(l.diagnostics.all().size(), 1u);
  EXPECT_NE(l.diagnostics.all()[0].message.find("3 numbers"), std::string::npos);
  EXPECT_NEAR(escaped(*l.plugin, {0, 0, 0}, direction(kPi / 4, kPi / 4)).x, 0, 1e-6);
}

TEST(Environment, ErrorsAreReported) {
  auto flat = make_plugin<Light>("light", "infinite");
  flat->light_to_world = Mat4d().setScale(Vec3d(1, 1, 0));
  EXPECT_FALSE(flat.prepare());
  EXPECT_TRUE(flat.diagnostics.has_errors());
  EXPECT_FALSE(make_plugin<Light>("light", "skybox", {text("mapname", "/no/such/map.exr")}).good());
  EXPECT_FALSE(make_plugin<Light>("light", "skybox", {floats("radius", {-1})}).good());
}

// --- The sky in particular.

TEST(Skybox, GradientIsTheDirectionAndItsMeanAHalf) {
  const auto l = make_light("skybox");
  expect_colour(escaped(*l.plugin, {9, 9, 9}, {0.6f, 0, -0.8f}), 0.8, 0.5, 0.1, 1e-6);
  const Integrals sum = integrate(*l.plugin, {0, 0, 0});
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum.radiance[c] / (4 * kPi), 0.5, 1e-6);
}

TEST(Skybox, GradientFollowsTheLightsTransform) {
  Mat4d x_to_z(0, 0, 1, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 0, 1);
  const auto l = make_light("skybox", {}, x_to_z);
  expect_colour(escaped(*l.plugin, {0, 0, 0}, {0, 0, 1}), 1, 0.5, 0.5, 1e-6);  // light space +x
}

/// The finite sphere's gradient as a ray sees it, in double precision by the textbook quadratic.
Vec3d far_point(const Vec3d& o, const Vec3d& d, const Vec3d& center, double radius) {
  const Vec3d oc = o - center;
  const double b = oc.dot(d), c = oc.dot(oc) - radius * radius;
  return (oc + d * (-b + std::sqrt(b * b - c))) / radius;
}

TEST(Skybox, FiniteSphereHasParallax) {
  RenderSpace space;
  space.origin = {1, 0, -2}, space.scale = 0.25;
  const auto l = make_light("skybox", {point("center", 1, 2, 3), floats("radius", {5})}, {}, space);
  std::mt19937 random(6);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int i = 0; i < 500; ++i) {
    const Vec3d o = Vec3d(1, 2, 3) + 2.8 * Vec3d(uniform(random), uniform(random), uniform(random));
    const Vec3f p(transform_point(space.from_world(), o));
    const Vec3f d(Vec3d(uniform(random), uniform(random), uniform(random)).normalized());
    const Vec3d at = far_point(o, Vec3d(d), {1, 2, 3}, 5);
    const RGB seen = escaped(*l.plugin, p, d);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(seen[c], 0.5 * (at[c] + 1), 2e-6);
    // A sampled point lies on the sphere, as far away as stated.
    const float u = static_cast<float>(0.5 + 0.5 * uniform(random) * 0.99),
                v = static_cast<float>(0.5 + 0.5 * uniform(random) * 0.99);
    const Sample s = sample(*l.plugin, {p}, {u}, {v})[0];
    const Vec3d end = transform_point(space.to_world(), Vec3d(p) + Vec3d(s.wi) * static_cast<double>(s.distance));
    EXPECT_NEAR((end - Vec3d(1, 2, 3)).length(), 5, 1e-5);
  }
}

TEST(Skybox, OutsideTheSphereOnlyWhatLiesBehindIt) {
  // From (4, 0, 0), towards the sphere of radius 1: the far side at x = -1, through the near one; away: black. The
  // density of the far side as seen from there is less than 1, and samples of the near side are black.
  const auto l = make_light("skybox", {floats("radius", {1})});
  const Vec3f p(4, 0, 0);
  expect_colour(escaped(*l.plugin, p, {-1, 0, 0}), 0, 0.5, 0.5, 1e-6);
  EXPECT_EQ(escaped(*l.plugin, p, {1, 0, 0}), RGB(0.0f));
  EXPECT_EQ(escaped(*l.plugin, p, {0, 1, 0}), RGB(0.0f));
  const Integrals exact = integrate(*l.plugin, p, 1500, 1500);
  EXPECT_GT(exact.density, 0.3);
  EXPECT_LT(exact.density, 0.7);
  const Draws draws = jittered(400);
  Vec3d mean{0, 0, 0};
  for (const Sample& s : sample(*l.plugin, {p}, draws.u, draws.v)) mean += test::channels(s.radiance) / 160000.0;
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(mean[c], exact.radiance[c], 3e-3 * exact.radiance[c]);
}

TEST(Skybox, AHugeSphereIsInfinitelyFar) {
  const MapFile file(16, 8, rough_sky);
  const auto far = make_light("skybox", {file.parameter()});
  const auto huge = make_light("skybox", {file.parameter(), floats("radius", {1e30})});
  const Draws draws = jittered(20);
  const auto a = sample(*far.plugin, {Vec3f(1, 2, 3)}, draws.u, draws.v);
  const auto b = sample(*huge.plugin, {Vec3f(1, 2, 3)}, draws.u, draws.v);
  for (size_t i = 0; i < a.size(); ++i) {
    EXPECT_NEAR((a[i].wi - b[i].wi).length(), 0, 1e-6);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[i].radiance[c], b[i].radiance[c], 1e-3 * a[i].radiance[c]);
  }
}

}  // namespace
}  // namespace whit
