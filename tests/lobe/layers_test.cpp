// Lobes that lie over others: what they leave to those, in tables and in fact, and that nothing is made of nothing.
#include <algorithm>
#include <cstdio>

#include "core/lobe/albedo_table.h"
#include "core/lobe/formulas.h"
#include "tests/lobe/lobe_bench.h"

namespace whit {
namespace {

using test::albedo;
using test::Bench;
using test::direction;

void set_colours(Bench& b, Lobe& lobe, float f0, float f90) {
  lobe.colour1 = {b.constant(f0), b.constant(f0), b.constant(f0)};
  lobe.colour2 = {b.constant(f90), b.constant(f90), b.constant(f90)};
}

Lobe& add_facets(Bench& b, float roughness, float f0, float f90) {
  Lobe& lobe = b.add(LobeType::SchlickReflection, roughness * roughness, roughness * roughness, 1);
  set_colours(b, lobe, f0, f90);
  return lobe;
}

constexpr float kRoughnesses[] = {0.035f, 0.05f, 0.07f, 0.1f, 0.17f, 0.3f, 0.45f, 0.7f, 0.85f, 1};
constexpr double kCosines[] = {1, 0.9, 0.6, 0.33, 0.15, 0.05, 0.01, 0.002};

TEST(FacetAlbedo, IsThatOfTheLobe) {
  // Against the lobe's own samples, 262144 stratified ones; between nodes too.
  double worst = 0;
  for (const float roughness : kRoughnesses) {
    Bench white(1024), dielectric(1024);
    add_facets(white, roughness, 1, 1), add_facets(dielectric, roughness, 0.04f, 1);
    for (const double cosine : kCosines) {
      const auto c = static_cast<float>(cosine);
      const double a =
          facet_albedo()(c, FacetAlbedo::position(roughness * roughness), 1, 1) - albedo(white, direction(cosine, 1));
      const double b = facet_albedo()(c, FacetAlbedo::position(roughness * roughness), 0.04f, 1) -
                       albedo(dielectric, direction(cosine, 1));
      worst = std::max({worst, std::abs(a), std::abs(b)});
      EXPECT_NEAR(a, 0, 5e-3) << roughness << ' ' << cosine;
      // The root of the cosine has nodes every 1/47.
      EXPECT_NEAR(b, 0, cosine < 0.005 ? 5e-3 : 2e-3) << roughness << ' ' << cosine;
    }
  }
  std::printf("off by at most %.5f\n", worst);
}

TEST(FacetAlbedo, OfAMirrorIsItsReflectance) {
  for (const double cosine : kCosines) {
    const auto c = static_cast<float>(cosine);
    EXPECT_NEAR(facet_albedo()(c, 0, 0.04f, 1), schlick_reflectance(c, 0.04f, 1), 5e-4) << cosine;
  }
  // 2 integral of mu (f0 + (1 - f0) (1 - mu)^5) = f0 + (1 - f0) 2 / (6 7).
  EXPECT_NEAR(facet_albedo().mean(0, 0.04f, 1), 0.04 + 0.96 / 21, 2e-4);
}

TEST(FacetAlbedo, MeanIsThatOfTheTable) {
  for (const float roughness : kRoughnesses) {
    const int n = 200000;
    const float position = FacetAlbedo::position(roughness * roughness);
    double sum = 0;
    for (int i = 0; i < n; ++i) {
      const double mu = (i + 0.5) / n;
      sum += 2 * mu * static_cast<double>(facet_albedo()(static_cast<float>(mu), position, 0.04f, 1)) / n;
    }
    EXPECT_NEAR(facet_albedo().mean(position, 0.04f, 1), sum, 1e-5) << roughness;
  }
}

TEST(SheenAlbedo, IsThatOfTheLobe) {
  double worst = 0;
  for (const float roughness : {0.0f, 0.08f, 0.15f, 0.3f, 0.55f, 0.8f, 1.0f}) {
    Bench bench(1024);
    bench.add(LobeType::CharlieSheen, roughness, roughness);
    for (const double cosine : kCosines) {
      const double off =
          sheen_albedo()(static_cast<float>(cosine), sheen_position(roughness)) - albedo(bench, direction(cosine, 1));
      worst = std::max(worst, std::abs(off));
      // Where it is above 1 it is cut off there.
      EXPECT_NEAR(off, 0, roughness < 0.1f ? 0.015 : 0.005) << roughness << ' ' << cosine;
    }
  }
  std::printf("off by at most %.5f\n", worst);
}

}  // namespace
}  // namespace whit
