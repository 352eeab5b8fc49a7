// Which lobes and effects subsurface, kdsubsurface, disney, hair and fourier have, and what they say about mistakes.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "core/lobe/eval.h"
#include "core/lobe/hair.h"
#include "core/plugin/material.h"
#include "tests/plugin/shading_points.h"
#include "tests/plugins/make_plugin.h"

namespace whit {
namespace {

using test::floats;
using test::make_plugin;
using test::rgb;
using test::ShadingPoints;

using Types = std::multiset<LobeType>;

Types types_of(const Material& material, ShadingPoints& points) {
  LobeSet set(points.arena);
  material.lobes(points.s, set);
  Types types;
  for (int k = 0; k < set.count; ++k) types.insert(set.lobes[k].type);
  return types;
}

Types disney_types(ParameterList parameters) {
  ShadingPoints points(1);
  return types_of(*make_plugin<Material>("material", "disney", std::move(parameters)).plugin, points);
}

TEST(Subsurface, IsItsBoundary) {
  for (const char* name : {"subsurface", "kdsubsurface"}) {
    ShadingPoints points(1);
    const auto smooth = make_plugin<Material>("material", name);
    EXPECT_EQ(types_of(*smooth.plugin, points), (Types{LobeType::SpecularReflection, LobeType::SpecularTransmission}));
    EXPECT_TRUE(smooth->effects().has(Effect::Reflection) && smooth->effects().has(Effect::Refraction));
    LobeSet set(points.arena);
    smooth->lobes(points.s, set);
    EXPECT_EQ(set.eta[0], 1.33f);
    const auto rough = make_plugin<Material>("material", name, {floats("uroughness", {0.2}), rgb("Kr", 0, 0, 0)});
    EXPECT_EQ(types_of(*rough.plugin, points), Types{LobeType::MicrofacetTransmission});
    EXPECT_FALSE(rough->effects().has(Effect::Refraction));
  }
}

TEST(Subsurface, AMisspeltMediumIsFound) {
  EXPECT_TRUE(make_plugin<Material>("material", "subsurface", {test::text("name", "Skin1")}).silent());
  const auto wrong = make_plugin<Material>("material", "subsurface", {test::text("name", "Ketchupp")});
  ASSERT_EQ(wrong.diagnostics.all().size(), 1u);
  EXPECT_NE(wrong.diagnostics.all()[0].remedy.find("Ketchup"), std::string::npos);
}

TEST(Disney, HasTheLobesItsParametersCallFor) {
  using enum LobeType;
  EXPECT_EQ(disney_types({}), (Types{DisneyDiffuse, DisneyRetro, DisneyReflection}));
  EXPECT_EQ(disney_types({floats("sheen", {1}), floats("clearcoat", {1})}),
            (Types{DisneyDiffuse, DisneyRetro, DisneySheen, DisneyReflection, DisneyClearcoat}));
  EXPECT_EQ(disney_types({floats("metallic", {1}), floats("sheen", {1})}), Types{DisneyReflection});
  EXPECT_EQ(disney_types({floats("spectrans", {0.5})}),
            (Types{DisneyDiffuse, DisneyRetro, DisneyReflection, DisneyTransmission}));
  EXPECT_EQ(disney_types({rgb("scatterdistance", 1, 0, 0)}),
            (Types{SpecularTransmission, DisneyRetro, DisneyReflection}));
  EXPECT_EQ(disney_types({test::boolean("thin", true), floats("spectrans", {0.5}), floats("flatness", {0.5})}),
            (Types{DisneyDiffuse, DisneyFakeSubsurface, DisneyRetro, DisneyReflection, MicrofacetTransmission,
                   LambertTransmission}));
}

TEST(Disney, OnlyScatteringInsideRefracts) {
  const auto inside = make_plugin<Material>("material", "disney", {rgb("scatterdistance", 1, 0, 0)});
  EXPECT_TRUE(inside->effects().has(Effect::Refraction));
  const auto thin =
      make_plugin<Material>("material", "disney", {rgb("scatterdistance", 1, 0, 0), test::boolean("thin", true)});
  EXPECT_FALSE(thin->effects().has(Effect::Refraction));
}

/// The one lobe of a hair with parameters.
Lobe hair_lobe(const ParameterList& parameters, ShadingPoints& points) {
  LobeSet set(points.arena);
  make_plugin<Material>("material", "hair", parameters)->lobes(points.s, set);
  EXPECT_EQ(set.count, 1);
  return set.lobes[0];
}

TEST(Hair, AbsorptionComesFromTheFirstColourGiven) {
  ShadingPoints points(1);
  const RGB brown = hair_lobe({}, points).colour1[0];
  EXPECT_NEAR(brown.x, 1.3 * 0.419, 1e-6);
  const RGB red = hair_lobe({floats("pheomelanin", {2})}, points).colour1[0];
  EXPECT_NEAR(red.y, 2 * 0.4, 1e-6) << "no eumelanin unless it is given";
  EXPECT_EQ(hair_lobe({rgb("sigma_a", 0, 0, 0)}, points).colour1[0], RGB(0, 0, 0)) << "clear hair";
  // (log 0.5 / 5.7183)^2 with 5.969 - 0.0645 + 0.22788 - 0.28971 + 0.045149 + 0.000595 = 5.888414 at beta_n 0.3.
  EXPECT_NEAR(hair_lobe({rgb("color", 0.5, 0, 1)}, points).colour1[0].x, std::pow(std::log(0.5) / 5.888414, 2), 1e-6);
  EXPECT_EQ(hair_lobe({rgb("color", 0.5, 0, 1)}, points).colour1[0].z, 0);
  EXPECT_TRUE(std::isfinite(hair_lobe({rgb("color", 0.5, 0, 1)}, points).colour1[0].y));
}

TEST(Hair, AnIgnoredColourIsReported) {
  EXPECT_TRUE(
      make_plugin<Material>("material", "hair", {floats("eumelanin", {1}), floats("pheomelanin", {1})}).silent());
  const auto two = make_plugin<Material>("material", "hair", {rgb("color", 0.5, 0.5, 0.5), floats("eumelanin", {1})});
  EXPECT_EQ(two.diagnostics.all().size(), 1u);
  EXPECT_FALSE(two.diagnostics.has_errors());
}

TEST(Hair, OffsetComesFromV) {
  ShadingPoints points(3);
  points.set_flat(0, 0, 0), points.set_flat(1, 0, 0.75f), points.set_flat(2, 0, 7);
  const Lobe lobe = hair_lobe({}, points);
  EXPECT_EQ(lobe.a[0], -1);
  EXPECT_EQ(lobe.a[1], 0.5f);
  EXPECT_EQ(lobe.a[2], 1) << "beyond the hair's edge";
}

TEST(Fourier, NeedsItsFile) {
  EXPECT_TRUE(make_plugin<Material>("material", "fourier").diagnostics.has_errors());
  auto wrong = make_plugin<Material>("material", "fourier", {test::text("bsdffile", WHIT_SOURCE_DIR "/README.md")});
  ASSERT_TRUE(wrong.good());
  EXPECT_FALSE(wrong.prepare());
  ASSERT_EQ(wrong.diagnostics.all().size(), 1u);
  EXPECT_EQ(wrong.diagnostics.all()[0].error_class, ErrorClass::File);
  EXPECT_EQ(wrong.plugin, nullptr) << "there is nothing to shade with";
}

}  // namespace
}  // namespace whit
