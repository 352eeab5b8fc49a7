// What a picture can hold beside its colours (arbitrary output variables, AOVs): a table, a row for each.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/plugin/transport.h"
#include "core/scene/scene.h"

namespace whit {

/// The points that a batch of camera rays has met.
struct FirstSurfaces {
  const Scene& scene;
  const Points& points;  ///< With lobes once the integrator has asked for them.
};

/// Where values of camera samples go: an array for each channel, indexed by Rays::slot.
using SampleValues = float* const*;

/// How the light that a sample brings got there, by what its first surface did. All together are the picture.
enum class LightPart : uint8_t { Emission, Direct, Reflection, Refraction, Indirect };

/// What is known of a pixel's samples together.
struct PixelStatistics {
  int64_t n = 0;        ///< Of its own, between its borders, those that are numbers.
  Vec3d variance{0.0};  ///< Of the pixel's channels, by blocks of the samples that its filter takes in.
};

/// What a number of Scene's stands for.
struct IdName {
  std::string name;   ///< No other has it, unless it stands for the same statement.
  std::string where;  ///< "scene.pbrt:12:3"; "" for what no statement made.
};
/// "scene.pbrt:12:3" for a statement.
using StatementPlace = std::function<std::string(SourcePos)>;

/// How a pixel's value comes of the samples'.
enum class AovPixel : uint8_t {
  Mean,              ///< As the picture's colours: of all samples, weighed by the filter.
  SurfaceMean,       ///< Of the samples that meet a surface, weighed likewise.
  SurfaceDirection,  ///< The same, as a unit vector.
  Nearest,           ///< Of the pixel's own sample that is nearest to its middle, for what has no mean.
  Statistic,         ///< Of the pixel's samples together.
};

/// The same in words.
const char* pixel_text(AovPixel pixel);

/// One AOV. One of surface, part, by_light_group and statistic says where it comes from.
struct AovRow {
  const char* name;                   ///< As people ask for it.
  std::vector<std::string> channels;  ///< In the file; by light group: what stands behind the group's name.
  AovPixel pixel;
  bool full_float;  ///< Stored as 32-bit floats, whatever the colours are.
  const char* doc;

  /// Writes the values of first surfaces. Called when these are known, and again when they have lobes.
  void (*surface)(const FirstSurfaces& at, SampleValues to) = nullptr;
  float nothing = 0;  ///< Of a sample that meets no surface.
  std::optional<LightPart> part{};
  bool by_light_group = false;
  void (*statistic)(const PixelStatistics& of, float* to) = nullptr;
  bool blocks = false;  ///< The statistic needs blocks of samples.

  /// Of numbers that stand for something: what for, and the name of the cryptomatte that goes with them.
  std::vector<IdName> (*names)(const Scene& scene, const StatementPlace& place) = nullptr;
  const char* matte = nullptr;
};

/// The table.
std::span<const AovRow> all_aovs();
/// The row of a name; null when there is none.
const AovRow* find_aov(const std::string& name);
/// What is wrong with names that someone asks for: "" or the first that there is not, with a remedy.
std::string unknown_aov(const std::vector<std::string>& names);

}  // namespace whit
