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
