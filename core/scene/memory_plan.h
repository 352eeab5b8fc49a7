// What a scene is going to take of memory, told before anything of it is read or made: by counts and by headers of files.
// docs/memory.md says how well.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/scene/bound_scene.h"
#include "core/scene/effect_plan.h"

namespace whit {

/// Who takes memory.
enum class MemoryUse : uint8_t {
  Program,    ///< The program, the scene's text and its description.
  Meshes,     ///< Vertices and triangles.
  Curves,     ///< Their control points.
  Shapes,     ///< What each shape takes whatever it is, and each light.
  Instances,  ///< Places of objects, and of what moves.
  RayTracer,  ///< Its trees of boxes.
  Textures,
  LightMaps,
  Tables,   ///< That materials read from files.
  Film,     ///< Sums of samples, and of AOVs.
  Workers,  ///< Threads that render.
  Output,   ///< Finished pictures, and files on their way.
  Denoiser  ///< What takes the noise out of one, and what it is given.
};
inline constexpr size_t kMemoryUses = 13;
/// "ray tracer", and the word that JSON has: "ray_tracer".
const char* memory_use_text(MemoryUse use);
const char* memory_use_key(MemoryUse use);

/// The steps of a render, in order. Each has what is there meanwhile.
enum class MemoryStep : uint8_t {
  Materials,
  Reading,
  Placing,
  Lights,
  RayTracer,
  Rendering,
  Finishing,
  Writing,
  Denoising
};
inline constexpr size_t kMemorySteps = 9;
/// "building the ray tracer", and the word that JSON has.
const char* memory_step_text(MemoryStep step);
const char* memory_step_key(MemoryStep step);

/// Bytes by step.
using StepBytes = std::array<double, kMemorySteps>;

/// Something that takes memory; of what a statement asks for its place, and what it is: "plymesh of 2000000 triangles".
struct MemoryPart {
  double bytes = 0;
  SourcePos where{};
  std::string what{};
};

class MemoryPlan {
 public:
  /// `bytes` for a use, of which the largest part is named where it is larger than those before.
  void add(MemoryUse use, const StepBytes& bytes, const MemoryPart& part = {});
  /// The same from one step on, to the last.
  void add_from(MemoryStep first, MemoryUse use, double bytes, const MemoryPart& part = {});

  /// The step that takes most, and how much: that is the estimate.
  MemoryStep step() const;
  double total() const { return total(step()); }
  double total(MemoryStep step) const;
  double of(MemoryUse use) const { return of(use, step()); }
  double of(MemoryUse use, MemoryStep step) const {
    return bytes_[static_cast<size_t>(use)][static_cast<size_t>(step)];
  }
  const MemoryPart& largest(MemoryUse use) const { return largest_[static_cast<size_t>(use)]; }

  /// Sets another cap of decoded textures, of which plan_scene_memory() has told what they would take.
  void cap_textures(double bytes);
  double texture_cap() const { return texture_cap_; }
  /// The least cap that the pictures can do with; what is more only saves time.
  double least_texture_cap() const;

 private:
  friend void plan_textures(const BoundScene&, const EffectPlan&, int, MemoryPlan&);
  std::array<StepBytes, kMemoryUses> bytes_{};
  std::array<MemoryPart, kMemoryUses> largest_{};
  double all_textures_ = 0;   ///< All levels of all pictures.
  double most_decoding_ = 0;  ///< Of what is decoded at once, beside its levels.
  double texture_cap_ = 0;
};

/// Adds what the scene itself takes: shapes, pictures, the ray tracer. Reads headers of the files of live statements, on all
/// threads. `threads` render; `texture_cap` is the most of decoded textures.
void plan_scene_memory(const BoundScene& bound, const EffectPlan& plan, int threads, double texture_cap,
                       MemoryPlan& memory);

/// What is said where the plan takes more than `limit` bytes: an error named kLimitHit at the statement that takes most,
/// with the breakdown and what to do; nothing where it fits.
Diagnostics memory_problem(const MemoryPlan& memory, uint64_t limit);

}  // namespace whit
