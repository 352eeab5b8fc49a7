// A scene that was read and built, and is rendered as often as one likes: the steps of core/session, which the command
// takes too, with failures for what the command reports.
#pragma once

#include <array>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "core/accuracy/target_json.h"
#include "core/scene/memory_plan.h"
#include "core/session/overrides.h"
#include "core/session/picture_stats.h"
#include "python/attended.h"
#include "python/rendered_picture.h"

namespace whit::python {

/// A file, or a text that is none.
struct SceneSource {
  std::string path;
  std::optional<std::string> text;
  /// How messages and pictures call it.
  const std::string& name() const;
};
/// Reads it.
ParsedFile read_source(const SceneSource& source, const ReadOptions& options = {});

/// What render and explain have in common.
struct PlanWish {
  Overrides overrides;
  std::optional<std::vector<std::string>> without, only;  ///< Effects to leave out, or to keep alone.
};
/// Throws Failure where an effect is none.
PlanOptions plan_options(const PlanWish& wish);
/// Puts the overrides into a file; throws Failure for names that nobody has. "" or what the file has no place for.
std::string apply_overrides(const PlanWish& wish, ParsedFile& file);

/// What of a glTF model is shown.
struct ModelWish {
  std::string scene, camera, variant;  ///< By name or number; "" for the model's own.
  std::optional<double> time;          ///< Seconds into its animations.
  bool allow_outside = false;
};
/// How a source is read. Throws Failure where something of a model is chosen, and the source is none.
ReadOptions read_options(const ModelWish& wish, const SceneSource& source);

/// What a scene is built with.
struct SceneWish : PlanWish {
  int world = 0;  ///< Of the file's, by number.
  int spp = 0, footprint_spp = 0;
  uint32_t seed = 0;
  bool quick = false, strict = false, keep_going = false, fast_traversal = false;
  ModelWish model;
  double texture_memory = 1024;  ///< MiB
  bool extending = false;        ///< With a sampler that goes on beyond its number, for targets.
};

/// What it is rendered with. What is not given is the scene's.
struct RenderWish {
  std::optional<std::array<double, 16>> camera;  ///< World to camera, row by row, for columns: p' = M p.
  std::optional<Vec2i> resolution;
  std::optional<int> spp;
  std::optional<uint32_t> seed;
  std::optional<std::array<double, 4>> crop;  ///< x0, x1, y0, y1 as fractions.
  std::vector<std::string> aovs;              ///< As --aov.
  int threads = 0;
  TargetGoal goal;
  double time_limit = 0;  ///< Seconds; 0 for none.
  int max_samples = 1 << 16;
  std::string command;  ///< Which does the same, for the picture's header.
  bool has_target() const { return goal.error > 0 || time_limit > 0; }
};

class KeptScene {
 public:
  /// Reads and builds. Throws Failure. `wish` and `first` are what the memory is estimated for.
  KeptScene(const SceneSource& source, const SceneWish& wish, const RenderWish& first);
  ~KeptScene();
  KeptScene(const KeptScene&) = delete;
  KeptScene& operator=(const KeptScene&) = delete;

  /// One at a time; others wait. Throws Failure.
  std::unique_ptr<RenderedPicture> render(const RenderWish& wish, Attention& attention);

  /// World to camera where the scene has it, row by row, for columns; of one that moves when the shutter opens.
  std::array<double, 16> camera() const;
  Vec2i resolution() const { return own_.resolution; }
  int samples_per_pixel() const { return own_.samples; }
  std::vector<Said> said() const;

 private:
  /// What decides the picture, and can be changed.
  struct Settings {
    std::vector<Mat4d> camera;
    Vec2i resolution{0, 0};
    int samples = 0;
    uint32_t seed = 0;
  };
  void plan_and_build(const RenderWish& first);
  void take(const Diagnostics& found);
  MemoryPlan plan_memory_for(const PlannedWorld& planned, const RenderWish& first) const;
  std::vector<std::string> aovs_of(const RenderWish& wish) const;
  void set(const RenderWish& wish);
  void require_usable() const;
  RenderOptions options_for(const RenderWish& wish) const;
  RenderedWorld trace(const RenderWish& wish, RenderOptions options, Attention& attention,
                      std::optional<Json::Object>& target);
  std::unique_ptr<RenderedPicture> picture_of(RenderedWorld rendered, const RenderWish& wish, const OutputPlan& output);
  const SceneDescription& world() const { return file_.worlds[static_cast<size_t>(wish_.world)]; }

  const std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
  const SceneSource source_;
  const SceneWish wish_;
  ParsedFile file_;
  BuiltWorld built_;
  mutable std::mutex mutex_;
  Settings own_, now_;
  StepTimes times_;
  double parsed_memory_ = 0, memory_estimate_ = 0;
  std::vector<Said> said_;
  std::set<std::tuple<uint32_t, uint64_t, std::string>> known_;  ///< Of what was said: places and messages.
};

}  // namespace whit::python
