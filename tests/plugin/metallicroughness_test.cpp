// The material of glTF models: closed values, and white furnaces over roughness, angles and extensions.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include "core/lobe/eval.h"
#include "core/lobe/formulas.h"
#include "core/plugin/material.h"
#include "tests/plugin/shading_points.h"
#include "tests/plugins/make_plugin.h"

namespace whit {
namespace {

using test::boolean;
using test::floats;
using test::make_plugin;
using test::rgb;
using test::ShadingPoints;

Vec3f direction(double cosine, double phi) {
  const double r = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  return Vec3f(static_cast<float>(r * std::cos(phi)), static_cast<float>(r * std::sin(phi)),
               static_cast<float>(cosine));
}

auto make(ParameterList parameters) {
  auto made = make_plugin<Material>("material", "metallicroughness", std::move(parameters));
  EXPECT_TRUE(made.good() && made.silent());
  return made;
}

ParameterList join(ParameterList a, const ParameterList& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

LobeSet lobes_of(const Material& material, ShadingPoints& points) {
  LobeSet set(points.arena);
  material.lobes(points.s, set);
  return set;
}

/// The light that comes back from a furnace of radiance 1, red, green and blue: the mean weight of 16384 stratified
/// samples. The factor that refraction has for radiance is taken back.
RGB furnace(const Material& material, double cosine, double phi = 0.7) {
  const int side = 128, n = side * side;
  ShadingPoints points(n);
  std::vector<float> lobe(n), u(n), v(n), pdf(n), eta2(n);
  std::mt19937 random(5);
  std::uniform_real_distribution<float> number(0, 0.999f);
  for (int i = 0; i < n; ++i) {
    points.s.wo.set(i, direction(cosine, phi));
    lobe[i] = std::fmod(static_cast<float>(i) * 0.61803399f, 1.0f);
    u[i] = (static_cast<float>(i / side) + number(random)) / side;
    v[i] = (static_cast<float>(i % side) + number(random)) / side;
  }
  const LobeSet set = lobes_of(material, points);
  const Vec3Lanes wi = points.arena.vec3(n);
  const RGBLanes f = points.arena.rgb(n);
  sample_lobes(set, points.s, prepare_frame(set, points.s), lobe.data(), u.data(), v.data(), LobeKinds::All,
               {wi, f, pdf.data(), eta2.data()});
  double sum[3] = {0, 0, 0};
  for (int i = 0; i < n; ++i) {
    const bool refracted = wi.z[i] * points.s.wo.z[i] < 0 && set.eta && std::isfinite(pdf[i]);
    const float index = refracted ? set.eta[i] : 1.0f, n2 = cosine > 0 ? index * index : 1 / (index * index);
    for (int c = 0; c < 3; ++c) sum[c] += static_cast<double>(f[i][c]) * static_cast<double>(n2 * eta2[i]);
  }
  return RGB(static_cast<float>(sum[0] / n), static_cast<float>(sum[1] / n), static_cast<float>(sum[2] / n));
}

double schlick(double f0, double f90, double cosine) { return f0 + (f90 - f0) * std::pow(1 - cosine, 5); }

TEST(MetallicRoughness, SmoothDielectricsReflectBySchlick) {
  // A black body of index n: only the boundary is seen, ((n - 1) / (n + 1))^2 along the normal and all of it at 90 degrees;
  // specular scales both, specularcolor the first, which is 1 at most.
  for (const double n : {1.3, 1.5, 2.5}) {
    const double f0 = std::pow((n - 1) / (n + 1), 2);
    const ParameterList black = {rgb("basecolor", 0, 0, 0), floats("metallic", {0}), floats("roughness", {0}),
                                 floats("ior", {n})};
    const auto plain = make(black);
    const auto tinted = make(join(black, {floats("specular", {0.5}), rgb("specularcolor", 1, 0.25, 100)}));
    for (const double cosine : {1.0, 0.5, 0.2, -1.0, -0.5}) {
      const double c = std::abs(cosine);
      EXPECT_NEAR(furnace(*plain.plugin, cosine).x, schlick(f0, 1, c), 1e-5) << n << ' ' << cosine;
      const RGB f = furnace(*tinted.plugin, cosine);
      EXPECT_NEAR(f.x, schlick(0.5 * f0, 0.5, c), 1e-5) << n << ' ' << cosine;
      EXPECT_NEAR(f.y, schlick(0.125 * f0, 0.5, c), 1e-5) << n << ' ' << cosine;
      EXPECT_NEAR(f.z, 0.5, 1e-5) << n << ' ' << cosine;
    }
  }
}

TEST(MetallicRoughness, SmoothMetalsAreMirrorsOfTheirColour) {
  const auto gold = make({rgb("basecolor", 1, 0.75, 0.25), floats("roughness", {0})});
  const auto half = make({rgb("basecolor", 0.8, 0, 0), floats("roughness", {0}), floats("metallic", {0.5})});
  for (const double cosine : {1.0, 0.5}) {
    const RGB f = furnace(*gold.plugin, cosine);
    EXPECT_NEAR(f.x, 1, 1e-5);
    EXPECT_NEAR(f.y, schlick(0.75, 1, cosine), 1e-5);
    EXPECT_NEAR(f.z, schlick(0.25, 1, cosine), 1e-5);
  }
  // Half a metal's 0.8 and half of a dielectric: 0.04, and 0.8 of what that leaves.
  EXPECT_NEAR(furnace(*half.plugin, 1).x, 0.5 * 0.8 + 0.5 * (0.04 + 0.96 * 0.8), 2e-3);
}

TEST(MetallicRoughness, IndexZeroReflectsEverything) {
  const auto all =
      make({rgb("basecolor", 0, 0, 0), floats("metallic", {0}), floats("roughness", {0}), floats("ior", {0})});
  for (const double cosine : {1.0, 0.3}) EXPECT_NEAR(furnace(*all.plugin, cosine).x, 1, 1e-5);
}

TEST(MetallicRoughness, SmoothSolidsReflectTotallyInside) {
  // Index 1.5: beyond 41.8 degrees inside, cosine 0.745, all is reflected, and before that what the outside at the
  // refracted angle does.
  const auto glass =
      make({floats("metallic", {0}), floats("roughness", {0}), floats("transmission", {1}), boolean("thin", false)});
  ShadingPoints points(2);
  const double outside = std::sqrt(1 - (1 - 0.81) * 2.25);
  points.s.wo.set(0, direction(-0.7, 0)), points.s.wo.set(1, direction(-0.9, 0));
  const LobeSet set = lobes_of(*glass.plugin, points);
  ASSERT_EQ(set.count, 2);
  const Vec3Lanes wi = points.arena.vec3(2);
  const RGBLanes reflected = points.arena.rgb(2), refracted = points.arena.rgb(2);
  specular_reflection(set, points.s, nullptr, wi, reflected);
  EXPECT_EQ(reflected.r[0], 1);
  EXPECT_NEAR(reflected.r[1], schlick(0.04, 1, outside), 1e-5);
  specular_transmission(set, points.s, nullptr, wi, refracted);
  EXPECT_EQ(refracted.r[0], 0);
  // Radiance leaves its 2.25 in the glass.
  EXPECT_NEAR(refracted.r[1], (1 - schlick(0.04, 1, outside)) * 2.25, 1e-5);
  EXPECT_NEAR(wi.z[1], outside, 1e-5);
  EXPECT_EQ(set.eta[0], 1.5f);
}

TEST(MetallicRoughness, ThinSheetsLetLightStraightOn) {
  const auto sheet = make(
      {rgb("basecolor", 0.5, 1, 0), floats("metallic", {0}), floats("roughness", {0}), floats("transmission", {1})});
  ShadingPoints points(1);
  points.s.wo.set(0, direction(0.5, 1));
  const LobeSet set = lobes_of(*sheet.plugin, points);
  const Vec3Lanes wi = points.arena.vec3(1);
  const RGBLanes f = points.arena.rgb(1);
  specular_transmission(set, points.s, nullptr, wi, f);
  EXPECT_EQ(wi[0], -points.s.wo[0]);
  const double through = 1 - schlick(0.04, 1, 0.5);
  EXPECT_NEAR(f.r[0], 0.5 * through, 1e-6);
  EXPECT_NEAR(f.g[0], through, 1e-6);
  EXPECT_EQ(f.b[0], 0);
  EXPECT_EQ(set.eta, nullptr) << "no index for ray differentials";
}

/// Values and directions of one pair.
RGB value(const Material& material, const Vec3f& wo, const Vec3f& wi, ShadingPoints& points) {
  points.s.wo.set(0, wo);
  const LobeSet set = lobes_of(material, points);
  const Vec3Lanes to = points.arena.vec3(1);
  const RGBLanes f = points.arena.rgb(1);
  to.set(0, wi);
  eval_lobes(set, points.s, prepare_frame(set, points.s), to, f);
  return f[0];
}

TEST(MetallicRoughness, FacetsAreThoseOfTheSpecification) {
  // Along the normal D = 1 / (pi alpha^2) and V = 1/4, so that a metal shows colour / (4 pi alpha^2), alpha = 0.4^2; twice
  // that, about, if anisotropy 0.5 makes alpha_t = 0.16 + 0.84 / 4 = 0.37: D = 1 / (pi alpha_t alpha_b).
  ShadingPoints points(1);
  const Vec3f up(0, 0, 1);
  const auto metal = make({rgb("basecolor", 1, 0.5, 0.2), floats("roughness", {0.4})});
  const RGB f = value(*metal.plugin, up, up, points);
  EXPECT_NEAR(f.x, 1 / (4 * M_PI * 0.0256), 1e-4);
  EXPECT_NEAR(f.z, 0.2 / (4 * M_PI * 0.0256), 1e-4);
  const auto stretched = make({floats("roughness", {0.4}), floats("anisotropy", {0.5})});
  EXPECT_NEAR(value(*stretched.plugin, up, up, points).x, 1 / (4 * M_PI * 0.16 * 0.37), 1e-4);
}

TEST(MetallicRoughness, FacetsAreStretchedAlongTheRotatedTangent) {
  // A highlight is longer along the rougher direction: at 30 degrees from the tangent towards the bitangent, whichever side
  // that is on.
  const auto metal =
      make({floats("roughness", {0.3}), floats("anisotropy", {0.8}), floats("anisotropyrotation", {30})});
  for (const float side : {1.0f, -1.0f}) {
    ShadingPoints points(1);
    points.s.dpdu.set(0, {2, 0, 0}), points.s.dpdv.set(0, {0, 0.5f * side, 0});
    double brightest = 0;
    int angle = -1;
    for (int degrees = 0; degrees < 180; degrees += 10) {
      const double phi = degrees * M_PI / 180;
      const double f = static_cast<double>(value(*metal.plugin, {0, 0, 1}, direction(0.8, phi), points).x);
      if (f > brightest) brightest = f, angle = degrees;
    }
    EXPECT_EQ(angle, side > 0 ? 30 : 150);
  }
}

TEST(MetallicRoughness, IsReciprocal) {
  // Neither coat nor sheen: what they leave to the body is weighed by the direction that is looked from.
  const auto body = make({rgb("basecolor", 0.8, 0.5, 0.2), floats("metallic", {0.3}), floats("roughness", {0.4}),
                          floats("transmission", {0.4}), floats("anisotropy", {0.5}), floats("specular", {0.8})});
  std::mt19937 random(2);
  std::uniform_real_distribution<double> u(0, 1);
  ShadingPoints points(1);
  for (int i = 0; i < 200; ++i) {
    const Vec3f a = direction(0.05 + 0.9 * u(random), 6 * u(random)),
                up = direction(0.05 + 0.9 * u(random), 6 * u(random));
    const Vec3f b = i % 2 ? up : Vec3f(up.x, up.y, -up.z);
    const RGB f = value(*body.plugin, a, b, points), g = value(*body.plugin, b, a, points);
    for (int c = 0; c < 3; ++c) {
      const float there = f[c] / std::abs(b.z), back = g[c] / std::abs(a.z);
      EXPECT_NEAR(there, back, 2e-4f * (there + back)) << a << b;
    }
  }
}

using Types = std::vector<LobeType>;
Types types_of(ParameterList parameters) {
  ShadingPoints points(1);
  const auto made = make(std::move(parameters));
  const LobeSet set = lobes_of(*made.plugin, points);
  Types types;
  for (int k = 0; k < set.count; ++k) types.push_back(set.lobes[k].type);
  return types;
}

TEST(MetallicRoughness, HasTheLobesItsParametersCallFor) {
  using enum LobeType;
  const auto dielectric = [](ParameterList more) { return types_of(join({floats("metallic", {0})}, more)); };
  EXPECT_EQ(types_of({}), Types{SchlickReflection});
  EXPECT_EQ(types_of({floats("roughness", {0})}), Types{SpecularReflection});
  EXPECT_EQ(types_of({floats("transmission", {1})}), Types{SchlickReflection}) << "metal lets nothing through";
  EXPECT_EQ(dielectric({}), (Types{SchlickReflection, CoupledDiffuse}));
  EXPECT_EQ(dielectric({floats("specular", {0})}), Types{CoupledDiffuse});
  EXPECT_EQ(dielectric({floats("roughness", {0})}), (Types{CoupledDiffuse, SpecularReflection}));
  EXPECT_EQ(dielectric({floats("transmission", {1})}), (Types{SchlickReflection, SchlickPassage}));
  EXPECT_EQ(dielectric({floats("transmission", {0.5}), floats("roughness", {0})}),
            (Types{CoupledDiffuse, SpecularTransmission, SpecularReflection}));
  EXPECT_EQ(dielectric({floats("transmission", {1}), boolean("thin", false)}),
            (Types{SchlickReflection, SchlickTransmission}));
  EXPECT_EQ(dielectric({floats("clearcoat", {1}), floats("roughness", {0})}),
            (Types{CoupledDiffuse, SpecularReflection}))
      << "two mirrors are one";
  EXPECT_EQ(types_of({floats("clearcoat", {1}), floats("clearcoatroughness", {0.1}), rgb("sheencolor", 1, 1, 1)}),
            (Types{SchlickReflection, CharlieSheen, SchlickReflection}));
  EXPECT_EQ(types_of({floats("opacity", {0.5})}), (Types{SpecularTransmission, SchlickReflection}));
  EXPECT_EQ(types_of({floats("opacity", {0})}), Types{SpecularTransmission});
}

TEST(MetallicRoughness, OpacityIsAShare) {
  ShadingPoints points(1);
  const auto made = make({floats("opacity", {0.25}), floats("metallic", {0}), floats("transmission", {1}),
                          floats("roughness", {0}), boolean("thin", false)});
  const LobeSet set = lobes_of(*made.plugin, points);
  ASSERT_EQ(set.count, 3);
  EXPECT_EQ(set.lobes[0].weight[0], RGB(0.75f));
  EXPECT_EQ(set.lobes[0].eta[0], 1);
  EXPECT_NEAR(set.lobes[1].weight.r[0] + set.lobes[2].weight.r[0], 0.25, 1e-6) << "reflected and refracted";
  EXPECT_EQ(set.eta[0], 1) << "the index for ray differentials, as uber's";
}

constexpr double kRoughnesses[] = {0, 0.04, 0.1, 0.25, 0.5, 1};
constexpr double kCosines[] = {1, 0.5, 0.1, 0.01, -0.6};

TEST(MetallicRoughness, WhiteBodiesOfAnyRoughnessReflectEverything) {
  for (const double roughness : kRoughnesses) {
    const auto white = make({floats("metallic", {0}), floats("roughness", {roughness})});
    const auto bright = make({floats("metallic", {0}), floats("roughness", {roughness}), floats("ior", {2.5})});
    for (const double cosine : kCosines) {
      for (const auto* m : {white.plugin.get(), bright.plugin.get()}) {
        const RGB f = furnace(*m, cosine);
        EXPECT_NEAR(f.x, 1, 6e-3) << roughness << ' ' << cosine;
      }
    }
  }
}

TEST(MetallicRoughness, NoLayerMakesLight) {
  const std::pair<const char*, ParameterList> extensions[] = {
      {"metal", {floats("metallic", {1})}},
      {"half metal", {floats("metallic", {0.5})}},
      {"reflects all", {floats("ior", {0})}},
      {"specular", {floats("specular", {0.5}), rgb("specularcolor", 1, 0.5, 0.2)}},
      {"bright specular", {floats("ior", {2.5}), rgb("specularcolor", 10, 0.5, 0.2)}},
      {"dull", {floats("specular", {0})}},
      {"sheet", {floats("transmission", {1})}},
      {"half sheet", {floats("transmission", {0.5})}},
      {"solid", {floats("transmission", {1}), boolean("thin", false)}},
      {"half solid", {floats("transmission", {0.5}), boolean("thin", false)}},
      {"bubble", {floats("transmission", {1}), floats("ior", {0.7}), boolean("thin", false)}},
      {"dull solid", {floats("transmission", {1}), floats("specular", {0}), boolean("thin", false)}},
      {"coat", {floats("clearcoat", {1})}},
      {"rough coat", {floats("clearcoat", {0.8}), floats("clearcoatroughness", {0.6})}},
      {"coated metal", {floats("clearcoat", {1}), floats("metallic", {1})}},
      {"sheen", {rgb("sheencolor", 1, 1, 1), floats("sheenroughness", {0.5})}},
      {"sharp sheen", {rgb("sheencolor", 1, 0.8, 0.3), floats("sheenroughness", {0})}},
      {"stretched", {floats("anisotropy", {0.7}), floats("anisotropyrotation", {30})}},
      {"stretched metal", {floats("anisotropy", {1}), floats("metallic", {1})}},
      {"stretched sheet", {floats("anisotropy", {0.7}), floats("transmission", {1})}},
      {"stretched solid", {floats("anisotropy", {0.7}), floats("transmission", {1}), boolean("thin", false)}},
      {"half there", {floats("opacity", {0.5})}},
      {"all",
       {floats("metallic", {0.3}), floats("transmission", {0.4}), floats("clearcoat", {0.7}),
        floats("clearcoatroughness", {0.2}), rgb("sheencolor", 0.5, 0.6, 0.7), floats("sheenroughness", {0.3}),
        floats("anisotropy", {0.4}), floats("opacity", {0.8}), floats("specular", {0.7})}},
  };
  for (const auto& [name, parameters] : extensions) {
    double most = 0, least = 9;
    for (const double roughness : kRoughnesses) {
      const bool metal =
          std::any_of(parameters.begin(), parameters.end(), [](const Parameter& p) { return p.name == "metallic"; });
      ParameterList list = join({floats("roughness", {roughness})}, parameters);
      if (!metal) list = join({floats("metallic", {0})}, list);
      const auto made = make(list);
      for (const double cosine : kCosines) {
        for (const double phi : {0.0, 0.7, 1.57}) {
          const RGB f = furnace(*made.plugin, cosine, phi);
          for (int c = 0; c < 3; ++c) {
            const double x = static_cast<double>(f[c]);
            EXPECT_LE(x, 1.006) << name << " roughness " << roughness << " cosine " << cosine << " phi " << phi;
            if (x > most) most = x;
            if (x < least) least = x;
          }
        }
      }
    }
    std::printf("%-16s %.4f to %.4f\n", name, least, most);
  }
}

}  // namespace
}  // namespace whit
