// Disney's lobes against their formulas' limits, energy, reciprocity and densities.
#include <functional>

#include "core/lobe/formulas.h"
#include "tests/lobe/lobe_bench.h"

namespace whit {
namespace {

using test::albedo;
using test::Bench;
using test::chi_squared;
using test::direction;

Lobe& add_reflection(Bench& b, float ax, float ay, float metallic, float r0) {
  Lobe& lobe = b.add(LobeType::DisneyReflection, ax, ay);
  lobe.colour1 = {b.constant(r0), b.constant(r0), b.constant(r0)};
  lobe.c = b.constant(metallic);
  return lobe;
}

void add_all_reflections(Bench& b) {
  b.add(LobeType::DisneyDiffuse);
  b.add(LobeType::DisneyFakeSubsurface, 0.7f);
  b.add(LobeType::DisneyRetro, 0.7f);
  b.add(LobeType::DisneySheen);
  b.add(LobeType::DisneyClearcoat, 0.05f);
  add_reflection(b, 0.2f, 0.2f, 0.5f, 0.3f);
  add_reflection(b, 0.1f, 0.4f, 0.5f, 0.3f);
}

float value_of(LobeType type, float a, const Vec3f& wo, const Vec3f& wi) {
  Bench b(1);
  b.add(type, a);
  b.s.wo.set(0, wo), b.wi.set(0, wi);
  b.evaluate();
  return b.f.r[0] / std::abs(wi.z);
}

TEST(Disney, ValuesWorkedOutByHand) {
  const Vec3f up(0, 0, 1), slant = direction(0.6, 0), back = direction(0.6, M_PI);
  const double w = std::pow(0.4, 5);  // Schlick's weight at cosine 0.6: 0.01024
  EXPECT_NEAR(value_of(LobeType::DisneyDiffuse, 0, up, slant), (1 - w / 2) / M_PI, 1e-6);
  // Light comes back to where it came from: cos_d = 1, Rr = 2 * 0.5 = 1, so w + w + 0.
  EXPECT_NEAR(value_of(LobeType::DisneyRetro, 0.5f, slant, slant), 2 * w / M_PI, 1e-7);
  // F90 = 0.5: each factor 1 - 0.5 w; 1.25 (F (1/1.2 - 0.5) + 0.5).
  const double f = (1 - 0.5 * w) * (1 - 0.5 * w);
  EXPECT_NEAR(value_of(LobeType::DisneyFakeSubsurface, 0.5f, slant, slant), 1.25 * (f * (1 / 1.2 - 0.5) + 0.5) / M_PI,
              1e-6);
  // Mirrored directions: the half vector is the normal, cos_d = 0.6.
  EXPECT_NEAR(value_of(LobeType::DisneySheen, 0, slant, back), w, 1e-7);
  // At the normal GTR1 is (a2 - 1) / (pi log(a2) a2); a2 = 0.01. Masking: 1 / (0.6 + sqrt(0.0625 + 0.9375 * 0.36)).
  const double d = -0.99 / (M_PI * std::log(0.01) * 0.01), g = 1 / (0.6 + std::sqrt(0.4));
  EXPECT_NEAR(value_of(LobeType::DisneyClearcoat, 0.1f, slant, back), 0.25 * d * g * g * (0.04 + 0.96 * w), 1e-4);
}

TEST(Disney, ReflectsAtMostWhatArrives) {
  for (const double cosine : {0.05, 0.3, 0.7, 1.0}) {
    const auto share = [&](const std::function<void(Bench&)>& add) {
      Bench bench(1024);
      add(bench);
      return albedo(bench, direction(cosine, 0.3));
    };
    EXPECT_LE(share([](Bench& b) { b.add(LobeType::DisneyDiffuse); }), 1);
    EXPECT_LE(share([](Bench& b) { b.add(LobeType::DisneyClearcoat, 0.1f); }), 0.25);
    for (const float alpha : {0.03f, 0.3f, 1.0f}) {
      EXPECT_LE(share([alpha](Bench& b) { add_reflection(b, alpha, alpha, 1, 1); }), 1.001);
      EXPECT_LE(share([alpha](Bench& b) { add_reflection(b, alpha, 0.5f * alpha, 0.3f, 0.9f); }), 1.001);
    }
  }
  Bench smooth(1024);
  add_reflection(smooth, 0.02f, 0.02f, 1, 1);
  EXPECT_GE(albedo(smooth, direction(0.8, 1)), 0.995);
}

TEST(Disney, TransmissionConservesEnergy) {
  for (const double cosine : {0.9, 0.4, -0.9}) {
    const float n = cosine > 0 ? 1.5f : 1 / 1.5f;
    Bench reflecting(1024), refracting(1024);
    add_reflection(reflecting, 0.02f, 0.02f, 0, 0);
    refracting.add(LobeType::DisneyTransmission, 0.02f, 0.02f);
    const Vec3f wo = direction(cosine, 0.3);
    EXPECT_NEAR(albedo(reflecting, wo) + albedo(refracting, wo) * n * n, 1, 0.01) << cosine;
  }
}

TEST(Disney, ReflectionIsReciprocal) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> u(0, 1);
  const int n = 2000;
  Bench a(n), b(n);
  add_all_reflections(a), add_all_reflections(b);
  for (int i = 0; i < n; ++i) {
    const Vec3f x = direction(0.05 + 0.95 * u(random), 6.28 * u(random));
    const Vec3f y = direction(0.05 + 0.95 * u(random), 6.28 * u(random));
    a.s.wo.set(i, x), a.wi.set(i, y), b.s.wo.set(i, y), b.wi.set(i, x);
  }
  a.evaluate(), b.evaluate();
  for (int i = 0; i < n; ++i) {
    const double f = a.f.r[i] / a.wi.z[i], g = b.f.r[i] / b.wi.z[i];
    EXPECT_NEAR(f, g, 1e-4 * (f + g));
  }
}

TEST(Disney, SamplingMatchesItsDensity) {
  for (const double cosine : {0.95, 0.3, -0.6}) {
    const auto test = [&](const char* what, const std::function<void(Bench&)>& add) {
      Bench bench(4096);
      add(bench);
      chi_squared(bench, direction(cosine, 2), what);
    };
    test("diffuse", [](Bench& b) { b.add(LobeType::DisneyDiffuse); });
    test("clearcoat", [](Bench& b) { b.add(LobeType::DisneyClearcoat, 0.3f); });
    test("reflection", [](Bench& b) { add_reflection(b, 0.3f, 0.3f, 0.5f, 0.3f); });
    test("anisotropic", [](Bench& b) { add_reflection(b, 0.7f, 0.2f, 0.5f, 0.3f); });
    test("transmission", [](Bench& b) { b.add(LobeType::DisneyTransmission, 0.4f, 0.4f); });
    test("all", add_all_reflections);
  }
}

TEST(Disney, GrazingAndDegenerateDirectionsGiveNoNanOrInfinity) {
  const std::vector<Vec3f> directions = {{0, 0, 1},      {0, 0, -1},       {1, 0, 0},        {-1, 0, 0},
                                         {1, 0, 1e-20f}, {-1, 0, -1e-20f}, {-1, 0, 1e-7f},   {0, 1, 1e-4f},
                                         {0, -1, 1e-7f}, {0.6f, 0, -0.8f}, {-0.6f, 0, 0.8f}, {0.6f, 0, 0.8f}};
  const int n = static_cast<int>(directions.size() * directions.size());
  for (const float alpha : {kMinAlpha, 0.5f, 0.999f}) {
    Bench bench(n);
    add_all_reflections(bench);
    bench.add(LobeType::DisneyClearcoat, alpha);
    add_reflection(bench, alpha, 2 * alpha, 1, 0);
    bench.add(LobeType::DisneyTransmission, alpha, alpha);
    bench.add(LobeType::DisneyTransmission, alpha, 2 * alpha);
    for (int i = 0; i < n; ++i) {
      const auto k = static_cast<size_t>(i);
      bench.s.wo.set(i, directions[k / directions.size()]), bench.wi.set(i, directions[k % directions.size()]);
    }
    bench.evaluate();
    for (int i = 0; i < n; ++i) {
      EXPECT_TRUE(std::isfinite(bench.f.r[i]) && bench.f.r[i] >= 0)
          << "alpha " << alpha << " wo " << bench.s.wo[i] << " wi " << bench.wi[i];
    }
  }
}

}  // namespace
}  // namespace whit
