// What `whit check` finds beyond mistakes: things that a scene does and its author hardly meant. A table, a row for each
// kind of finding, and a file of functions for each family of them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/scene/scene.h"
#include "parser/source.h"

namespace whit {

/// A kind of finding.
struct FindingKind {
  const char* name;  ///< "unused-texture": by which it is silenced.
  const char* what;  ///< A sentence.
  Severity severity = Severity::Warning;
  bool by_default = true;
  bool said_by_render = false;  ///< A render warns of it, and is where it comes from.
};

/// All of them, in the order of docs/check.md.
const std::vector<FindingKind>& finding_kinds();
/// The kind of a name, or null.
const FindingKind* find_finding_kind(std::string_view name);

/// A world as the checks look at it.
struct CheckedWorld {
  const Sources& sources;
  const SceneDescription& description;
  const BoundScene& bound;
  const EffectPlan& plan;
};

/// Takes what is found. A name that is not in the table ends the program: a mistake of the programmer's.
class Findings {
 public:
  /// `asked_for`: names of those that are looked for though they are off by default.
  Findings(Diagnostics& out, const std::vector<std::string>& asked_for) : out_(out), asked_for_(asked_for) {}
  /// Whether a finding is looked for: what is dear asks before.
  bool wants(std::string_view name) const;
  void add(const char* name, SourcePos where, std::string message, std::string remedy = {}, SourcePos other = {});

 private:
  Diagnostics& out_;
  const std::vector<std::string>& asked_for_;
};

/// How often the same is said of a kind in a world before the rest is counted.
inline constexpr size_t kMostAlike = 100;

// From the text alone.
void check_definitions(const CheckedWorld& world, Findings& found);  ///< unused-..., redefined-...
void check_parameters(const CheckedWorld& world, Findings& found);   ///< ineffective-parameter
void check_lights(const CheckedWorld& world, Findings& found);       ///< black-light, useless-light
void check_instances(const CheckedWorld& world, Findings& found);    ///< mirrored-instance, singular-instance

// From what was built, with rays. BoundScene::description of the scene is that of the file.
void check_view(const Scene& scene, Findings& found);      ///< camera-inside, empty-view, outside-view
void check_emitters(const Scene& scene, Findings& found);  ///< covered-emitter, unreached-light
void check_normals(const Scene& scene, Findings& found);   ///< normals-against-winding
void check_textures(const Scene& scene, Findings& found);  ///< fine-texture, coarse-texture

}  // namespace whit
