// The effect plan: each effect switches on from the one statement that calls for it, and what the picture cannot show is
// not live.
#include "core/scene/effect_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "core/plugin/registry.h"
#include "tests/scene/scene_text.h"

namespace whit {
namespace {

using test::Planned;

/// A scene of options and a world; the matte sphere in it scatters.
std::string scene(const std::string& world, const std::string& options = "") {
  return options + "WorldBegin\nShape \"sphere\"\n" + world + "\nWorldEnd\n";
}

using Effects = std::set<std::string>;

Effects names_of(const EffectSet& set) {
  Effects names;
  for_effects(set, [&](Effect e) { names.insert(effect_name(e)); });
  return names;
}

/// What a scene needs beyond diffuse surfaces.
Effects effects_of(const std::string& text, const PlanOptions& options = {}) {
  const Planned planned(text, Planned::Warnings::Failures, options);
  // Every effect that is called for has a cause, every cause an effect.
  for_effects(EffectSet::all(), [&](Effect e) {
    EXPECT_EQ(planned.plan.called_for.has(e), planned.plan.use(e).count > 0) << effect_name(e);
    EXPECT_EQ(planned.plan.use(e).causes.size(), std::min(planned.plan.use(e).count, EffectUse::kNamed));
  });
  EXPECT_TRUE(planned.plan.needed.has(Effect::Diffuse));
  return names_of(planned.plan.needed - EffectSet{Effect::Diffuse});
}

TEST(EffectPlan, NothingIsLiveUntilCalledFor) { EXPECT_EQ(effects_of(scene("")), Effects{}); }

TEST(EffectPlan, EachEffectHasItsStatement) {
  EXPECT_EQ(effects_of(scene("LightSource \"point\"")), (Effects{"delta-lights", "shadows"}));
  EXPECT_EQ(effects_of(scene("LightSource \"distant\"")), (Effects{"delta-lights", "shadows"}));
  EXPECT_EQ(effects_of(scene("LightSource \"infinite\"")), (Effects{"environment-lights", "shadows"}));
  EXPECT_EQ(effects_of(scene("LightSource \"skybox\"")), (Effects{"environment-lights", "shadows"}));
  EXPECT_EQ(effects_of(scene("AreaLightSource \"diffuse\" Shape \"disk\"")), (Effects{"area-lights", "shadows"}));
  EXPECT_EQ(effects_of(scene("AreaLightSource \"diffuse\" \"rgb L\" [0 0 0] Shape \"disk\"")), Effects{});
  EXPECT_EQ(effects_of(scene("Material \"mirror\" Shape \"disk\"")), Effects{"reflection"});
  EXPECT_EQ(effects_of(scene("Material \"perfectglass\" Shape \"disk\"")), (Effects{"reflection", "refraction"}));
  EXPECT_EQ(effects_of(scene("Material \"plastic\" Shape \"disk\"")), Effects{"glossy"});
  EXPECT_EQ(effects_of(scene("Material \"none\" Shape \"disk\"")), Effects{"interfaces"});
  EXPECT_EQ(effects_of(scene("ObjectBegin \"o\" Shape \"disk\" ObjectEnd ObjectInstance \"o\"")),
            Effects{"instancing"});
  EXPECT_EQ(effects_of(scene("ActiveTransform EndTime Translate 1 0 0 ActiveTransform All Shape \"disk\"")),
            Effects{"motion-blur"});
  EXPECT_EQ(
      effects_of(scene("", "ActiveTransform EndTime Translate 1 0 0 ActiveTransform All Camera \"perspective\"\n")),
      Effects{"motion-blur"});
  EXPECT_EQ(effects_of(scene("", "Camera \"perspective\" \"float lensradius\" 0.1\n")), Effects{"depth-of-field"});
}

TEST(EffectPlan, TexturesAreFilteredForSurfacesAlone) {
  const auto matte = [](const std::string& texture) {
    return scene("Texture \"t\" \"spectrum\" " + texture + " Material \"matte\" \"texture Kd\" \"t\" Shape \"disk\"");
  };
  EXPECT_EQ(effects_of(matte("\"checkerboard\"")), (Effects{"textures", "texture-filtering"}));
  EXPECT_EQ(effects_of(matte("\"checkerboard\" \"string aamode\" \"none\"")), Effects{"textures"});
  EXPECT_EQ(effects_of(matte("\"constant\"")), Effects{});
  EXPECT_EQ(effects_of(matte("\"checkerboard\" \"rgb tex2\" [1 1 1]")), Effects{});  // the same as its tex1
  const std::string bumps = "Texture \"b\" \"float\" \"bilerp\" Material \"matte\" \"texture bumpmap\" \"b\" ";
  EXPECT_EQ(effects_of(scene(bumps + "Shape \"disk\"")), (Effects{"bump", "textures"}));
  // Alpha is looked up for rays, which have no footprint.
  const std::string mesh = "Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point P\" [0 0 0 1 0 0 0 1 0] ";
  const std::string mask = "Texture \"a\" \"float\" \"checkerboard\" ";
  EXPECT_EQ(effects_of(scene(mask + mesh + "\"texture alpha\" \"a\"")), (Effects{"alpha", "textures"}));
  EXPECT_EQ(effects_of(scene(mask + mesh + "\"texture shadowalpha\" \"a\"")), (Effects{"alpha", "textures"}));
  EXPECT_EQ(
      effects_of(scene(mask + mesh + "\"texture alpha\" \"a\" Material \"matte\" \"texture sigma\" \"a\" " + mesh)),
      (Effects{"alpha", "textures", "texture-filtering"}));
  EXPECT_EQ(effects_of(scene(mesh + "\"float shadowalpha\" 0")), Effects{"alpha"});
}

TEST(EffectPlan, FlagsOfThePipeline) {
  EXPECT_FALSE(Planned(scene("")).plan.needs_differentials());
  const std::string bump =
      "Texture \"b\" \"float\" \"bilerp\" Material \"matte\" \"texture bumpmap\" \"b\" Shape \"disk\"";
  EXPECT_TRUE(Planned(scene(bump)).plan.needs_differentials());
  // What is switched off runs no stage, and a render of everything runs all of them at the same needs.
  const auto plan = [](const PlanOptions& options) {
    return Planned(scene("LightSource \"point\""), Planned::Warnings::Failures, options).plan;
  };
  EXPECT_FALSE(plan({.off = {Effect::Shadows}}).live(Effect::Shadows));
  EXPECT_TRUE(plan({.off = {Effect::Shadows}}).called_for.has(Effect::Shadows));
  EXPECT_EQ(plan({.off = {Effect::Shadows}}).use(Effect::Shadows).why_off, "switched off");
  EXPECT_TRUE(plan({.everything_on = true}).live(Effect::MotionBlur));
  EXPECT_EQ(plan({.everything_on = true}).needed, plan({}).needed);
}

TEST(EffectPlan, WhereNothingScattersLightsAreNotSampled) {
  const std::string glass = "WorldBegin Material \"perfectglass\" Shape \"sphere\" %s WorldEnd\n";
  const auto plan = [&](const std::string& light) {
    std::string text = glass;
    return Planned(text.replace(text.find("%s"), 2, light)).plan;
  };
  const EffectPlan point = plan("LightSource \"point\""), sky = plan("LightSource \"infinite\"");
  const EffectPlan area = plan("AreaLightSource \"diffuse\" Shape \"disk\"");
  for (const EffectPlan* p : {&point, &sky, &area}) {
    EXPECT_FALSE(p->direct_light);
    EXPECT_FALSE(p->live(Effect::Shadows));
  }
  EXPECT_EQ(point.light_live, (std::vector<uint8_t>{0}));
  EXPECT_EQ(point.use(Effect::DeltaLights).why_off, "no surface scatters their light");
  EXPECT_EQ(sky.light_live, (std::vector<uint8_t>{1}));  // rays that leave see it
  EXPECT_TRUE(area.live(Effect::AreaLights));            // and this is seen
  // What moves does not emit, as in pbrt-v3; what is in objects or is a curve glows and lights nothing.
  const std::string moving = "AreaLightSource \"diffuse\" ActiveTransform EndTime Translate 1 0 0 Shape \"disk\"";
  EXPECT_EQ(effects_of(scene(moving)), Effects{"motion-blur"});
  EXPECT_EQ(effects_of(scene(moving), {.off = {Effect::MotionBlur}}), (Effects{"area-lights", "shadows"}));
  for (const char* glows :
       {"ObjectBegin \"o\" AreaLightSource \"diffuse\" Shape \"disk\" ObjectEnd ObjectInstance \"o\"",
        "AreaLightSource \"diffuse\" Shape \"curve\" \"point P\" [0 0 0 1 0 0 2 0 0 3 0 0]"}) {
    const Planned planned(scene(glows), Planned::Warnings::Allowed);
    EXPECT_TRUE(planned.plan.live(Effect::AreaLights)) << glows;
    EXPECT_FALSE(planned.plan.direct_light) << glows;
  }
}

TEST(EffectPlan, AMirrorAtMaxdepthOneSpawnsNothing) {
  const std::string world = "WorldBegin Material \"mirror\" Shape \"sphere\" WorldEnd\n";
  const EffectPlan plan = Planned("Integrator \"whitted\" \"integer maxdepth\" 1 " + world).plan;
  EXPECT_TRUE(plan.called_for.has(Effect::Reflection));
  EXPECT_FALSE(plan.live(Effect::Reflection));
  EXPECT_EQ(plan.use(Effect::Reflection).why_off, "\"maxdepth\" allows no bounce");
  EXPECT_TRUE(Planned("Integrator \"whitted\" \"integer maxdepth\" 2 " + world).plan.live(Effect::Reflection));
}

TEST(EffectPlan, EachEffectCanBeSwitchedOff) {
  // One scene that calls for all of them.
  const std::string all = scene(R"(
      LightSource "point" LightSource "skybox"
      Texture "c" "spectrum" "checkerboard" Texture "b" "float" "windy"
      ObjectBegin "o" Shape "disk" ObjectEnd ObjectInstance "o"
      Material "perfectglass" Shape "sphere"
      Material "none" Shape "sphere"
      Material "plastic" "texture Kd" "c" "texture bumpmap" "b"
      Shape "trianglemesh" "integer indices" [0 1 2] "point P" [0 0 0 1 0 0 0 1 0] "float shadowalpha" 0
      AreaLightSource "diffuse" Shape "disk"
      ActiveTransform EndTime Translate 1 0 0 ActiveTransform All AreaLightSource "" Shape "disk")",
                                "Integrator \"path\"\nCamera \"perspective\" \"float lensradius\" 0.1\n");
  EXPECT_EQ(Planned(all).plan.needed, EffectSet::all());
  for_effects(EffectSet::all(), [&](Effect e) {
    const EffectPlan plan = Planned(all, Planned::Warnings::Failures, {.off = {e}}).plan;
    EXPECT_TRUE(plan.called_for.has(e)) << effect_name(e);
    EXPECT_FALSE(plan.live(e)) << effect_name(e);
    // Textures go with what they are for, and filtering goes with textures.
    EffectSet gone{e};
    if (e == Effect::Textures) gone = {Effect::Textures, Effect::TextureFiltering, Effect::Bump};
    EXPECT_EQ(names_of(EffectSet::all() - plan.needed), names_of(gone)) << effect_name(e);
  });
}

TEST(EffectPlan, AWrongMaterialIsPlannedAsTheDefaultOneItIsShownAs) {
  const std::string text =
      "WorldBegin Material \"glass\" \"float index\" -1 Shape \"sphere\" LightSource \"point\" WorldEnd";
  const Planned planned(text, Planned::Warnings::Allowed);
  ASSERT_TRUE(planned.warnings.has_errors());
  EXPECT_EQ(names_of(planned.plan.needed), (Effects{"diffuse", "delta-lights", "shadows"}));
}

TEST(EffectPlan, NamesAreReadBack) {
  std::string unknown;
  EXPECT_EQ(parse_effects("bump,motion-blur", unknown), (EffectSet{Effect::Bump, Effect::MotionBlur}));
  for_effects(EffectSet::all(), [&](Effect e) { EXPECT_EQ(parse_effects(effect_name(e), unknown), EffectSet{e}); });
  EXPECT_EQ(unknown, "");
  for (const char* wrong : {"", "bumps", "bump,", ",bump", "bump, alpha"}) {
    unknown.assign(1, '?');
    EXPECT_TRUE(parse_effects(wrong, unknown).empty()) << wrong;
    EXPECT_NE(unknown, "?") << wrong;
  }
}

TEST(EffectPlan, TexturesThatNoParameterReadsAreNotLive) {
  const auto live = [](const std::string& material) {
    return Planned(scene("Texture \"t\" \"float\" \"windy\" Texture \"c\" \"spectrum\" \"windy\" Material " + material +
                         " Shape \"disk\""))
        .plan.texture_live;
  };
  using Live = std::vector<uint8_t>;
  constexpr uint8_t kOn = 3;  // seen, and seen by surfaces
  EXPECT_EQ(live("\"glass\" \"texture index\" \"t\""), (Live{kOn, 0}));
  EXPECT_EQ(live("\"glass\" \"texture index\" \"t\" \"float eta\" 1.3"), (Live{0, 0}));
  EXPECT_EQ(live("\"uber\" \"texture index\" \"t\" \"float eta\" 1.3"), (Live{0, 0}));
  EXPECT_EQ(live("\"uber\" \"texture roughness\" \"t\""), (Live{kOn, 0}));
  EXPECT_EQ(live("\"uber\" \"texture roughness\" \"t\" \"float uroughness\" 0.1"), (Live{0, 0}));
  EXPECT_EQ(live("\"metal\" \"texture roughness\" \"t\" \"float uroughness\" 0.1"), (Live{kOn, 0}));
  EXPECT_EQ(live("\"metal\" \"texture roughness\" \"t\" \"float uroughness\" 0.1 \"float vroughness\" 0.1"),
            (Live{0, 0}));
  EXPECT_EQ(live("\"plastic\" \"texture roughness\" \"t\" \"rgb Ks\" [0 0 0]"), (Live{0, 0}));
  EXPECT_EQ(live("\"subsurface\" \"texture sigma_a\" \"c\" \"texture uroughness\" \"t\""), (Live{kOn, 0}));
  EXPECT_EQ(live("\"kdsubsurface\" \"texture Kd\" \"c\" \"texture mfp\" \"c\""), (Live{0, 0}));
}

TEST(EffectPlan, TexturesOfLobesThatAreAbsentAreNotLive) {
  // Each material with textures that only a lobe it lacks would read: nothing is textured, and nothing filtered.
  for (const char* material :
       {"\"uber\" \"rgb Ks\" [0 0 0] \"texture roughness\" \"t\" \"texture index\" \"t\"",
        "\"uber\" \"rgb opacity\" [0 0 0] \"texture Kd\" \"c\" \"texture Ks\" \"c\" \"texture index\" \"t\"",
        "\"translucent\" \"rgb Ks\" [0 0 0] \"texture roughness\" \"t\"",
        "\"translucent\" \"rgb reflect\" [0 0 0] \"rgb transmit\" [0 0 0] \"texture Kd\" \"c\" \"texture roughness\" "
        "\"t\"",
        "\"substrate\" \"rgb Kd\" [0 0 0] \"rgb Ks\" [0 0 0] \"texture uroughness\" \"t\"",
        "\"glass\" \"rgb Kr\" [0 0 0] \"rgb Kt\" [0 0 0] \"texture uroughness\" \"t\" \"texture index\" \"t\"",
        "\"perfectglass\" \"rgb Kr\" [0 0 0] \"rgb Kt\" [0 0 0] \"texture index\" \"t\"",
        "\"subsurface\" \"rgb Kr\" [0 0 0] \"rgb Kt\" [0 0 0] \"texture uroughness\" \"t\"",
        "\"matte\" \"rgb Kd\" [0 0 0] \"texture sigma\" \"t\"",
        "\"disney\" \"texture clearcoatgloss\" \"t\" \"texture flatness\" \"t\" \"texture difftrans\" \"t\"",
        "\"disney\" \"float metallic\" 1 \"texture sheen\" \"t\" \"texture sheentint\" \"t\"",
        "\"matte\" \"rgb Kd\" [0 0 0] \"texture bumpmap\" \"t\"",
        "\"metallicroughness\" \"texture specular\" \"t\" \"float metallic\" 1 \"texture transmission\" \"t\"",
        "\"metallicroughness\" \"texture clearcoatroughness\" \"t\" \"texture sheenroughness\" \"t\"",
        "\"metallicroughness\" \"float opacity\" 0 \"texture basecolor\" \"c\" \"texture roughness\" \"t\"",
        "\"metallicroughness\" \"float metallic\" 0 \"float specular\" 0 \"texture roughness\" \"t\" \"texture "
        "specularcolor\" \"c\" \"texture anisotropyrotation\" \"t\"",
        "\"hair\" \"rgb sigma_a\" [1 1 1] \"texture color\" \"c\" \"texture eumelanin\" \"t\""}) {
    const Planned planned(scene("Texture \"t\" \"float\" \"windy\" Texture \"c\" \"spectrum\" \"windy\" Material " +
                                std::string(material) + " Shape \"disk\""),
                          Planned::Warnings::Allowed);
    EXPECT_FALSE(planned.warnings.has_errors()) << material;
    EXPECT_EQ(planned.plan.texture_live, (std::vector<uint8_t>{0, 0})) << material;
    EXPECT_FALSE(planned.plan.live(Effect::TextureFiltering)) << material;
    EXPECT_FALSE(planned.plan.needs_differentials()) << material;
  }
  EXPECT_EQ(effects_of(scene("Material \"disney\" \"float metallic\" 1 Shape \"disk\"")), Effects{"glossy"});
}

TEST(EffectPlan, TexturesOfTexturesThatAreNotAskedForAreNotLive) {
  const auto live = [](const std::string& texture) {
    return Planned(scene("Texture \"a\" \"spectrum\" \"windy\" Texture \"b\" \"spectrum\" \"windy\" Texture \"t\" "
                         "\"spectrum\" " +
                         texture + " Material \"matte\" \"texture Kd\" \"t\" Shape \"disk\""))
        .plan.texture_live;
  };
  using Live = std::vector<uint8_t>;
  const std::string both = "\"mix\" \"texture tex1\" \"a\" \"texture tex2\" \"b\" ";
  EXPECT_EQ(live(both), (Live{3, 3, 3}));
  EXPECT_EQ(live(both + "\"float amount\" 0"), (Live{3, 0, 3}));
  EXPECT_EQ(live(both + "\"float amount\" 1"), (Live{0, 3, 3}));
  EXPECT_EQ(live("\"scale\" \"texture tex1\" \"a\""), (Live{3, 0, 3}));
  EXPECT_EQ(live("\"scale\" \"texture tex1\" \"a\" \"rgb tex2\" [0 0 0]"), (Live{0, 0, 0}));  // black
}

/// A mix has the map of its first member, be it a bump or a normal map: `texture` is its statement's beginning, `map` the
/// material that wears it.
void expect_map_of_first_member(const std::string& texture, const std::string& map) {
  const auto plan = [&](const std::string& order) {
    return Planned(scene("Texture \"waves\" " + texture + R"(
        MakeNamedMaterial "flat" "string type" "matte"
        MakeNamedMaterial "rough" "string type" )" +
                         map + " Material \"mix\" " + order + " Shape \"disk\""))
        .plan;
  };
  const EffectPlan flat = plan(R"("string namedmaterial1" "flat" "string namedmaterial2" "rough")");
  EXPECT_FALSE(flat.called_for.has(Effect::Bump));
  EXPECT_EQ(flat.texture_live, std::vector<uint8_t>{0});
  const EffectPlan rough = plan(R"("string namedmaterial1" "rough" "string namedmaterial2" "flat")");
  EXPECT_TRUE(rough.live(Effect::Bump));
  EXPECT_EQ(rough.texture_live, std::vector<uint8_t>{3});
}

