// The lobes against physics: energy, reciprocity, densities, Fresnel, refraction.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <functional>
#include <random>

#include "core/lobe/eval.h"
#include "core/lobe/formulas.h"
#include "tests/lobe/lobe_bench.h"

namespace whit {
namespace {

using test::albedo;
using test::Bench;
using test::chi_squared;
using test::direction;

TEST(Lobes, LambertAlbedoIsOne) {
  Bench bench(1024);
  bench.add(LobeType::LambertReflection);
  EXPECT_NEAR(albedo(bench, direction(0.5, 1)), 1, 1e-5);
  EXPECT_NEAR(albedo(bench, direction(-0.1, 1)), 1, 1e-5) << "seen from behind: both sides reflect";
  Bench through(1024);
  through.add(LobeType::LambertTransmission);
  EXPECT_NEAR(albedo(through, direction(0.5, 1)), 1, 1e-5);
}

TEST(Lobes, OrenNayarAlbedoIsAtMostOne) {
  for (const float degrees : {5.0f, 20.0f, 90.0f}) {
    Bench bench(1024);
    const OrenNayarAB ab = oren_nayar_ab(degrees * kPi / 180);
    bench.add(LobeType::OrenNayar, ab.a, ab.b);
    // Oren and Nayar's fit (their "qualitative model") exceeds 1 by up to 0.6 % at grazing angles.
    for (const double cosine : {0.05, 0.3, 0.7, 1.0}) EXPECT_LE(albedo(bench, direction(cosine, 0.3)), 1.007);
  }
  // sigma 0 is Lambert's: A = 1, B = 0.
  EXPECT_EQ(oren_nayar_ab(0).a, 1);
  EXPECT_EQ(oren_nayar_ab(0).b, 0);
}

TEST(Lobes, MicrofacetAlbedoIsAtMostOneAndNearOneWhenSmooth) {
  for (const float alpha : {0.01f, 0.03f, 0.1f, 0.3f, 1.0f}) {
    for (const double cosine : {0.02, 0.1, 0.5, 1.0}) {
      Bench bench(1024);
      bench.add(LobeType::MicrofacetReflection, alpha, alpha, 1.5f, FresnelType::One);
      const double a = albedo(bench, direction(cosine, 0.3));
      EXPECT_LE(a, 1.001) << alpha << ' ' << cosine;
      // Single scattering loses little between flat facets.
      if (alpha <= 0.03f && cosine >= 0.5) { EXPECT_GE(a, 0.995) << alpha << ' ' << cosine; }
    }
  }
}

TEST(Lobes, MetalReflectsWhatFresnelLeaves) {
  for (const double cosine : {0.2, 0.6, 1.0}) {
    Bench smooth(1024);
    smooth.add_metal(0.02f, 0.02f);
    // Facets this smooth are the flat mirror; the red channel's index is 0.2 + 3.9 i.
    EXPECT_NEAR(albedo(smooth, direction(cosine, 0.3)), fresnel_conductor(static_cast<float>(cosine), 0.2f, 3.9f),
                0.01);
    Bench rough(1024);
    rough.add_metal(0.3f, 0.8f);
    EXPECT_LE(albedo(rough, direction(cosine, 0.3)), 1);
  }
}

TEST(Lobes, FresnelBlendKeepsEnergy) {
  for (const float rs : {0.0f, 0.04f, 0.5f, 1.0f}) {
    for (const double cosine : {0.1, 0.5, 1.0}) {
      Bench bench(1024);
      bench.add_blend(1, rs, 0.3f, 0.3f);
      // Ashikhmin and Shirley's coat has no masking: towards grazing angles it exceeds 1 by a few per cent.
      EXPECT_LE(albedo(bench, direction(cosine, 0.3)), 1.08) << rs << ' ' << cosine;
    }
  }
  // Seen from above, a coat of Rs 0 leaves the diffuse part, but for Schlick's rise: 28/23 is made so that the integral
  // of 28/23 (1 - (1 - c/2)^5) 2 c dc is 1, and the other direction's factor is 1 - (1/2)^5 = 31/32 = 0.96875.
  Bench diffuse(1024);
  diffuse.add_blend(1, 0, 0.02f, 0.02f);
  EXPECT_NEAR(albedo(diffuse, direction(1, 0)), 0.96875, 0.001);
}

TEST(Lobes, FresnelBlendHasTheValuesOfItsFormula) {
  Bench bench(1);
  bench.add_blend(0.5f, 0.2f, 0.4f, 0.4f);
  const double ci = 0.7, co = 0.9;
  bench.s.wo.set(0, direction(co, 0)), bench.wi.set(0, direction(ci, 2));
  bench.evaluate();
  const Vec3d wo(direction(co, 0)), wi(direction(ci, 2)), h = (wo + wi).normalized();
  const double diffuse = 28 / (23 * M_PI) * 0.5 * 0.8 * (1 - std::pow(1 - ci / 2, 5)) * (1 - std::pow(1 - co / 2, 5));
  // Trowbridge and Reitz: alpha^2 / (pi (z^2 (alpha^2 - 1) + 1)^2).
  const double a2 = 0.16, t = h.z * h.z * (a2 - 1) + 1, density = a2 / (M_PI * t * t);
  const double ih = wi.dot(h), schlick = 0.2 + std::pow(1 - ih, 5) * 0.8;
  EXPECT_NEAR(bench.f.r[0], (diffuse + density / (4 * ih * co) * schlick) * ci, 1e-6);
}

TEST(Lobes, ThereIsNoLimitToTheirNumber) {
  Bench bench(1);
  bench.s.wo.set(0, direction(0.9, 0)), bench.wi.set(0, direction(0.5, 1));
  for (int k = 0; k < 100; ++k) bench.add(LobeType::LambertReflection);
  EXPECT_EQ(bench.set.count, 100);
  bench.evaluate();
  EXPECT_NEAR(bench.f.g[0], 100 * 0.5 / kPi, 1e-4);
}

TEST(Lobes, RoughGlassConservesEnergy) {
  // Radiance is compressed by eta^2 on the way in, so f is multiplied by the square of the relative index to count energy.
  for (const double cosine : {0.9, 0.4, -0.9, -0.7}) {
    const float n = cosine > 0 ? 1.5f : 1 / 1.5f;
    Bench reflecting(1024), refracting(1024);
    reflecting.add(LobeType::MicrofacetReflection, 0.02f, 0.02f);
    refracting.add(LobeType::MicrofacetTransmission, 0.02f, 0.02f);
    const Vec3f wo = direction(cosine, 0.3);
    const double r = albedo(reflecting, wo), t = albedo(refracting, wo) * n * n;
    EXPECT_NEAR(r + t, 1, 0.01) << cosine;
    // With facets this smooth the share is that of the flat boundary.
    EXPECT_NEAR(r, fresnel_dielectric(static_cast<float>(cosine), 1.5f), 0.02) << cosine;
  }
}

TEST(Lobes, ReflectionIsReciprocal) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> u(0, 1);
  const int n = 2000;
  Bench a(n), b(n);
  for (Bench* bench : {&a, &b}) {
    bench->add(LobeType::LambertReflection);
    bench->add(LobeType::OrenNayar, 0.8f, 0.3f);
    bench->add(LobeType::MicrofacetReflection, 0.2f, 0.2f);
    bench->add(LobeType::MicrofacetReflection, 0.1f, 0.4f);
    bench->add_metal(0.1f, 0.3f);
    bench->add_blend(0.4f, 0.1f, 0.3f, 0.3f);
    bench->add_blend(0.4f, 0.1f, 0.2f, 0.6f);
  }
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

TEST(Lobes, RefractionObeysItsReciprocity) {
  // Walter et al.: f(o -> i) / n_o^2 = f(i -> o) / n_i^2 for radiance.
  std::mt19937 random(1);
  std::uniform_real_distribution<double> u(0, 1);
  const int n = 2000;
  Bench a(n), b(n);
  a.add(LobeType::MicrofacetTransmission, 0.3f, 0.3f), b.add(LobeType::MicrofacetTransmission, 0.3f, 0.3f);
  for (int i = 0; i < n; ++i) {
    const Vec3f x = direction(0.2 + 0.8 * u(random), 6.28 * u(random));
    const Vec3f y = direction(-0.2 - 0.8 * u(random), 6.28 * u(random));
    a.s.wo.set(i, x), a.wi.set(i, y), b.s.wo.set(i, y), b.wi.set(i, x);
  }
  a.evaluate(), b.evaluate();
  int lit = 0;
  for (int i = 0; i < n; ++i) {
    // Of facets seen from behind pbrt-v3 takes the Fresnel term of the wrong side, and so do we: not reciprocal.
    const Vec3f h = a.s.wo[i] + a.wi[i] * 1.5f;
    if (dot(h, a.s.wo[i]) * h.z < 0) continue;
    const double f = a.f.r[i] / std::abs(a.wi.z[i]) * 1.5 * 1.5, g = b.f.r[i] / std::abs(b.wi.z[i]);
    EXPECT_NEAR(f, g, 1e-3 * (f + g) + 1e-6);
    lit += f > 0;
  }
  EXPECT_GT(lit, n / 8);
}

TEST(Lobes, GeometricNormalDecidesBetweenReflectionAndTransmission) {
  Bench bench(2);
  bench.add(LobeType::LambertReflection);
  bench.s.ng.set(0, {0, 0, 1}), bench.s.ng.set(1, normalize(Vec3f(1, 0, 0.5f)));
  for (int i = 0; i < 2; ++i) bench.s.wo.set(i, direction(0.9, 0)), bench.wi.set(i, direction(0.3, kPi));
  bench.evaluate();
  EXPECT_NEAR(bench.f.r[0], 0.3 / kPi, 1e-6);
  EXPECT_EQ(bench.f.r[1], 0) << "wi is below the geometric surface";
}

TEST(Lobes, PlasticInOnePassEqualsItsParts) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> u(-1, 1);
  const int n = 500;
  Bench both(n), diffuse(n), gloss(n);
  both.add(LobeType::LambertReflection), both.add(LobeType::MicrofacetReflection, 0.2f, 0.2f, 1 / 1.5f);
  diffuse.add(LobeType::LambertReflection), gloss.add(LobeType::MicrofacetReflection, 0.2f, 0.2f, 1 / 1.5f);
  for (int i = 0; i < n; ++i) {
    const Vec3f x = direction(u(random), 3 * u(random)), y = direction(u(random), 3 * u(random));
    for (Bench* bench : {&both, &diffuse, &gloss}) bench->s.wo.set(i, x), bench->wi.set(i, y);
  }
  both.evaluate(), diffuse.evaluate(), gloss.evaluate();
  for (int i = 0; i < n; ++i) EXPECT_EQ(both.f.g[i], diffuse.f.g[i] + gloss.f.g[i]);
}

TEST(Lobes, GrazingAndDegenerateDirectionsGiveNoNanOrInfinity) {
  const std::vector<Vec3f> directions = {{0, 0, 1},        {0, 0, -1},       {1, 0, 0},      {-1, 0, 0},
                                         {1, 0, 1e-20f},   {1, 0, -1e-20f},  {-1, 0, 1e-7f}, {0, 1, 1e-4f},
                                         {0.6f, 0, -0.8f}, {-0.6f, 0, 0.8f}, {0.6f, 0, 0.8f}};
  const int n = static_cast<int>(directions.size() * directions.size());
  for (const float eta : {1.0f, 1.5f, 1 / 1.5f, 1e-3f, 1e3f}) {
    for (const float alpha : {kMinAlpha, 0.5f, 1.6f}) {
      Bench bench(n);
      bench.add(LobeType::OrenNayar, 0.8f, 0.3f);
      bench.add(LobeType::MicrofacetReflection, alpha, alpha, eta);
      bench.add(LobeType::MicrofacetReflection, alpha, 2 * alpha, eta);
      bench.add_metal(alpha, alpha);
      bench.add_metal(alpha, 2 * alpha);
      bench.add_blend(0.5f, 0.5f, alpha, alpha);
      bench.add_blend(0.5f, 0, alpha, 2 * alpha);
      bench.add(LobeType::MicrofacetTransmission, alpha, alpha, eta);
      bench.add(LobeType::MicrofacetTransmission, alpha, 2 * alpha, eta);
      bench.add(LobeType::SpecularReflection, 0, 0, eta);
      bench.add(LobeType::SpecularTransmission, 0, 0, eta);
      for (int i = 0; i < n; ++i) {
        bench.s.wo.set(i, directions[i / directions.size()]), bench.wi.set(i, directions[i % directions.size()]);
        bench.s.dpdu.set(i, {0, 0, 0});  // no tangent: any will do
      }
      bench.evaluate();
      const auto expect_finite = [&](const char* what) {
        for (int i = 0; i < n; ++i) {
          EXPECT_TRUE(std::isfinite(bench.f.r[i]) && bench.f.r[i] >= 0)
              << what << " eta " << eta << " alpha " << alpha << " wo " << bench.s.wo[i] << " wi " << bench.wi[i];
        }
      };
      expect_finite("f");
      specular_reflection(bench.set, bench.s, nullptr, bench.wi, bench.f);
      expect_finite("reflection");
      specular_transmission(bench.set, bench.s, nullptr, bench.wi, bench.f);
      expect_finite("transmission");
      for (int i = 0; i < n; ++i) EXPECT_NEAR(length(bench.wi[i]), 1, 1e-5);
    }
  }
}

TEST(Lobes, SamplingMatchesItsDensity) {
  for (const double cosine : {0.95, 0.3, -0.6}) {
    const Vec3f wo = direction(cosine, 2);
    const auto test = [&](const char* what, const std::function<void(Bench&)>& add) {
      Bench bench(4096);
      add(bench);
      chi_squared(bench, wo, what);
    };
    test("lambert", [](Bench& b) { b.add(LobeType::LambertReflection); });
    test("lambert transmission", [](Bench& b) { b.add(LobeType::LambertTransmission); });
    test("oren-nayar", [](Bench& b) { b.add(LobeType::OrenNayar, 0.8f, 0.3f); });
    test("microfacet 0.3", [](Bench& b) { b.add(LobeType::MicrofacetReflection, 0.3f, 0.3f); });
    test("microfacet 1", [](Bench& b) { b.add(LobeType::MicrofacetReflection, 1, 1); });
    test("anisotropic", [](Bench& b) { b.add(LobeType::MicrofacetReflection, 0.2f, 0.7f); });
    test("metal", [](Bench& b) { b.add_metal(0.5f, 0.2f); });
    test("blend", [](Bench& b) { b.add_blend(0.5f, 0.1f, 0.3f, 0.3f); });
    test("anisotropic blend", [](Bench& b) { b.add_blend(0.5f, 0.1f, 0.2f, 0.7f); });
    test("translucent", [](Bench& b) {
      b.add(LobeType::LambertReflection), b.add(LobeType::LambertTransmission);
      b.add(LobeType::MicrofacetReflection, 0.4f, 0.4f), b.add(LobeType::MicrofacetTransmission, 0.4f, 0.4f);
    });
    test("rough glass", [](Bench& b) {
      b.add(LobeType::MicrofacetReflection, 0.4f, 0.4f), b.add(LobeType::MicrofacetTransmission, 0.4f, 0.4f);
    });
    test("plastic", [](Bench& b) {
      b.add(LobeType::LambertReflection), b.add(LobeType::MicrofacetReflection, 0.3f, 0.3f, 1 / 1.5f);
    });
  }
}

TEST(Fresnel, ValuesOfTheTextbook) {
  // ((1.5 - 1) / (1.5 + 1))^2 at normal incidence, from both sides.
  EXPECT_NEAR(fresnel_dielectric(1, 1.5f), 0.04, 1e-7);
  EXPECT_NEAR(fresnel_dielectric(-1, 1.5f), 0.04, 1e-7);
  // At Brewster's angle, tan = n, only the perpendicular part is left: ((n^2 - 1) / (n^2 + 1))^2 / 2 = 0.0739645.
  EXPECT_NEAR(fresnel_dielectric(static_cast<float>(std::cos(std::atan(1.5))), 1.5f), 0.0739645, 1e-6);
  EXPECT_EQ(fresnel_dielectric(0, 1.5f), 1);
  EXPECT_EQ(fresnel_dielectric(-0.5f, 1.5f), 1) << "total internal reflection";
}

TEST(Fresnel, OfAMetalAgreesWithComplexNumbers) {
  using Complex = std::complex<double>;
  for (const Complex n : {Complex(0.2, 3.9), Complex(1.5, 0), Complex(1e-3, 2), Complex(3, 1e-3), Complex(0.5, 0.01),
                          Complex(20, 30), Complex(1, 1e-6)}) {
    for (int i = 0; i <= 1000; ++i) {
      const double c = i / 1000.0;
      // Snell's law and Fresnel's amplitudes as they are in textbooks.
      const Complex g = std::sqrt(n * n - (1 - c * c));
      const double perpendicular = std::norm((c - g) / (c + g)),
                   parallel = std::norm((n * n * c - g) / (n * n * c + g));
      const double exact = i == 0 ? 1 : (perpendicular + parallel) / 2;
      const float f =
          fresnel_conductor(static_cast<float>(c), static_cast<float>(n.real()), static_cast<float>(n.imag()));
      // Near the critical angle of an almost clear medium the rounding of c and n moves the result.
      EXPECT_NEAR(f, exact, 5e-4) << n << ' ' << c;
      EXPECT_TRUE(f >= 0 && f <= 1) << n << ' ' << c;
      EXPECT_EQ(f,
                fresnel_conductor(static_cast<float>(-c), static_cast<float>(n.real()), static_cast<float>(n.imag())));
    }
  }
  // Normal incidence: ((n - 1)^2 + k^2) / ((n + 1)^2 + k^2).
  EXPECT_NEAR(fresnel_conductor(1, 0.2f, 3.9f), (0.64 + 15.21) / (1.44 + 15.21), 1e-6);
  EXPECT_EQ(fresnel_conductor(1, 0, 0), 1);
  EXPECT_EQ(fresnel_conductor(0, 1, 0), 1);
}

TEST(Fresnel, AgreesWithDoublePrecision) {
  for (const double n : {1.0001, 1.33, 1.5, 2.4, 1 / 1.5, 0.9999}) {
    for (int i = 1; i <= 1000; ++i) {
      const double c = i / 1000.0, k = n * n - 1 + c * c;
      double exact = 1;
      if (k > 0) {
        const double g = std::sqrt(k), perpendicular = (c - g) / (c + g), parallel = (n * n * c - g) / (n * n * c + g);
        exact = (perpendicular * perpendicular + parallel * parallel) / 2;
      }
      // n and c are rounded to float: near the critical angle that moves the result.
      EXPECT_NEAR(fresnel_dielectric(static_cast<float>(c), static_cast<float>(n)), exact, 0.003 * exact + 1e-6)
          << n << ' ' << c;
    }
  }
}

TEST(Fresnel, IndexOneIsInvisibleAtEveryAngle) {
  for (float c = 1; c > 1e-30f; c *= 0.9f) {
    EXPECT_EQ(fresnel_dielectric(c, 1), 0);
    EXPECT_EQ(fresnel_dielectric(-c, 1), 0);
  }
  Bench bench(3);
  bench.add(LobeType::SpecularTransmission, 0, 0, 1);
  bench.s.wo.set(0, direction(0.5, 1)), bench.s.wo.set(1, direction(1e-5, 1)), bench.s.wo.set(2, direction(-0.3, 2));
  EXPECT_EQ(specular_transmission(bench.set, bench.s, nullptr, bench.wi, bench.f), 3);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(bench.wi[i], -bench.s.wo[i]);
    EXPECT_EQ(bench.f[i], RGB(1, 1, 1));
  }
}

