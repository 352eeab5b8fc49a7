// The hair lobe: energy, densities, symmetry and degenerate directions.
#include "core/lobe/hair.h"

#include "tests/lobe/lobe_bench.h"

namespace whit {
namespace {

using test::Bench;
using test::chi_squared;
using test::direction;

Lobe& add_hair_lobe(Bench& b, float h, float beta_m, float beta_n, float degrees, float absorption, float eta = 1.55f) {
  Lobe& lobe = b.add(LobeType::Hair, h, hair_variance(beta_m), eta);
  lobe.c = b.constant(hair_azimuthal_scale(beta_n)), lobe.d = b.constant(degrees * kPi / 180);
  lobe.colour1 = {b.constant(absorption), b.constant(2 * absorption), b.constant(4 * absorption)};
  return lobe;
}

/// The integral of the lobe over all directions, by a grid of equal solid angles.
double sphere_integral(Bench& bench, const Vec3f& wo) {
  const int side = 256, n = bench.s.n;
  for (int i = 0; i < n; ++i) bench.s.wo.set(i, wo);
  double sum = 0;
  for (int first = 0; first < side * side; first += n) {
    for (int i = 0; i < n; ++i) {
      const int k = first + i;
      bench.wi.set(i, direction(-1 + 2 * (k / side + 0.5) / side, 2 * M_PI * (k % side + 0.5) / side));
    }
    bench.evaluate();
    for (int i = 0; i < n; ++i) sum += bench.f.r[i];
  }
  return sum * 4 * M_PI / (side * side);
}

TEST(Hair, WithoutAbsorptionAllLightIsScattered) {
  for (const float beta_m : {0.2f, 0.3f, 0.6f, 1.0f}) {
    for (const float beta_n : {0.2f, 0.5f, 1.0f}) {
      for (const float h : {-0.9f, 0.0f, 0.4f}) {
        Bench bench(4096);
        add_hair_lobe(bench, h, beta_m, beta_n, 0, 0);
        for (const double cosine : {0.95, -0.3})
          EXPECT_NEAR(sphere_integral(bench, direction(cosine, 0.5)), 1, 0.005)
              << "beta_m " << beta_m << " beta_n " << beta_n << " h " << h;
      }
    }
  }
}

TEST(Hair, TiltedScalesAndAbsorptionAddNoLight) {
  Bench tilted(4096), dark(4096);
  add_hair_lobe(tilted, 0.4f, 0.3f, 0.3f, 4, 0);
  EXPECT_NEAR(sphere_integral(tilted, direction(0.9, 0.5)), 1, 0.005);
  add_hair_lobe(dark, 0.4f, 0.3f, 0.3f, 2, 1e30f);
  // Only the surface is left: Fresnel's reflectance at the offset.
  const double left = sphere_integral(dark, direction(0.9, 0.5));
  EXPECT_GT(left, 0.03);
  EXPECT_LT(left, 0.1);
}

TEST(Hair, MirrorImagesAreEqual) {
  // Across the plane through the axis and the normal, with the offset turned over.
  const int n = 200;
  Bench a(n), b(n);
  const Vec3f ss = normalize(Vec3f(0.6f, 0.8f, 0)), ts(-ss.y, ss.x, 0);
  add_hair_lobe(a, 0.3f, 0.3f, 0.3f, 2, 0.3f), add_hair_lobe(b, -0.3f, 0.3f, 0.3f, 2, 0.3f);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> u(-1, 1);
  for (int i = 0; i < n; ++i) {
    const Vec3f x = direction(u(random), 3 * u(random)), y = direction(u(random), 3 * u(random));
    a.s.wo.set(i, x), a.wi.set(i, y);
    b.s.wo.set(i, x - ts * (2 * dot(x, ts))), b.wi.set(i, y - ts * (2 * dot(y, ts)));
  }
  a.evaluate(), b.evaluate();
  for (int i = 0; i < n; ++i) EXPECT_NEAR(a.f.g[i], b.f.g[i], 1e-5 * (1 + a.f.g[i]));
}

TEST(Hair, SamplingMatchesItsDensity) {
  for (const double cosine : {0.95, 0.3, -0.6}) {
    for (const float absorption : {0.0f, 0.4f}) {
      for (const float h : {-0.8f, 0.1f}) {
        Bench bench(4096);
        add_hair_lobe(bench, h, 0.4f, 0.4f, 2, absorption);
        chi_squared(bench, direction(cosine, 2), "hair");
      }
    }
  }
}

TEST(Hair, DegenerateDirectionsAndParametersGiveNoNanOrInfinity) {
  const Vec3f along = normalize(Vec3f(0.6f, 0.8f, 0));
  const std::vector<Vec3f> directions = {{0, 0, 1},      {0, 0, -1},       along,           -along, {1, 0, 0},
                                         {1, 0, 1e-20f}, {0.6f, 0, -0.8f}, {-0.8f, 0.6f, 0}};
  const int n = static_cast<int>(directions.size() * directions.size());
  for (const float h : {-1.0f, 0.0f, 1.0f}) {
    for (const float beta : {1e-3f, 0.3f, 1.0f}) {
      for (const float eta : {0.1f, 1.0f, 1.55f, 1e3f}) {
        Bench bench(n);
        add_hair_lobe(bench, h, beta, beta, 2, 0, eta), add_hair_lobe(bench, h, beta, beta, 90, 1e30f, eta);
        for (int i = 0; i < n; ++i) {
          const auto k = static_cast<size_t>(i);
          bench.s.wo.set(i, directions[k / directions.size()]), bench.wi.set(i, directions[k % directions.size()]);
        }
        bench.evaluate();
        for (int i = 0; i < n; ++i) {
          EXPECT_TRUE(std::isfinite(bench.f.r[i]) && bench.f.r[i] >= 0)
              << "h " << h << " beta " << beta << " eta " << eta << " wo " << bench.s.wo[i] << " wi " << bench.wi[i];
        }
      }
    }
  }
}

TEST(Hair, RoughnessMapsAsPublished) {
  // beta_m = 0.3: 0.2178 + 0.07308 + 3.7 * 0.3^20; squared. beta_n = 0.3: 0.626657 * (0.0795 + 0.10746 + ~0).
  EXPECT_NEAR(hair_variance(0.3f), 0.2908800 * 0.2908800, 1e-6);
  EXPECT_NEAR(hair_azimuthal_scale(0.3f), 0.626657 * 0.18696, 1e-6);
  EXPECT_NEAR(hair_variance(1), 5.238 * 5.238, 1e-4);
  EXPECT_NEAR(hair_azimuthal_scale(1), 0.626657 * 6.831, 1e-5);
}

}  // namespace
}  // namespace whit