TEST(EffectPlan, AMixHasTheBumpMapOfItsFirstMember) {
  expect_map_of_first_member(R"("float" "windy")", R"("matte" "texture bumpmap" "waves")");
}

TEST(EffectPlan, AMixHasTheNormalMapOfItsFirstMember) {
  expect_map_of_first_member(R"("spectrum" "windy")", R"("metallicroughness" "texture normalmap" "waves")");
}

TEST(EffectPlan, ANormalMapIsABumpMap) {
  const std::string maps = "Texture \"n\" \"spectrum\" \"windy\" Material \"metallicroughness\" ";
  const auto plan = [&](const std::string& parameters) {
    return Planned(scene(maps + parameters + " Shape \"disk\"")).plan;
  };
  const EffectPlan mapped = plan("\"texture normalmap\" \"n\"");
  EXPECT_TRUE(mapped.live(Effect::Bump));
  EXPECT_TRUE(mapped.needs_differentials());
  EXPECT_EQ(mapped.texture_live, std::vector<uint8_t>{3});
  EXPECT_TRUE(plan("\"rgb normalmap\" [0.6 0.5 1]").live(Effect::Bump)) << "tilted everywhere";
  EXPECT_FALSE(plan("\"rgb normalmap\" [0.5 0.5 1]").called_for.has(Effect::Bump));
  PlanOptions flat;
  flat.off = {Effect::Bump};
  const Planned off(scene(maps + "\"texture normalmap\" \"n\" Shape \"disk\""), Planned::Warnings::Failures, flat);
  EXPECT_FALSE(off.plan.live(Effect::Bump));
  EXPECT_EQ(off.plan.texture_live, std::vector<uint8_t>{0});
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
  EXPECT_EQ(plan.texture_live, (std::vector<uint8_t>{3, 3, 0}));  // inner through outer
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
  EXPECT_FALSE(plan.live(Effect::Reflection));
  EXPECT_FALSE(plan.live(Effect::Refraction));
  EXPECT_TRUE(plan.live(Effect::Instancing));
  EXPECT_TRUE(plan.live(Effect::TextureFiltering));
}

