// What `whit bench` measures of one scene.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "core/render/statistics.h"
#include "tools/whit/bench_floor.h"
#include "tools/whit/load.h"

namespace whit {

struct BenchSettings {
  int runs = 5;                      ///< Of each measurement; medians are reported.
  double most_camera_samples = 4e6;  ///< A scene with more gets fewer samples per pixel.
};

/// The figures that docs/speed.md explains. All rates are of one core.
struct SceneFigures {
  std::string name;
  int samples_per_pixel = 0, threads = 0;
  Spread samples_per_s;         ///< Camera samples per second, on one thread.
  Spread samples_per_s_of_all;  ///< The same on all threads, of each.
  RenderStatistics statistics;  ///< Of one render on one thread, which takes
  double seconds = 0;           ///< this long.
  Floor floor;
  double fast_samples_per_s = 0;                          ///< With the fast traversal.
  double missed_edges_fast = 0, missed_edges_robust = 0;  ///< Shares of rays.
  double parse_mb_per_s = 0, build_mtris_per_s = 0;
  int64_t triangles = 0;
  double peak_memory = 0;

  double scaling() const { return samples_per_s_of_all.median * threads / samples_per_s.median; }
  /// Of a count of rays in the statistics.
  double per_second(int64_t count) const { return static_cast<double>(count) / seconds; }
  std::array<double, kStages> stage_shares() const;
};

/// Measures a parsed scene; none with `diagnostics` when the scene cannot be rendered.
std::optional<SceneFigures> measure_scene(const std::string& name, const ParsedFile& file,
                                          const SceneDescription& world, const BenchSettings& settings,
                                          Diagnostics& diagnostics);

}  // namespace whit
