// The effect plan: each effect switches on from the one statement that calls for it, and what the picture cannot show is
// not live.
#include "core/scene/effect_plan.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/scene/scene_text.h"

namespace whit {
namespace {

using test::Planned;

/// A scene of options and a world; the matte sphere in it calls for nothing.
std::string scene(const std::string& world, const std::string& options = "") {
  return options + "WorldBegin\nShape \"sphere\"\n" + world + "\nWorldEnd\n";
}

std::set<std::string> effects_of(const std::string& text) {
  const Planned planned(text);
  std::set<std::string> on;
  for (unsigned e = 0; e < static_cast<unsigned>(Effect::kCount); ++e) {
    if (planned.plan.live(static_cast<Effect>(e))) on.insert(effect_name(static_cast<Effect>(e)));
  }
  // Every live effect has a cause, every cause a live effect.
  std::set<std::string> caused;
  for (const EffectCause& cause : planned.plan.causes) caused.insert(effect_name(cause.effect));
  EXPECT_EQ(on, caused);
  return on;
}

using Effects = std::set<std::string>;

TEST(EffectPlan, NothingIsLiveUntilCalledFor) { EXPECT_EQ(effects_of(scene("")), Effects{}); }

TEST(EffectPlan, EachEffectHasItsStatement) {
  EXPECT_EQ(effects_of(scene("LightSource \"point\"")), Effects{"delta light"});
  EXPECT_EQ(effects_of(scene("LightSource \"distant\"")), Effects{"delta light"});
  EXPECT_EQ(effects_of(scene("LightSource \"infinite\"")), Effects{"environment light"});
  EXPECT_EQ(effects_of(scene("LightSource \"skybox\"")), Effects{"environment light"});
  EXPECT_EQ(effects_of(scene("AreaLightSource \"diffuse\" Shape \"disk\"")), Effects{"area light"});
  EXPECT_EQ(effects_of(scene("Material \"mirror\" Shape \"disk\"")), Effects{"mirror"});
  EXPECT_EQ(effects_of(scene("Material \"perfectglass\" Shape \"disk\"")), (Effects{"mirror", "refraction"}));
  EXPECT_EQ(effects_of(scene("Material \"plastic\" Shape \"disk\"")), Effects{"glossy"});
  EXPECT_EQ(effects_of(scene("Material \"none\" Shape \"disk\"")), Effects{"interface"});
  EXPECT_EQ(effects_of(scene("ObjectBegin \"o\" Shape \"disk\" ObjectEnd ObjectInstance \"o\"")),
            Effects{"instancing"});
  EXPECT_EQ(effects_of(scene("ActiveTransform EndTime Translate 1 0 0 ActiveTransform All Shape \"disk\"")),
            Effects{"motion blur"});
  EXPECT_EQ(
      effects_of(scene("", "ActiveTransform EndTime Translate 1 0 0 ActiveTransform All Camera \"perspective\"\n")),
      Effects{"motion blur"});
  EXPECT_EQ(effects_of(scene("", "Camera \"perspective\" \"float lensradius\" 0.1\n")), Effects{"depth of field"});
  EXPECT_EQ(effects_of(scene(
                "Texture \"t\" \"spectrum\" \"checkerboard\" Material \"matte\" \"texture Kd\" \"t\" Shape \"disk\"")),
            Effects{"texture filtering"});
  EXPECT_EQ(effects_of(scene(
                "Texture \"b\" \"float\" \"bilerp\" Material \"matte\" \"texture bumpmap\" \"b\" Shape \"disk\"")),
            Effects{"bump"});
  const char* mesh = "Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point P\" [0 0 0 1 0 0 0 1 0] ";
  EXPECT_EQ(effects_of(scene(std::string("Texture \"a\" \"float\" \"bilerp\" ") + mesh + "\"texture alpha\" \"a\"")),
            Effects{"alpha mask"});
  EXPECT_EQ(effects_of(scene(std::string(mesh) + "\"float shadowalpha\" 0")), Effects{"alpha mask"});
}

TEST(EffectPlan, FlagsOfThePipeline) {
  EXPECT_FALSE(Planned(scene("")).plan.needs_differentials);
  EXPECT_FALSE(Planned(scene("")).plan.needs_time);
  EXPECT_FALSE(Planned(scene("")).plan.needs_lens);
  EXPECT_TRUE(Planned(scene("", "Camera \"perspective\" \"float lensradius\" 0.1\n")).plan.needs_lens);
  EXPECT_TRUE(
      Planned(scene("ActiveTransform EndTime Rotate 9 0 0 1 ActiveTransform All Shape \"disk\"")).plan.needs_time);
  EXPECT_TRUE(
      Planned(scene("Texture \"b\" \"float\" \"bilerp\" Material \"matte\" \"texture bumpmap\" \"b\" Shape \"disk\""))
          .plan.needs_differentials);
}

TEST(EffectPlan, WhatNobodyNeedsIsNotLive) {
  const Planned planned(scene(R"(
      Texture "inner" "spectrum" "checkerboard"
      Texture "outer" "spectrum" "scale" "texture tex1" "inner"
      Texture "unused" "spectrum" "checkerboard"
      MakeNamedMaterial "used" "string type" "matte" "texture Kd" "outer"
      MakeNamedMaterial "idle" "string type" "mirror" "texture Kr" "unused"
      ObjectBegin "placed"
        NamedMaterial "used"
        Shape "disk"
      ObjectEnd
      ObjectBegin "never"
        Material "perfectglass"
        Shape "disk"
      ObjectEnd
      ObjectInstance "placed"
      LightSource "point" "rgb I" [0 0 0]
      LightSource "distant")"));
  const EffectPlan& plan = planned.plan;
  EXPECT_EQ(plan.texture_live, (std::vector<uint8_t>{1, 1, 0}));  // inner through outer
  EXPECT_EQ(plan.object_live, (std::vector<uint8_t>{1, 0}));
  EXPECT_EQ(plan.shape_live, (std::vector<uint8_t>{1, 1, 0}));
  EXPECT_EQ(plan.light_live, (std::vector<uint8_t>{0, 1}));  // a black light lights nothing
  size_t live_materials = 0;
  for (size_t i = 0; i < plan.material_live.size(); ++i) {
    live_materials += plan.material_live[i];
    const std::string& name = planned.description().materials[i].name;
    if (name.empty()) continue;
    EXPECT_EQ(plan.material_live[i], name == "used") << name;
  }
  EXPECT_EQ(live_materials, 2u);  // the default matte and "used"
  EXPECT_FALSE(plan.live(Effect::Mirror));
  EXPECT_FALSE(plan.live(Effect::Refraction));
  EXPECT_TRUE(plan.live(Effect::Instancing));
  EXPECT_TRUE(plan.live(Effect::TextureFiltering));
}

TEST(EffectPlan, AShapeWithAlphaZeroIsNotThere) {
  const Planned planned(
      scene("Material \"mirror\" Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point P\" [0 0 0 1 0 0 "
            "0 1 0] \"float alpha\" 0"));
  EXPECT_EQ(planned.plan.shape_live, (std::vector<uint8_t>{1, 0}));
  EXPECT_FALSE(planned.plan.live(Effect::Mirror));
}

TEST(EffectPlan, AnEmitterWithAlphaZeroIsKeptForItsLight) {
  // As in pbrt-v3, where it lights and cannot be seen. Its material is not needed.
  const std::string invisible =
      "Material \"mirror\" Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point P\" [0 0 0 1 0 0 0 1 0] \"float "
      "alpha\" 0 ";
  const std::string light = "AreaLightSource \"diffuse\" ";
  const Planned planned(scene(light + invisible));
  EXPECT_EQ(planned.plan.shape_live, (std::vector<uint8_t>{1, 1}));
  EXPECT_TRUE(planned.plan.live(Effect::AreaLight));
  EXPECT_TRUE(planned.plan.live(Effect::AlphaMask));
  EXPECT_FALSE(planned.plan.live(Effect::Mirror));
  // What moves lights nothing, so there is nothing to keep.
  const Planned moving(scene(light + "ActiveTransform EndTime Translate 1 0 0 " + invisible));
  EXPECT_EQ(moving.plan.shape_live, (std::vector<uint8_t>{1, 0}));
}

TEST(EffectPlan, ABlackLobeCallsForNothing) {
  EXPECT_EQ(effects_of(scene("Material \"perfectglass\" \"rgb Kr\" [0 0 0] Shape \"disk\"")), Effects{"refraction"});
  EXPECT_EQ(effects_of(scene("Material \"perfectglass\" \"rgb Kt\" [0 0 0] Shape \"disk\"")), Effects{"mirror"});
  EXPECT_EQ(effects_of(scene("Material \"mirror\" \"rgb Kr\" [0 0 0] Shape \"disk\"")), Effects{});
  EXPECT_EQ(effects_of(scene("Material \"plastic\" \"rgb Ks\" [0 0 0] Shape \"disk\"")), Effects{});
}

TEST(EffectPlan, CausesNameTheStatement) {
  const Planned planned("WorldBegin\nShape \"sphere\"\n  Material \"mirror\"\nShape \"disk\"\nWorldEnd\n");
  ASSERT_EQ(planned.plan.causes.size(), 1u);
  EXPECT_EQ(planned.sources.location(planned.plan.causes[0].where), "test.pbrt:3:3");
}

TEST(EffectPlan, MediaAreNamedAsNotSimulated) {
  EXPECT_TRUE(Planned(scene("")).plan.ignored.empty());
  EXPECT_EQ(Planned(scene("MakeNamedMedium \"fog\" \"string type\" \"homogeneous\"")).plan.ignored.size(), 1u);
}

}  // namespace
}  // namespace whit
