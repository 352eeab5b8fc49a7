// From the text of a scene to a plan and to a built scene, as tools/whit goes.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "core/scene/effect_plan.h"
#include "core/scene/problems.h"
#include "core/scene/scene.h"
#include "parser/lexer.h"
#include "parser/parse.h"

namespace whit::test {

/// A scene in a file rather than in a test's text.
struct SceneFile {
  std::string path;
};

/// A parsed, bound and planned scene with everything it refers to. Anything said about it fails the test.
struct Planned {
  Sources sources;
  ParseResult parsed;
  BoundScene bound;
  EffectPlan plan;
  Diagnostics warnings;  ///< Of binding and building, where they are allowed.

  enum class Warnings { Failures, Allowed };
  explicit Planned(const std::string& text, Warnings mode = Warnings::Failures, const PlanOptions& options = {})
      : parsed(parse_text(sources, "test.pbrt", text, "")) {
    plan_world(mode, options);
  }
  explicit Planned(const SceneFile& file, Warnings mode = Warnings::Failures, const PlanOptions& options = {})
      : parsed(parse_file(sources, file.path)) {
    plan_world(mode, options);
  }
  Planned(const Planned&) = delete;
  Planned& operator=(const Planned&) = delete;

  const SceneDescription& description() const { return parsed.scenes[0]; }

  void expect_silence(const Diagnostics& said) const {
    for (const Diagnostic& d : said.all()) ADD_FAILURE() << sources.render_diagnostic(d, false);
  }

 private:
  void plan_world(Warnings mode, const PlanOptions& options) {
    if (mode == Warnings::Failures) expect_silence(parsed.diagnostics);
    if (parsed.scenes.size() != 1) throw std::runtime_error("not one world");
    Diagnostics said;
    const ValuePosition position = [this](const Parameter& p, size_t i) { return value_position(sources, p, i); };
    bound = bind_scene(parsed.scenes[0], position, said, !options.off.has(Effect::Textures));
    plan = plan_effects(bound, options);
    if (mode == Warnings::Failures) expect_silence(said);
    warnings = weigh_problems(bound, plan);
  }
};

/// The same, built.
struct BuiltScene : Planned {
  TextureStore textures;
  std::unique_ptr<Scene> scene;

  template <class Source>  // std::string or SceneFile
  explicit BuiltScene(const Source& source, const BuildOptions& options = {}, Warnings mode = Warnings::Failures,
                      const PlanOptions& plan_options = {})
      : Planned(source, mode, plan_options) {
    Diagnostics said;
    scene = build_scene(std::move(bound), std::move(plan), options, textures, said);
    if (mode == Warnings::Failures) expect_silence(said);
    warnings.append(said);
    if (!scene) throw std::runtime_error("not built");
  }
};

}  // namespace whit::test
