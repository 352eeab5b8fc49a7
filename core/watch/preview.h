// A scene on the screen while it is written: read again when its files change, rendered again when anything does, coarse at
// first and finer while nothing happens. Threads of its own do all of it; what they have is asked for from any thread.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/session/overrides.h"
#include "core/session/session.h"
#include "core/watch/camera_text.h"

namespace whit {

struct PreviewRequest {
  std::string path;
  ReadOptions read;
  Overrides overrides;
  EffectSet off;  ///< At first.
  BuildOptions build;
  int threads = 0;
  size_t texture_bytes = TextureStore::kDefaultMemory;
  bool measure = true;  ///< When nothing else is to be done: what each effect costs.
};

/// A picture as far as it is: linear colours, red, green and blue of each pixel as half floats.
struct PreviewPicture {
  uint64_t number = 0;        ///< Later ones have larger numbers.
  uint64_t reading = 0;       ///< Of which reading of the scene it is: PreviewState::reading then.
  Vec2i resolution{0, 0};     ///< Of the whole picture.
  Box2i window;               ///< What of it is here, the maximum excluded, in pixels of the whole picture.
  int width = 0, height = 0;  ///< Of the numbers; less than the window's where it is coarse.
  double samples = 0;         ///< For each pixel.
  bool done = false;
  std::vector<uint16_t> halves;
};

/// A place in a file, in words; line 0 where there is none.
struct PlaceInFile {
  std::string file;  ///< As the user named it.
  std::string path;  ///< From the root, for editors.
  uint64_t line = 0, column = 0;
};

struct PreviewProblem {
  bool is_error = true;  ///< Or a mistake beyond doubt that is rendered past.
  PlaceInFile where;
  std::string message, remedy, excerpt;
  bool is_limit = false;  ///< A limit was hit (kLimitHit): the scene may be right.
};

struct PreviewEffect {
  Effect effect{};
  bool off = false;     ///< By hand.
  std::string why_off;  ///< Off whatever anyone wants: the integrator does not simulate it.
  std::string causes;   ///< "mirror (scene.pbrt:12), 3 in all".
  /// Of the time that a picture takes, what would be saved without it; below 0 where it would take longer.
  std::optional<double> cost;
};

struct PreviewCamera {
  CameraPose pose;        ///< Up is what the file calls up.
  bool mirrored = false;  ///< Left and right are changed.
  bool movable = false;
  bool moved = false;   ///< It is not where the file has it.
  std::string text;     ///< The statement that says where it is.
  std::string refusal;  ///< Why the statement cannot be written into the file.
  PlaceInFile where;    ///< What would be replaced.
};

enum class PreviewPhase : uint8_t { Reading, Building, Rendering, Done };
const char* phase_name(PreviewPhase phase);

struct PreviewState {
  uint64_t version = 0;  ///< Grows with every change.
  uint64_t reading = 0;  ///< How often the scene has been read.
  PreviewPhase phase = PreviewPhase::Reading;
  double samples = 0, samples_wanted = 0;  ///< For each pixel.
  double render_seconds = 0;               ///< So far, for the picture that there is.
  double first_seconds = 0;                ///< From the last change to the first picture that shows it.
  double read_seconds = 0, build_seconds = 0;
  std::shared_ptr<const PreviewPicture> picture;  ///< Null before the first.
  bool stale = false;                             ///< It is of an earlier text, as this one has errors.
  std::vector<PreviewProblem> problems;
  size_t problems_left_out = 0;
  std::vector<PreviewEffect> effects;
  PreviewCamera camera;
  std::string integrator;
  size_t triangles = 0, lights = 0, worlds = 0;
  size_t files = 0;  ///< That are watched.
};

/// What is at a place of the picture.
struct PreviewSpot {
  bool known = false;  ///< There is a scene.
  bool busy = false;   ///< It is being built: ask again.
  bool hit = false;
  double depth = 0, distance = 0;
  Vec3d point{0, 0, 0};
  std::string shape, material, material_kind, object;  ///< "plymesh"; "steel" or ""; "metal"; "" for none.
  PlaceInFile shape_at, material_at;
};

class Preview {
 public:
  explicit Preview(PreviewRequest request);
  ~Preview();
  Preview(const Preview&) = delete;
  Preview& operator=(const Preview&) = delete;

  const std::string& path() const;
  PreviewState state() const;
  /// Waits until the state has another version, or for that long, or until end_waits().
  void wait_beyond(uint64_t version, int milliseconds) const;
  void end_waits();
  /// Ends all work, which takes as long as what has been begun: true when it is over within that long.
  bool end(int milliseconds);
  /// One of the last few pictures; null when it is not kept.
  std::shared_ptr<const PreviewPicture> picture(uint64_t number) const;

  void set_effects_off(EffectSet off);
  /// Nothing puts it back to where the file has it.
  void move_camera(const std::optional<CameraPose>& pose);
  /// "" or why the file is as it was.
  std::string write_camera();
  /// Waits for nothing.
  PreviewSpot at(Vec2d film) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace whit
