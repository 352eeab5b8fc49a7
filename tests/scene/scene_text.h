// From the text of a scene to a plan and to a built scene, as tools/whit goes.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "core/scene/effect_plan.h"
#include "core/scene/scene.h"
#include "parser/lexer.h"
#include "parser/parse.h"

namespace whit::test {

/// A parsed, bound and planned scene with everything it refers to. Anything said about it fails the test.
struct Planned {
  Sources sources;
  ParseResult parsed;
  BoundScene bound;
  EffectPlan plan;
  Diagnostics warnings;  ///< Of binding and building, where they are allowed.

  enum class Warnings { Failures, Allowed };
  explicit Planned(const std::string& text, Warnings mode = Warnings::Failures)
      : parsed(parse_text(sources, "test.pbrt", text, "")) {
    expect_silence(parsed.diagnostics);
    if (parsed.scenes.size() != 1) throw std::runtime_error("not one world");
    Diagnostics said;
    const ValuePosition position = [this](const Parameter& p, size_t i) { return value_position(sources, p, i); };
    bound = bind_scene(parsed.scenes[0], position, said);
    if (mode == Warnings::Failures) expect_silence(said);
    warnings = said;
    plan = plan_effects(bound);
  }
  Planned(const Planned&) = delete;
  Planned& operator=(const Planned&) = delete;

  const SceneDescription& description() const { return parsed.scenes[0]; }

  void expect_silence(const Diagnostics& said) const {
    for (const Diagnostic& d : said.all()) ADD_FAILURE() << sources.render_diagnostic(d, false);
  }
};

/// The same, built.
struct BuiltScene : Planned {
  TextureStore textures;
  std::unique_ptr<Scene> scene;

  explicit BuiltScene(const std::string& text, const BuildOptions& options = {}, Warnings mode = Warnings::Failures)
      : Planned(text, mode) {
    Diagnostics said;
    scene = build_scene(std::move(bound), std::move(plan), options, textures, said);
    if (mode == Warnings::Failures) expect_silence(said);
    warnings.append(said);
    if (!scene) throw std::runtime_error("not built");
  }
};

}  // namespace whit::test
