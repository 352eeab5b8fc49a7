// spot, goniometric and projection: where they stand, where they shine, and how much.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "core/image/texture_store.h"
#include "core/image/write.h"
#include "core/plugin/light.h"
#include "tests/base/temp_folder.h"
#include "tests/plugins/make_plugin.h"

namespace whit {
namespace {

using namespace test;

TextureStore& store() {
  static TextureStore textures;
  return textures;
}

Made<Light> make_light(const char* name, ParameterList parameters = {}, const Mat4d& to_world = {},
                       const RenderSpace& space = {}) {
  Made<Light> l = make_plugin<Light>("light", name, std::move(parameters));
  EXPECT_TRUE(l.silent()) << name;
  l->light_to_world = to_world;
  PrepareContext ctx;
  ctx.space = space, ctx.textures = &store();
  EXPECT_TRUE(l.prepare(ctx)) << name;
  return l;
}

struct Sample {
  Vec3f wi;
  float distance;
  RGB radiance;
};

Sample sample(const Light& light, Vec3f p) {
  Sample out;
  LightSamples s;
  s.n = 1, s.p = {&p.x, &p.y, &p.z}, s.wi = {&out.wi.x, &out.wi.y, &out.wi.z}, s.distance = &out.distance;
  s.radiance = {&out.radiance.x, &out.radiance.y, &out.radiance.z};
  light.sample(s);
  return out;
}

/// The point at a distance of 1 from the origin, at an angle (degrees) from +z.
Vec3f at_angle(double degrees) {
  const double a = degrees * M_PI / 180;
  return Vec3f(Vec3d(std::sin(a), 0, std::cos(a)));
}

TEST(Spot, FadesByTheFourthPowerOfTheCosine) {
  const auto l = make_light("spot", {rgb("I", 2, 3, 4), rgb("scale", 10, 10, 10)});
  const auto red = [&](double degrees) { return static_cast<double>(sample(*l.plugin, at_angle(degrees)).radiance.x); };
  EXPECT_NEAR(red(0), 20, 1e-4);
  EXPECT_NEAR(red(24.99), 20, 1e-4);
  EXPECT_EQ(red(30.01), 0);
  EXPECT_EQ(red(179), 0);
  const auto cosine = [](double degrees) { return std::cos(degrees * M_PI / 180); };
  const double delta = (cosine(27) - cosine(30)) / (cosine(25) - cosine(30));
  EXPECT_NEAR(red(27), 20 * std::pow(delta, 4), 1e-4);
  const Sample far = sample(*l.plugin, {0, 0, 10});
  EXPECT_NEAR(far.radiance.z, 0.4, 1e-6);
  EXPECT_EQ(far.wi, Vec3f(0, 0, -1));
  EXPECT_EQ(far.distance, 10);
  EXPECT_EQ(sample(*l.plugin, {0, 0, 0}).radiance, RGB(0.0f));
}

TEST(Spot, FadesByThePowerThatIsAskedFor) {
  // glTF's, (cos a - cos outer) / (cos inner - cos outer) squared, and one that is no whole number; dark outside.
  for (const double power : {2.0, 1.5}) {
    const auto l = make_light("spot", {floats("falloff", {power})});
    const auto red = [&](double degrees) {
      return static_cast<double>(sample(*l.plugin, at_angle(degrees)).radiance.x);
    };
    const auto cosine = [](double degrees) { return std::cos(degrees * M_PI / 180); };
    const double delta = (cosine(27) - cosine(30)) / (cosine(25) - cosine(30));
    EXPECT_NEAR(red(27), std::pow(delta, power), 1e-5);
    EXPECT_NEAR(red(24.99), 1, 1e-5);
    EXPECT_EQ(red(30.01), 0);
    EXPECT_EQ(red(90), 0);
  }
  EXPECT_FALSE(make_plugin<Light>("light", "spot", {floats("falloff", {0})}).good());
}

TEST(Spot, FromAndToAreTurnedByTheTransform) {
  Mat4d to_world = Mat4d().setScale(2.0);
  to_world = to_world * Mat4d(0, 0, 1, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 0, 1) * Mat4d().setTranslation(Vec3d(0, 5, 0));
  const auto l = make_light("spot", {point("from", 1, 0, 0), point("to", 2, 0, 0)}, to_world);
  // From (0, 5, 2) along +z.
  EXPECT_NEAR(sample(*l.plugin, {0, 5, 4}).radiance.x, 0.25, 1e-6);
  EXPECT_EQ(sample(*l.plugin, {0, 5, 0}).radiance.x, 0);
}

TEST(Spot, NarrowConesKeepTheirEdge) {
  const auto l = make_light("spot", {floats("coneangle", {0.01}), floats("conedeltaangle", {0})});
  EXPECT_NEAR(sample(*l.plugin, at_angle(0.0098)).radiance.x, 1, 1e-5);
  EXPECT_EQ(sample(*l.plugin, at_angle(0.0102)).radiance.x, 0);
}

TEST(Spot, RenderSpaceChangesNothing) {
  const RenderSpace space{{1e6, -2e6, 3e6}, 0.25};
  const auto l = make_light("spot", {point("from", 1e6, -2e6, 3e6), point("to", 1e6, -2e6, 3e6 + 1)}, {}, space);
  EXPECT_NEAR(sample(*l.plugin, {0, 0, 0.5f}).radiance.x, 0.25, 1e-6);
}

TEST(PointSources, ErrorsAreReported) {
  EXPECT_FALSE(make_plugin<Light>("light", "spot", {point("to", 0, 0, 0)}).good());
  for (const char* name : {"spot", "goniometric", "projection"}) {
    auto flat = make_plugin<Light>("light", name);
    flat->light_to_world = Mat4d().setScale(Vec3d(1, 1, 0));
    EXPECT_TRUE(flat->is_delta());
    EXPECT_FALSE(flat.prepare());
    EXPECT_TRUE(flat.diagnostics.has_errors());
  }
}

/// A picture of four by two texels, each with a value of its own: 1 + column + 10 row, top row first.
Parameter map_file() {
  static const std::string path = [] {
    const std::string p = test::temp_folder() + "/map.pfm";
    std::vector<float> pixels;
    for (int i = 0; i < 8; ++i) pixels.insert(pixels.end(), 3, static_cast<float>(1 + i % 4 + 10 * (i / 4)));
    OutputImage picture;
    picture.width = 4, picture.height = 2, picture.rgb = pixels;
    EXPECT_TRUE(write_image(p, picture).ok());
    return p;
  }();
  return text("mapname", path);
}

TEST(Goniometric, ReadsItsMapWithYUp) {
  const auto l = make_light("goniometric", {map_file()});
  for (int row = 0; row < 2; ++row) {
    for (int column = 0; column < 4; ++column) {
      const double phi = 2 * M_PI * (column + 0.5) / 4, theta = M_PI * (row + 0.5) / 2;
      const Vec3d d(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
      EXPECT_NEAR(sample(*l.plugin, Vec3f(d)).radiance.x, 1 + column + 10 * row, 1e-4) << row << ' ' << column;
    }
  }
  EXPECT_NEAR(sample(*make_light("goniometric").plugin, {0, 2, 0}).radiance.y, 0.25, 1e-6);
}

TEST(Goniometric, DoesNotLeakThroughItsPoles) {
  // Only the top row of the map shines: the lower half is dark, its pole too, also where 3 rows are enlarged to 4.
  for (const int rows : {4, 3}) {
    OutputImage picture;
    std::vector<float> pixels(static_cast<size_t>(12 * rows), 0.0f);
    std::fill_n(pixels.begin(), 12, 1000.0f);
    picture.width = 4, picture.height = rows, picture.rgb = pixels;
    const std::string path = temp_folder() + "/pole" + std::to_string(rows) + ".pfm";
    ASSERT_TRUE(write_image(path, picture).ok());
    const auto l = make_light("goniometric", {text("mapname", path)});
    for (const double degrees : {180.0, 179.9, 170.0, 150.0}) {
      const Vec3f z = at_angle(degrees);  // from y here
      EXPECT_EQ(sample(*l.plugin, {z.x, z.z, z.y}).radiance.x, 0) << rows << ' ' << degrees;
    }
    EXPECT_GT(sample(*l.plugin, {0, 1, 0}).radiance.x, 900);
  }
}

TEST(Projection, ThrowsItsPictureAndNothingBesideIt) {
  // 90 degrees along the shorter side: at z = 1 the picture is 4 wide and 2 high, its top row at y = -1/2.
  const auto l = make_light("projection", {map_file(), floats("fov", {90})});
  for (int row = 0; row < 2; ++row) {
    for (int column = 0; column < 4; ++column) {
      const Vec3d p(column - 1.5, row - 0.5, 1);
      EXPECT_NEAR(sample(*l.plugin, Vec3f(p)).radiance.x, (1 + column + 10 * row) / p.length2(), 1e-4);
      EXPECT_EQ(sample(*l.plugin, Vec3f(-p)).radiance.x, 0);  // behind it
    }
  }
  EXPECT_EQ(sample(*l.plugin, {2.01f, 0, 1}).radiance.x, 0);
  EXPECT_EQ(sample(*l.plugin, {0, 1.01f, 1}).radiance.x, 0);
  EXPECT_GT(sample(*l.plugin, {1.99f, 0.99f, 1}).radiance.x, 0);
  EXPECT_EQ(sample(*l.plugin, {1, 0, 0}).radiance.x, 0);
  const auto blank = make_light("projection", {floats("fov", {90})});
  EXPECT_NEAR(sample(*blank.plugin, {0.9f, 0.9f, 1}).radiance.x, 1 / 2.62, 1e-5);
  EXPECT_EQ(sample(*blank.plugin, {1.1f, 0, 1}).radiance.x, 0);
}

TEST(PointSources, BatchOfNEqualsNBatchesOfOne) {
  for (const char* name : {"spot", "goniometric", "projection"}) {
    ParameterList list;
    if (name[0] != 's') list.push_back(map_file());
    const auto l = make_light(name, list);
    constexpr int kCount = 301;
    Triples p(kCount), wi(kCount), radiance(kCount);
    std::vector<float> distance(kCount);
    for (int i = 0; i < kCount; ++i)
      p.vec3().set(i, Vec3f(std::sin(i * 1.3f), std::cos(i * 2.1f), std::sin(i * 0.7f)) * 3);
    LightSamples s;
    s.n = kCount, s.p = p.vec3(), s.wi = wi.vec3(), s.distance = distance.data(), s.radiance = radiance.rgb();
    l->sample(s);
    for (int i = 0; i < kCount; ++i) {
      const Sample one = sample(*l.plugin, p[i]);
      EXPECT_EQ(one.radiance, radiance.rgb()[i]);
      EXPECT_EQ(one.wi, wi[i]);
    }
  }
}

}  // namespace
}  // namespace whit
