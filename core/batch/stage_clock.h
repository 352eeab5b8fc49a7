// Where the time of a render goes: a stopwatch that knows which stage a worker is in.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>

namespace whit {

/// What a worker does; see the rendering loop in docs/map.md.
enum class Stage : uint8_t {
  Camera,         ///< Film positions, lens, camera rays.
  Intersect,      ///< The nearest hits.
  Interaction,    ///< Sorting hits; points, normals, derivatives and footprints there.
  Textures,       ///< Texture lookups, bump maps.
  Lobes,          ///< Materials' lobes, and what they scatter towards lights.
  LightSampling,  ///< Points on lights, emission, environments.
  Shadow,         ///< Shadow rays.
  Spawn,          ///< Mirrored and refracted rays.
  Film,           ///< Samples into pixels.
};
constexpr size_t kStages = 9;
constexpr std::array<const char*, kStages> kStageNames{
    "camera", "intersect", "interaction", "textures", "lobes", "light sampling", "shadow", "spawn", "film"};

/// Seconds by stage; a stage inside another counts for itself alone. One per worker.
class StageClock {
 public:
  /// From now on time belongs to `stage`; returns the stage it belonged to.
  Stage enter(Stage stage) {
    const auto now = std::chrono::steady_clock::now();
    seconds[static_cast<size_t>(current_)] += std::chrono::duration<double>(now - since_).count();
    since_ = now;
    const Stage before = current_;
    current_ = stage;
    return before;
  }

  std::array<double, kStages> seconds{};

 private:
  Stage current_ = Stage::Film;
  std::chrono::steady_clock::time_point since_ = std::chrono::steady_clock::now();
};

/// Counts the scope's time for a stage, then returns to the one before. Without a clock it does nothing.
class StageScope {
 public:
  StageScope(StageClock* clock, Stage stage) : clock_(clock) {
    if (clock_) before_ = clock_->enter(stage);
  }
  ~StageScope() {
    if (clock_) clock_->enter(before_);
  }
  StageScope(const StageScope&) = delete;
  StageScope& operator=(const StageScope&) = delete;

 private:
  StageClock* const clock_;
  Stage before_ = Stage::Film;
};

}  // namespace whit
