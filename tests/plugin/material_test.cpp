// What every registered material must hold, and what the single ones promise.
#include "core/plugin/material.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <optional>
#include <random>
#include <set>

#include "core/lobe/eval.h"
#include "core/lobe/formulas.h"
#include "core/plugin/registry.h"
#include "tests/plugin/shading_points.h"
#include "tests/plugins/make_plugin.h"

namespace whit {
namespace {

using test::make_plugin;
using test::ShadingPoints;

std::unique_ptr<Material> make_default(const PluginInfo& info) {
  std::unique_ptr<Plugin> plugin = info.make();
  return std::unique_ptr<Material>(dynamic_cast<Material*>(plugin.release()));
}

/// Everything the renderer asks of a material at points, in one row of floats a point.
std::vector<float> answers(const Material& material, const ShadingBatch& s, const Vec3Lanes& light) {
  LobeSet set(*s.arena);
  material.lobes(s, set);
  const float* const half = Tex<float>(0.5f)(s);
  const RGBLanes f = s.arena->rgb(s.n), r = s.arena->rgb(s.n), t = s.arena->rgb(s.n), g = s.arena->rgb(s.n);
  const Vec3Lanes wr = s.arena->vec3(s.n), wt = s.arena->vec3(s.n), wg = s.arena->vec3(s.n);
  float* const pdf = s.arena->floats(s.n);
  eval_lobes(set, s, prepare_frame(set, s), light, f);
  specular_reflection(set, s, half, wr, r);
  specular_transmission(set, s, half, wt, t);
  sample_lobes(set, s, prepare_frame(set, s), half, half, half, LobeKinds::NonSpecular, {wg, g, pdf});
  std::vector<float> out;
  for (int i = 0; i < s.n; ++i) {
    for (const RGBLanes& c : {f, r, t, g}) out.insert(out.end(), {c.r[i], c.g[i], c.b[i]});
    for (const Vec3Lanes& v : {wr, wt, wg}) out.insert(out.end(), {v.x[i], v.y[i], v.z[i]});
    out.push_back(pdf[i]);
  }
  return out;
}

TEST(EveryMaterial, BatchOfNEqualsNBatchesOfOne) {
  const auto materials = list_plugins("material");
  EXPECT_GE(materials.size(), 6u);
  for (const PluginInfo* info : materials) {
    const auto material = make_default(*info);
    ASSERT_TRUE(material) << info->name;
    ShadingPoints points(61);
    points.randomise(1);
    ShadingPoints lights(61);
    lights.randomise(2);
    const std::vector<float> together = answers(*material, points.s, lights.s.wo);
    std::vector<float> alone;
    for (int i = 0; i < points.s.n; ++i) {
      const auto one = answers(*material, points.s.range(i, 1), lights.s.wo.from(i));
      alone.insert(alone.end(), one.begin(), one.end());
    }
    ASSERT_EQ(together.size(), alone.size());
    EXPECT_EQ(std::memcmp(together.data(), alone.data(), together.size() * sizeof(float)), 0) << info->name;
    for (const float v : together) ASSERT_TRUE(std::isfinite(v)) << info->name;
  }
}

TEST(EveryMaterial, ReflectsAtMostWhatArrives) {
  // The mean over samples of f / pdf, plus the weights of mirror and refraction (radiance scaling taken back).
  for (const PluginInfo* info : list_plugins("material")) {
    const auto material = make_default(*info);
    const int n = 4096;
    ShadingPoints points(n);
    LobeSet set(points.arena);
    material->lobes(points.s, set);
    std::mt19937 random(3);
    std::uniform_real_distribution<float> uniform(0, 1);
    std::vector<float> lobe_u(n), u(n), v(n), pdf(n);
    for (int i = 0; i < n; ++i) {
      lobe_u[i] = (static_cast<float>(i) + 0.5f) / static_cast<float>(n);
      u[i] = uniform(random), v[i] = uniform(random);
    }
    const Vec3Lanes wi = points.arena.vec3(n);
    const RGBLanes f = points.arena.rgb(n);
    sample_lobes(set, points.s, prepare_frame(set, points.s), lobe_u.data(), u.data(), v.data(), LobeKinds::NonSpecular,
                 {wi, f, pdf.data()});
    double sum = 0;
    for (int i = 0; i < n; ++i) sum += f.g[i];
    sum /= n;
    specular_reflection(set, points.s, lobe_u.data(), wi, f);
    sum += f.g[0];
    specular_transmission(set, points.s, lobe_u.data(), wi, f);
    sum += f.g[0] * (set.eta ? set.eta[0] * set.eta[0] : 1.0f);
    EXPECT_LE(sum, 1.01) << info->name;
  }
}

/// Some value of a parameter, so that lobes come and go: black or not, smooth or rough, thin or solid.
std::optional<Parameter> any_value(const ParamSpec& spec, std::mt19937& random) {
  const auto takes = [&](ParamType type) { return std::count(spec.accepts.begin(), spec.accepts.end(), type) > 0; };
  const double values[] = {0, 0.3, 1}, value = std::max(values[random() % 3], spec.range.min);
  if (random() % 3 == 0) return std::nullopt;
  if (takes(ParamType::Bool)) return test::boolean(spec.name.c_str(), random() % 2 == 0);
  if (takes(ParamType::Rgb)) return test::rgb(spec.name.c_str(), value, value, value);
  if (takes(ParamType::Float)) return test::floats(spec.name.c_str(), {value});
  return std::nullopt;
}

TEST(EveryMaterial, CallsForTheEffectsOfAllItsLobes) {
  // The renderer drops lobes of effects that no material of the scene calls for when it is asked with no points.
  std::mt19937 random(7);
  for (const PluginInfo* info : list_plugins("material")) {
    for (int i = 0; i < 300; ++i) {
      ParameterList list;
      for (const ParamSpec& spec : info->params) {
        if (auto p = any_value(spec, random)) list.push_back(std::move(*p));
      }
      const auto made = make_plugin<Material>("material", info->name.c_str(), std::move(list));
      if (!made.plugin) continue;  // what needs a file
      ShadingPoints points(1);
      LobeSet set(points.arena);
      made->lobes(points.s, set);
      for (int l = 0; l < set.count; ++l) {
        const Effect effect = effect_of(set.lobes[l].type);
        EXPECT_TRUE(made->effects().has(effect)) << info->name << ": " << effect_name(effect);
      }
    }
  }
}

TEST(EveryMaterial, IsDocumentedAndItsDefaultsAreInRange) {
  for (const PluginInfo* info : list_plugins("material")) {
    EXPECT_FALSE(info->doc.empty()) << info->name;
    std::set<std::string> names;
    for (const ParamSpec& p : info->params) {
      EXPECT_FALSE(p.doc.empty()) << info->name << ' ' << p.name;
      EXPECT_TRUE(names.insert(p.name).second) << info->name << " declares " << p.name << " twice";
    }
  }
}

LobeSet lobes_of(const Material& material, const ShadingBatch& s) {
  LobeSet set(*s.arena);
  material.lobes(s, set);
  return set;
}

TEST(Matte, IsLambertianUntilSigma) {
  ShadingPoints points(1);
  const auto plain = make_plugin<Material>("material", "matte");
  EXPECT_EQ(lobes_of(*plain.plugin, points.s).lobes[0].type, LobeType::LambertReflection);
  EXPECT_EQ(lobes_of(*plain.plugin, points.s).lobes[0].weight[0], RGB(0.5f));
  const auto rough = make_plugin<Material>("material", "matte", {test::floats("sigma", {200})});
  const LobeSet set = lobes_of(*rough.plugin, points.s);
  EXPECT_EQ(set.lobes[0].type, LobeType::OrenNayar);
  // Clamped to 90 degrees: s2 = 2.467401; A = 1 - s2 / (2 (s2 + 0.33)) = 0.558983, B = 0.45 s2 / (s2 + 0.09) = 0.434164.
  EXPECT_NEAR(set.lobes[0].a[0], 0.558983, 1e-6);
  EXPECT_NEAR(set.lobes[0].b[0], 0.434164, 1e-6);
}

TEST(Materials, NegativeReflectancesCountAsBlack) {
  ShadingPoints points(1);
  const auto m = make_plugin<Material>("material", "mirror", {test::rgb("Kr", -1, 0.5, 2)});
  EXPECT_EQ(lobes_of(*m.plugin, points.s).lobes[0].weight[0], RGB(0, 0.5f, 2));
}

TEST(Glass, LobesAndEffectsFollowItsParameters) {
  ShadingPoints points(1);
  const auto smooth =
      make_plugin<Material>("material", "glass", {test::floats("eta", {1.7}), test::floats("index", {1.2})});
  const LobeSet set = lobes_of(*smooth.plugin, points.s);
  EXPECT_EQ(set.count, 2);
  EXPECT_EQ(set.eta[0], 1.7f) << "eta overrides index";
  EXPECT_TRUE(smooth->effects().has(Effect::Reflection) && smooth->effects().has(Effect::Refraction));
  EXPECT_FALSE(smooth->effects().has(Effect::Glossy));

  const auto rough = make_plugin<Material>("material", "glass", {test::floats("uroughness", {0.2})});
  const LobeSet r = lobes_of(*rough.plugin, points.s);
  EXPECT_EQ(r.lobes[0].type, LobeType::MicrofacetReflection);
  EXPECT_EQ(r.lobes[1].type, LobeType::MicrofacetTransmission);
  EXPECT_TRUE(needs_frame(r));
  EXPECT_TRUE(rough->effects().has(Effect::Glossy));
  EXPECT_FALSE(rough->effects().has(Effect::Reflection));

  const auto clear = make_plugin<Material>("material", "glass", {test::rgb("Kr", 0, 0, 0)});
  EXPECT_EQ(lobes_of(*clear.plugin, points.s).count, 1);
  EXPECT_FALSE(clear->effects().has(Effect::Reflection));

  EXPECT_TRUE(make_plugin<Material>("material", "glass", {test::floats("eta", {0})}).diagnostics.has_errors());
}

TEST(PerfectGlass, BlackReflectanceRemovesOnlyItsLobe) {
  ShadingPoints points(1);
  const auto m = make_plugin<Material>("material", "perfectglass", {test::rgb("Kr", 0, 0, 0)});
  const LobeSet set = lobes_of(*m.plugin, points.s);
  EXPECT_EQ(set.count, 1);
  EXPECT_EQ(set.lobes[0].type, LobeType::SpecularTransmission);
  EXPECT_EQ(lobes_of(*make_plugin<Material>("material", "perfectglass").plugin, points.s).count, 2);
}

TEST(Plastic, RoughnessIsMappedUnlessToldOtherwise) {
  ShadingPoints points(1);
  EXPECT_NEAR(lobes_of(*make_plugin<Material>("material", "plastic").plugin, points.s).lobes[1].a[0], 0.461757, 1e-5);
  const auto raw = make_plugin<Material>("material", "plastic", {test::boolean("remaproughness", false)});
  EXPECT_FLOAT_EQ(lobes_of(*raw.plugin, points.s).lobes[1].a[0], 0.1f);
}

std::vector<LobeType> types_of(const LobeSet& set) {
  std::vector<LobeType> types;
  for (int k = 0; k < set.count; ++k) types.push_back(set.lobes[k].type);
  return types;
}

TEST(Metal, IsCopperByDefaultAndRoughInTwoDirections) {
  ShadingPoints points(1);
  const auto copper = make_plugin<Material>("material", "metal");
  const LobeSet set = lobes_of(*copper.plugin, points.s);
  EXPECT_EQ(types_of(set), std::vector{LobeType::MicrofacetReflection});
  EXPECT_EQ(set.lobes[0].fresnel, FresnelType::Conductor);
  // pbrt-v3's values, of which the literature on it quotes 470/471: 0.200438 0.924033 1.102212, 3.912949 ...
  EXPECT_NEAR(set.lobes[0].colour1.r[0], 0.2, 1e-3);
  EXPECT_NEAR(set.lobes[0].colour2.b[0], 2.138, 1e-3);
  EXPECT_FALSE(needs_frame(set)) << "equal roughnesses are isotropic";
  EXPECT_TRUE(copper->effects().has(Effect::Glossy));

  const auto brushed = make_plugin<Material>(
      "material", "metal",
      {test::floats("roughness", {0.3}), test::floats("vroughness", {0.1}), test::boolean("remaproughness", false)});
  const LobeSet b = lobes_of(*brushed.plugin, points.s);
  EXPECT_TRUE(needs_frame(b));
  EXPECT_FLOAT_EQ(b.lobes[0].a[0], 0.3f) << "the direction that is not given takes roughness";
  EXPECT_FLOAT_EQ(b.lobes[0].b[0], 0.1f);
}

TEST(Substrate, IsNothingWhereBothColoursAreBlack) {
  ShadingPoints points(1);
  EXPECT_EQ(types_of(lobes_of(*make_plugin<Material>("material", "substrate").plugin, points.s)),
            std::vector{LobeType::FresnelBlend});
  const auto black =
      make_plugin<Material>("material", "substrate", {test::rgb("Kd", 0, 0, 0), test::rgb("Ks", 0, -1, 0)});
  EXPECT_EQ(lobes_of(*black.plugin, points.s).count, 0);
  EXPECT_FALSE(black->effects().has(Effect::Glossy));
}

TEST(Translucent, SharesItsColoursBetweenTheSides) {
  ShadingPoints points(1);
  const auto both = make_plugin<Material>("material", "translucent", {test::rgb("reflect", 0.2, 0.4, 0.6)});
  const LobeSet set = lobes_of(*both.plugin, points.s);
  EXPECT_EQ(types_of(set), (std::vector{LobeType::LambertReflection, LobeType::LambertTransmission,
                                        LobeType::MicrofacetReflection, LobeType::MicrofacetTransmission}));
  EXPECT_FLOAT_EQ(set.lobes[0].weight.g[0], 0.1f);
  EXPECT_FLOAT_EQ(set.lobes[1].weight.g[0], 0.125f);
  EXPECT_EQ(set.eta[0], 1.5f);
  const auto one_side = make_plugin<Material>("material", "translucent", {test::rgb("reflect", 0, 0, 0)});
  EXPECT_EQ(types_of(lobes_of(*one_side.plugin, points.s)),
            (std::vector{LobeType::LambertTransmission, LobeType::MicrofacetTransmission}));
}

TEST(Uber, OpacityLetsRaysPassAndScalesTheRest) {
  ShadingPoints points(1);
  const auto opaque = make_plugin<Material>("material", "uber", {test::floats("eta", {1.3})});
  const LobeSet o = lobes_of(*opaque.plugin, points.s);
  EXPECT_EQ(types_of(o), (std::vector{LobeType::LambertReflection, LobeType::MicrofacetReflection}));
  EXPECT_EQ(o.eta[0], 1.3f);
  EXPECT_FALSE(opaque->effects().has(Effect::Refraction));

  const auto thin = make_plugin<Material>(
      "material", "uber", {test::rgb("opacity", 0.25, 2, 1), test::rgb("Kt", 1, 1, 1), test::rgb("Kr", 0.5, 0.5, 0.5)});
  const LobeSet t = lobes_of(*thin.plugin, points.s);
  EXPECT_EQ(types_of(t),
            (std::vector{LobeType::SpecularTransmission, LobeType::LambertReflection, LobeType::MicrofacetReflection,
                         LobeType::SpecularReflection, LobeType::SpecularTransmission}));
  EXPECT_EQ(t.lobes[0].weight[0], RGB(0.75f, 0, 0));
  EXPECT_EQ(t.lobes[0].eta[0], 1.0f);
  EXPECT_EQ(t.lobes[3].weight[0], RGB(0.125f, 1, 0.5f)) << "opacity is clamped only from below";
  EXPECT_EQ(t.lobes[4].eta[0], 1.5f);
  EXPECT_EQ(t.eta[0], 1.0f) << "the index for ray differentials";
  EXPECT_TRUE(thin->effects().has(Effect::Reflection) && thin->effects().has(Effect::Refraction));
}

TEST(Uber, RoughnessFallsBackFromVToU) {
  ShadingPoints points(1);
  const auto m =
      make_plugin<Material>("material", "uber", {test::floats("roughness", {0.5}), test::floats("uroughness", {0.2})});
  const LobeSet set = lobes_of(*m.plugin, points.s);
  EXPECT_FALSE(needs_frame(set));
  EXPECT_FLOAT_EQ(set.lobes[1].b[0], roughness_to_alpha(0.2f));
}

/// A mix bound as the scene does it, with the given materials behind the names.
std::unique_ptr<Material> make_mix(const std::map<std::string, std::shared_ptr<Material>>& named,
                                   const ParameterList& parameters, Diagnostics& diagnostics) {
  const PluginInfo* info = find_plugin("material", "mix");
  std::unique_ptr<Material> mix = make_default(*info);
  BindContext ctx;
  ctx.diagnostics = &diagnostics, ctx.statement_name = "mix";
  ctx.named_material = [&](const std::string& name, std::shared_ptr<Material>& found) {
    const auto known = named.find(name);
    if (known != named.end()) found = known->second;
    return known != named.end();
  };
  if (bind_parameters(*info, *mix, parameters, ctx)) mix->check(diagnostics, {});
  return mix;
}

TEST(Mix, HasTheLobesOfBothWeighted) {
  ShadingPoints points(1);
  std::map<std::string, std::shared_ptr<Material>> named;
  named["glass"] = make_plugin<Material>("material", "glass", {test::floats("eta", {1.3})}).plugin;
  named["mirror"] = make_plugin<Material>("material", "mirror", {test::rgb("Kr", 1, 1, 1)}).plugin;
  Diagnostics diagnostics;
  named["mix"] = make_mix(
      named,
      {test::text("namedmaterial1", "glass"), test::text("namedmaterial2", "mirror"), test::rgb("amount", 0.25, 2, -1)},
      diagnostics);
  EXPECT_TRUE(diagnostics.all().empty());
  const LobeSet set = lobes_of(*named["mix"], points.s);
  EXPECT_EQ(types_of(set),
            (std::vector{LobeType::SpecularReflection, LobeType::SpecularTransmission, LobeType::SpecularReflection}));
  EXPECT_EQ(set.lobes[0].weight[0], RGB(0.25f, 2, 0));
  EXPECT_EQ(set.lobes[2].weight[0], RGB(0.75f, 0, 1));
  EXPECT_EQ(set.eta[0], 1.3f) << "the first material's";
  EXPECT_TRUE(named["mix"]->effects().has(Effect::Refraction));

  const auto outer =
      make_mix(named, {test::text("namedmaterial1", "mirror"), test::text("namedmaterial2", "mix")}, diagnostics);
  const LobeSet nested = lobes_of(*outer, points.s);
  // The mirror is in it twice, and has half of all and its share of the other half: 0.5 + 0.5 (0.75, 0, 1).
  ASSERT_EQ(nested.count, 3);
  EXPECT_EQ(nested.eta, nullptr) << "a mirror's index is 1";
  EXPECT_EQ(nested.lobes[0].weight[0], RGB(0.125f, 1, 0));
  EXPECT_EQ(nested.lobes[2].weight[0], RGB(0.875f, 0.5f, 1));
}

TEST(Mix, MaterialsThatAreDoubledOverAndOverAreOne) {
  // 2^60 times the same; and a chain that is as long as no stack is deep.
  for (const bool doubled : {true, false}) {
    ShadingPoints points(1);
    std::map<std::string, std::shared_ptr<Material>> named;
    named["0"] = make_plugin<Material>("material", "matte", {test::rgb("Kd", 1, 0.5, 0.25)}).plugin;
    named["mirror"] = make_plugin<Material>("material", "mirror", {test::rgb("Kr", 1, 1, 1)}).plugin;
    Diagnostics diagnostics;
    const int times = doubled ? 60 : 3000;
    for (int k = 1; k <= times; ++k) {
      const std::string before = std::to_string(k - 1);
      // With amounts of 1/2 all is exact. Of the chain's mirror each mix adds half of what is left.
      named[std::to_string(k)] = make_mix(
          named, {test::text("namedmaterial1", before), test::text("namedmaterial2", doubled ? before : "mirror")},
          diagnostics);
    }
    EXPECT_TRUE(diagnostics.all().empty());
    const LobeSet set = lobes_of(*named[std::to_string(times)], points.s);
    ASSERT_EQ(set.count, doubled ? 1 : 2);
    EXPECT_EQ(set.lobes[set.count - 1].weight[0], doubled ? RGB(1, 0.5f, 0.25f) : RGB(1.0f));
  }
}

TEST(Mix, NamesMustBeThere) {
  Diagnostics unknown, missing;
  make_mix({}, {test::text("namedmaterial1", "nobody")}, unknown);
  ASSERT_TRUE(unknown.has_errors());
  EXPECT_NE(unknown.all()[0].message.find("nobody"), std::string::npos);
  make_mix({}, {}, missing);
  EXPECT_EQ(missing.all().size(), 2u);
}

TEST(Mix, TakesTheFirstBumpMap) {
  std::map<std::string, std::shared_ptr<Material>> named;
  named["flat"] = make_plugin<Material>("material", "matte").plugin;
  named["rough"] = make_plugin<Material>("material", "matte").plugin;
  struct Waves : Texture<float> {
    void evaluate(const ShadingBatch& s, float* const& out) const override {
      for (int i = 0; i < s.n; ++i) out[i] = s.u[i];
    }
  };
  named["rough"]->bump = Tex<float>(std::make_shared<Waves>());
  Diagnostics diagnostics;
  const auto first =
      make_mix(named, {test::text("namedmaterial1", "rough"), test::text("namedmaterial2", "flat")}, diagnostics);
  const auto second =
      make_mix(named, {test::text("namedmaterial1", "flat"), test::text("namedmaterial2", "rough")}, diagnostics);
  EXPECT_FALSE(first->bump.is_constant());
  EXPECT_TRUE(second->bump.is_constant());
  named["rough"]->normalmap = Tex<RGB>(RGB(0.6f, 0.5f, 1));
  const auto tilted =
      make_mix(named, {test::text("namedmaterial1", "rough"), test::text("namedmaterial2", "flat")}, diagnostics);
  EXPECT_TRUE(tilted->has_normal_map());
  EXPECT_FALSE(second->has_normal_map());
}

TEST(None, IsAnInterfaceUnderBothNames) {
  EXPECT_EQ(find_plugin("material", ""), find_plugin("material", "none"));
  const auto m = make_plugin<Material>("material", "none");
  EXPECT_TRUE(m->is_interface());
  EXPECT_TRUE(m->effects().has(Effect::Interfaces));
}

}  // namespace
}  // namespace whit
