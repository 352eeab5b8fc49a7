// What `whit bench` measures of one scene.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "tools/whit/load.h"

namespace whit {

struct BenchSettings {
  int runs = 5;                      ///< Of each measurement; medians are reported.
  double most_camera_samples = 4e6;  ///< A scene with more gets fewer samples per pixel.
};

/// Measures a parsed scene; an object with the figures that docs/speed.md explains, or null with `diagnostics` when
/// the scene cannot be rendered.
nlohmann::json measure_scene(const std::string& name, const LoadedFile& file, const SceneDescription& world,
                             const Sources& sources, const BenchSettings& settings, Diagnostics& diagnostics);

}  // namespace whit
