// From the text of a scene to a plan and to a built scene, by the steps of core/session.
#pragma once

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <utility>

#include "core/session/session.h"

namespace whit::test {

/// A scene in a file rather than in a test's text.
struct SceneFile {
  std::string path;
};

/// A parsed, bound and planned scene with everything it refers to. Anything said about it fails the test.
struct Planned {
  ParsedFile file;
  PlannedWorld world;
  const Sources& sources = *file.sources;
  BoundScene& bound = world.bound;
  EffectPlan& plan = world.plan;
  Diagnostics warnings;  ///< Of binding and building, where they are allowed.

  enum class Warnings { Failures, Allowed };
  explicit Planned(const std::string& text, Warnings mode = Warnings::Failures, const PlanOptions& options = {})
      : Planned(read_scene_text("test.pbrt", text), mode, options) {}
  explicit Planned(const SceneFile& scene, Warnings mode = Warnings::Failures, const PlanOptions& options = {})
      : Planned(read_scene_file(scene.path), mode, options) {}
  Planned(const Planned&) = delete;
  Planned& operator=(const Planned&) = delete;

  const SceneDescription& description() const { return file.worlds[0]; }

  void expect_silence(const Diagnostics& said) const {
    for (const Diagnostic& d : said.all()) ADD_FAILURE() << sources.render_diagnostic(d, false);
  }

 private:
  Planned(ParsedFile parsed, Warnings mode, const PlanOptions& options) : file(std::move(parsed)) {
    if (mode == Warnings::Failures) expect_silence(file.said);
    if (file.worlds.size() != 1) throw std::runtime_error("not one world");
    world = plan_world(description(), sources, options);
    if (mode == Warnings::Failures) expect_silence(world.said);
    warnings = world.said;
  }
};

/// The same, built.
struct BuiltScene : Planned {
  BuiltWorld built;
  Scene* scene = nullptr;
  const TextureStore& textures() const { return *built.textures; }

  template <class Source>  // std::string or SceneFile
  explicit BuiltScene(const Source& source, const BuildOptions& options = {}, Warnings mode = Warnings::Failures,
                      const PlanOptions& plan_options = {})
      : Planned(source, mode, plan_options), built(build_world(std::move(world), options)), scene(built.scene.get()) {
    if (mode == Warnings::Failures) expect_silence(built.said);
    warnings.append(built.said);
    if (!scene) throw std::runtime_error("not built");
  }
};

}  // namespace whit::test