TEST(Specular, ReflectionAndRefractionShareTheLight) {
  // R + T = 1, with the scaling of radiance taken back.
  const int n = 400;
  for (const float eta : {1.5f, 1 / 1.5f, 2.4f}) {
    Bench bench(n);
    bench.add(LobeType::SpecularReflection, 0, 0, eta), bench.add(LobeType::SpecularTransmission, 0, 0, eta);
    for (int i = 0; i < n; ++i) bench.s.wo.set(i, direction(-1 + 2 * (i + 0.5) / n, i));
    std::vector<float> reflected(n);
    specular_reflection(bench.set, bench.s, nullptr, bench.wi, bench.f);
    for (int i = 0; i < n; ++i) {
      reflected[i] = bench.f.r[i];
      EXPECT_NEAR(length(bench.wi[i] - Vec3f(-bench.s.wo.x[i], -bench.s.wo.y[i], bench.s.wo.z[i])), 0, 3e-7);
    }
    specular_transmission(bench.set, bench.s, nullptr, bench.wi, bench.f);
    for (int i = 0; i < n; ++i) {
      const Vec3f wo = bench.s.wo[i], wi = bench.wi[i];
      const double m = wo.z > 0 ? eta : 1 / static_cast<double>(eta);
      EXPECT_NEAR(reflected[i] + bench.f.r[i] * m * m, 1, 1e-5);
      if (bench.f.r[i] == 0) continue;
      EXPECT_LT(wi.z * wo.z, 0);
      EXPECT_NEAR(wi.x * m, -wo.x, 1e-6) << "Snell's law";
      EXPECT_NEAR(wi.y * m, -wo.y, 1e-6);
    }
  }
}