TEST(EffectPlan, AShapeWithAlphaZeroIsNotThere) {
  const Planned planned(
      scene("Material \"mirror\" Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point P\" [0 0 0 1 0 0 "
            "0 1 0] \"float alpha\" 0"));
  EXPECT_EQ(planned.plan.shape_live, (std::vector<uint8_t>{1, 0}));
  EXPECT_FALSE(planned.plan.live(Effect::Reflection));
}

TEST(EffectPlan, AnEmitterWithAlphaZeroIsKeptForItsLight) {
  // As in pbrt-v3, where it lights and cannot be seen. Its material is not needed.
  const std::string invisible =
      "Material \"mirror\" Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point P\" [0 0 0 1 0 0 0 1 0] \"float "
      "alpha\" 0 ";
  const std::string light = "AreaLightSource \"diffuse\" ";
  const Planned planned(scene(light + invisible));
  EXPECT_EQ(planned.plan.shape_live, (std::vector<uint8_t>{1, 1}));
  EXPECT_TRUE(planned.plan.live(Effect::AreaLights));
  EXPECT_TRUE(planned.plan.live(Effect::Alpha));
  EXPECT_FALSE(planned.plan.live(Effect::Reflection));
  // What moves lights nothing, so there is nothing to keep.
  const Planned moving(scene(light + "ActiveTransform EndTime Translate 1 0 0 " + invisible));
  EXPECT_EQ(moving.plan.shape_live, (std::vector<uint8_t>{1, 0}));
}

