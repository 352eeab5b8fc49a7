// Every scene of the conformance set, with the stages it calls for and with all of them: the same bits, and nothing done
// for effects that are not called for.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>

#include "core/render/ray_queue.h"
#include "tests/hard/render_text.h"

namespace whit {
namespace {

using namespace test;

std::vector<std::string> scenes() {
  std::vector<std::string> paths;
  for (const char* folder : {"/tests/conformance/scenes", "/tests/conformance-paths/scenes"}) {
    for (const auto& entry : std::filesystem::directory_iterator(std::string(WHIT_SOURCE_DIR) + folder)) {
      if (entry.path().extension() == ".pbrt") paths.push_back(entry.path().string());
    }
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

struct Traced {
  BuiltScene built;
  RenderResult result;

  Traced(const std::string& path, bool everything_on)
      : built(SceneFile{path}, {.samples_per_pixel = 2}, Planned::Warnings::Allowed, {.everything_on = everything_on}),
        result(render(*built.scene, {})) {}
  const EffectPlan& plan() const { return built.scene->plan; }
};

/// Something that is done for an effect alone, and how often it was.
struct Work {
  const char* what;
  bool called_for;
  int64_t count;
};

std::vector<Work> work_of(const Traced& t) {
  const RenderStatistics& s = t.result.statistics;
  const auto needs = [&](Effect e) { return t.plan().needed.has(e); };
  const bool textured = needs(Effect::Textures);
  const bool pictures = textured || needs(Effect::DeltaLights);  // some of which throw pictures
  return {{"differentials", needs(Effect::TextureFiltering) || needs(Effect::Bump), s.footprints},
          {"shadow rays", needs(Effect::Shadows), s.shadow_rays},
          {"reflected rays", needs(Effect::Reflection), s.reflection_rays},
          {"refracted rays", needs(Effect::Refraction), s.refraction_rays},
          {"sampled rays", needs(Effect::Indirect), s.indirect_rays},
          {"rays through interfaces", needs(Effect::Interfaces), s.passing_rays},
          {"alpha tests", needs(Effect::Alpha), s.alpha_tests},
          {"texture values", textured, s.texture_values},
          {"lookups in pictures", pictures, t.built.textures().statistics().lookups},
          {"lens samples", needs(Effect::DepthOfField), s.lens_samples},
          {"time samples", needs(Effect::MotionBlur), s.time_samples}};
}

TEST(PlanCheck, WhatIsNotCalledForIsNotDoneAndWouldChangeNoBit) {
  std::map<std::string, int> with_work;
  for (const std::string& path : scenes()) {
    const Traced automatic(path, false), everything(path, true);
    EXPECT_EQ(automatic.result.picture.rgb, everything.result.picture.rgb) << path;
    for (const Work& w : work_of(automatic)) {
      EXPECT_TRUE(w.called_for || w.count == 0) << w.count << ' ' << w.what << " in " << path;
      with_work[w.what] += w.count > 0;
    }
    const RenderStatistics& s = everything.result.statistics;
    EXPECT_EQ(s.time_samples, s.camera_samples) << path;
    EXPECT_EQ(s.lens_samples, s.camera_samples) << path;
    // Rays of paths carry differentials from the camera alone, sampled directions of direct lighting none, and nobody
    // asks for those of ambient occlusion.
    if (everything.built.scene->integrator().keeps_differentials() && s.probe_rays == 0 &&
        everything.plan().needs_differentials()) {
      EXPECT_EQ(s.footprints, s.surface_points) << path;
    }
  }
  // A counter that never counts would pass all this.
  for (const auto& [what, scenes_with] : with_work) EXPECT_GT(scenes_with, 0) << what;
}

TEST(PlanCheck, ExplainTellsTheBytesOfARay) {
  const auto bytes = [](const CarriedByRays& carried) { return lane_bytes(RayQueue(1, carried).rays()); };
  const int plain = bytes({});
  for (const Effect e : {Effect::Reflection, Effect::Refraction}) EXPECT_EQ(effect_info(e).ray_bytes, plain);
  for (const Effect e : {Effect::TextureFiltering, Effect::Bump}) {
    EXPECT_EQ(effect_info(e).ray_bytes, bytes({.differentials = true}) - plain);
  }
  EXPECT_EQ(effect_info(Effect::MotionBlur).ray_bytes, bytes({.time = true}) - plain);
  EXPECT_EQ(effect_info(Effect::Indirect).ray_bytes, bytes({.densities = true, .eta2 = true}));
}

}  // namespace
}  // namespace whit