TEST(Specular, NoLobeOfTheTypeIsBlack) {
  Bench bench(2);
  bench.add(LobeType::LambertReflection);
  bench.s.wo.set(0, direction(0.5, 1)), bench.s.wo.set(1, direction(0.1, 1));
  EXPECT_EQ(specular_reflection(bench.set, bench.s, nullptr, bench.wi, bench.f), 0);
  EXPECT_EQ(bench.f[1], RGB(0, 0, 0));
}

TEST(Specular, OneOfSeveralIsChosenUniformly) {
  // Lanes 0..3: lobes of weight (1, 2), choice 0.1, 0.49, 0.5, 0.99: the first, first, second, second, times two.
  // Lanes 4..5: only the second has weight; it is taken whatever the choice, times one.
  Bench bench(6);
  bench.add(LobeType::SpecularReflection, 0, 0, 1.5f, FresnelType::One);
  bench.add(LobeType::SpecularReflection, 0, 0, 1.5f, FresnelType::One);
  const float choice[] = {0.1f, 0.49f, 0.5f, 0.99f, 0.1f, 0.99f};
  for (int i = 0; i < 6; ++i) {
    bench.s.wo.set(i, direction(0.5, 1));
    bench.set.lobes[0].weight.set(i, RGB(i < 4 ? 1.0f : 0.0f));
    bench.set.lobes[1].weight.set(i, RGB(2));
  }
  EXPECT_EQ(count_lobes(bench.set, LobeType::SpecularReflection), 2);
  EXPECT_EQ(specular_reflection(bench.set, bench.s, choice, bench.wi, bench.f), 6);
  const float expected[] = {2, 2, 4, 4, 2, 2};
  for (int i = 0; i < 6; ++i) EXPECT_EQ(bench.f.r[i], expected[i]) << i;
}

TEST(Roughness, MapsAsPbrt) {
  // The polynomial at x = log(0.1) = -2.302585: 1.62142 - 1.888016 + 0.919343 - 0.209000 + 0.018010 = 0.461757.
  EXPECT_NEAR(roughness_to_alpha(0.1f), 0.461757, 1e-5);
  EXPECT_FLOAT_EQ(roughness_to_alpha(0), roughness_to_alpha(1e-3f));
  EXPECT_FLOAT_EQ(roughness_to_alpha(1), 1.62142f);
}

}  // namespace
}  // namespace whit