TEST(EffectPlan, ABlackLobeCallsForNothing) {
  EXPECT_EQ(effects_of(scene("Material \"perfectglass\" \"rgb Kr\" [0 0 0] Shape \"disk\"")), Effects{"refraction"});
  EXPECT_EQ(effects_of(scene("Material \"perfectglass\" \"rgb Kt\" [0 0 0] Shape \"disk\"")), Effects{"reflection"});
  EXPECT_EQ(effects_of(scene("Material \"mirror\" \"rgb Kr\" [0 0 0] Shape \"disk\"")), Effects{});
  EXPECT_EQ(effects_of(scene("Material \"plastic\" \"rgb Ks\" [0 0 0] Shape \"disk\"")), Effects{});
}

TEST(EffectPlan, CausesNameTheStatement) {
  const Planned planned("WorldBegin\nShape \"sphere\"\n  Material \"mirror\"\nShape \"disk\"\nWorldEnd\n");
  const EffectUse& use = planned.plan.use(Effect::Reflection);
  ASSERT_EQ(use.causes.size(), 1u);
  EXPECT_EQ(use.causes[0].what, "mirror");
  EXPECT_EQ(planned.sources.location(use.causes[0].where), "test.pbrt:3:3");
}

/// An integrator that somebody else has made.
struct NoLight : Integrator {
  void shade(Rays&, Transport&) const override {}
  int max_depth() const override { return 1; }
  int dimensions(int) const override { return 0; }
};
const Register<NoLight> no_light{"nolight", "For a test."};

