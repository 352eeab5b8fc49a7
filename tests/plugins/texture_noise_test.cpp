// dots, fbm, wrinkled, windy and marble, against what their definitions say.
#include <gtest/gtest.h>

#include "core/base/noise.h"
#include "core/plugin/registry.h"
#include "tests/plugin/shading_points.h"
#include "tests/plugins/make_plugin.h"

namespace whit {
namespace {

using namespace test;

template <class T>
Made<Texture<T>> make_texture(const char* name, ParameterList parameters = {}, const Mat4d& to_world = {}) {
  const char* category = std::is_same_v<T, float> ? "float texture" : "spectrum texture";
  auto made = make_plugin<Texture<T>>(category, name, std::move(parameters));
  EXPECT_TRUE(made.silent()) << name;
  made->texture_to_world = to_world;
  EXPECT_TRUE(made.prepare());
  return made;
}

std::vector<float> values(const Texture<float>& texture, const ShadingBatch& s) {
  std::vector<float> out(static_cast<size_t>(s.n));
  texture.evaluate(s, out.data());
  return out;
}

TEST(NoiseTextures, AreTheSumsOfTheirOctavesInTextureSpace) {
  Mat4d twice;
  twice.setScale(2.0);
  const auto fbm_made = make_texture<float>("fbm", {integer("octaves", 1)}, twice);
  const auto wrinkled = make_texture<float>("wrinkled", {integer("octaves", 0)}, twice);
  ShadingPoints points(40, /*footprint=*/false);
  points.randomise(5);
  const auto v = values(*fbm_made.plugin, points.s);
  for (int i = 0; i < 40; ++i) {
    const Vec3f p = points.s.p[i] * 2.0f;  // the CTM itself is applied, as in pbrt-v3
    EXPECT_NEAR(v[i], perlin_noise(p.x, p.y, p.z), 1e-6);
  }
  for (const float w : values(*wrinkled.plugin, points.s)) EXPECT_NEAR(w, 0.2, 1e-6);
  EXPECT_TRUE(fbm_made->effects().has(Effect::TextureFiltering));
}

TEST(NoiseTextures, FadeWithTheFootprint) {
  ShadingPoints points(1);
  points.s.p.set(0, {0.3f, 0.4f, 0.6f}), points.s.dpdx.set(0, {3, 0, 0}), points.s.dpdy.set(0, {0, 1, 0});
  EXPECT_EQ(values(*make_texture<float>("fbm").plugin, points.s)[0], 0);
  EXPECT_EQ(values(*make_texture<float>("windy").plugin, points.s)[0], 0);
}

TEST(NoiseTextures, ColoursAreGrey) {
  ShadingPoints points(9, false);
  points.randomise(6);
  for (const char* name : {"fbm", "wrinkled", "windy"}) {
    const auto grey = values(*make_texture<float>(name).plugin, points.s);
    const RGBLanes out = points.arena.rgb(9);
    make_texture<RGB>(name)->evaluate(points.s, out);
    for (int i = 0; i < 9; ++i) EXPECT_EQ(out[i], RGB(grey[static_cast<size_t>(i)])) << name;
  }
}

TEST(Marble, ExtrapolatesItsSplineAsPbrt) {
  // Without variation: t = (1 + sin y) / 2. At y = -pi/2 the spline begins: 1.5 times its first colour; at y = pi/2 it
  // is its second segment at 5.
  const auto marble = make_texture<RGB>("marble", {floats("variation", {0})});
  ShadingPoints points(2, false);
  points.s.p.set(0, {0, -kPiOver2, 0}), points.s.p.set(1, {0, kPiOver2, 0});
  const RGBLanes out = points.arena.rgb(2);
  marble->evaluate(points.s, out);
  EXPECT_NEAR(out.r[0], 0.87, 1e-5);
  EXPECT_NEAR(out.b[0], 0.9, 1e-5);
  const auto bernstein = [](double a, double b, double c, double d, double t) {
    const double s = 1 - t;
    return 1.5 * (s * s * s * a + 3 * s * s * t * b + 3 * s * t * t * c + t * t * t * d);
  };
  EXPECT_NEAR(out.r[1], bernstein(0.58, 0.58, 0.5, 0.6, 5), 1e-3);
  EXPECT_GT(out.r[1], 5);
}

TEST(Dots, AreRoundAndTheirNamesSwappedAsInPbrt) {
  const auto dots = make_texture<float>("dots", {floats("inside", {2}), floats("outside", {7})});
  constexpr int kCells = 40, kFine = 20;
  int with_dot = 0;
  for (int cell = 0; cell < kCells * kCells; ++cell) {
    ShadingPoints points(kFine * kFine, false);
    for (int i = 0; i < kFine * kFine; ++i) {
      points.set_flat(i, static_cast<float>(cell % kCells - 20) + static_cast<float>(i % kFine) / kFine - 0.5f,
                      static_cast<float>(cell / kCells - 20) + static_cast<float>(i / kFine) / kFine - 0.5f);
    }
    int inside = 0;
    for (const float v : values(*dots.plugin, points.s)) {
      ASSERT_TRUE(v == 2 || v == 7);
      inside += v == 7;
    }
    if (inside == 0) continue;
    ++with_dot;
    EXPECT_NEAR(inside / static_cast<double>(kFine * kFine), 3.14159 * 0.35 * 0.35, 0.02);
  }
  EXPECT_GT(with_dot, kCells * kCells / 3);
  EXPECT_LT(with_dot, kCells * kCells * 2 / 3);
  EXPECT_EQ(make_plugin<Texture<float>>("float texture", "dots", {floats("inside", {0})})->constant(), 0.0f);
}

}  // namespace
}  // namespace whit