TEST(EffectPlan, AnIntegratorThatIsRegisteredIsSimulated) {
  const Planned planned(scene("", "Integrator \"nolight\"\n"));
  EXPECT_TRUE(planned.plan.ignored.empty());
  EXPECT_NE(dynamic_cast<const NoLight*>(planned.bound.integrator.plugin.get()), nullptr);
}

TEST(EffectPlan, WhatIsNotSimulatedIsNamed) {
  EXPECT_TRUE(Planned(scene("")).plan.ignored.empty());
  const auto ignored = [](const std::string& text) {
    const Planned planned(text, Planned::Warnings::Allowed);
    std::vector<std::string> out;
    for (const Ignored& i : planned.plan.ignored) out.push_back(i.what + " at " + planned.sources.location(i.where));
    return out;
  };
  using Names = std::vector<std::string>;
  EXPECT_EQ(ignored(scene("MakeNamedMedium \"fog\" \"string type\" \"homogeneous\"\nMediumInterface \"fog\" \"\"")),
            Names{"participating media at test.pbrt:3:1"});
  EXPECT_EQ(ignored(scene("", "Integrator \"bdpt\"\nAccelerator \"kdtree\"\n")),
            Names{"integrator \"bdpt\" at test.pbrt:1:1"});  // the accelerator has no part in the picture
}

}  // namespace
}  // namespace whit
