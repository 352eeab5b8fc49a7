#include "tools/whit/bench_report.h"

#include <fmt/format.h>

#include "core/accel/accel.h"
#include "tools/whit/terminal.h"

namespace whit {
namespace {

// ---- For machines ----

Json both_ends(const Spread& s) { return Json::Array{s.low, s.high}; }

Json rays_per_second(const SceneFigures& f) {
  const RenderStatistics& s = f.statistics;
  return Json::Object{{"camera", f.per_second(s.camera_rays)},         {"reflection", f.per_second(s.reflection_rays)},
                      {"refraction", f.per_second(s.refraction_rays)}, {"shadow", f.per_second(s.shadow_rays)},
                      {"indirect", f.per_second(s.indirect_rays)},     {"all", f.per_second(s.rays())}};
}

Json shares_of_stages(const SceneFigures& f) {
  Json::Object out;
  const std::array<double, kStages> shares = f.stage_shares();
  for (size_t i = 0; i < kStages; ++i) out.emplace_back(kStageNames[i], shares[i]);
  return out;
}

Json floor_figures(const Floor& floor) {
  const char* const names[] = {"camera", "secondary", "shadow"};
  Json::Object kinds;
  for (size_t k = 0; k < floor.kinds.size(); ++k) {
    const FloorOfKind& kind = floor.kinds[k];
    if (kind.rays == 0) continue;
    kinds.emplace_back(
        names[k], Json::Object{{"rays", kind.rays}, {"call", call_name(kind.best_call)}, {"seconds", kind.seconds}});
  }
  return kinds;
}

}  // namespace

// ---- For people ----

void print_heading(int runs) {
  fmt::print("{}, robust traversal, one thread, medians of {} runs; M = million per second and core\n", accel_version(),
             runs);
  fmt::print("{:<14} {:>8} {:>12} {:>7} {:>6} {:>8} {:>7} {:>9} {:>7} {:>7} {:>9} {:>9}\n", "scene", "Msample",
             "spread", "Mray", "/floor", "scaling", "fast", "missed", "MB/s", "Mtri/s", "triangles", "memory");
}

void print_row(const SceneFigures& f) {
  const RenderStatistics& s = f.statistics;
  fmt::print(
      "{:<14} {:>8.2f} {:>5.2f}-{:<6.2f} {:>7.2f} {:>6.2f} {:>8.2f} {:>7.2f} {:>8.2f}% {:>7.0f} {:>7.2f} {:>9} {:>9}\n",
      f.name, f.samples_per_s.median / 1e6, f.samples_per_s.low / 1e6, f.samples_per_s.high / 1e6,
      f.per_second(s.rays()) / 1e6, f.floor.ratio.median, f.scaling(), f.fast_samples_per_s / 1e6,
      100 * f.missed_edges_fast, f.parse_mb_per_s, f.build_mtris_per_s, count_text(static_cast<double>(f.triangles)),
      bytes_text(f.peak_memory));
  std::string stages;
  const std::array<double, kStages> shares = f.stage_shares();
  for (size_t i = 0; i < kStages; ++i) {
    if (shares[i] >= 0.005) stages += fmt::format("  {} {:.0f} %", kStageNames[i], 100 * shares[i]);
  }
  fmt::print("  {}\n", stages);
}

void print_ingestion(const Ingestion& i) {
  const auto line = [](const std::string& what, const Spread& s, const char* unit, int digits) {
    fmt::print("{:<45} {:>8.{}f} {} ({:.{}f}-{:.{}f})\n", what, s.median, digits, unit, s.low, digits, s.high, digits);
  };
  line(fmt::format("scene text, {:.0f} MB of inline meshes", i.text_megabytes), i.text_mb_per_s, "MB/s", 0);
  line(fmt::format("a PLY mesh, binary, {:.0f} MB", i.ply_megabytes), i.ply_mb_per_s, "MB/s", 0);
  line(fmt::format("its {:.2f} M triangles, made traceable", i.triangles / 1e6), i.build_mtris_per_s, "Mtri/s", 2);
  line("the same mesh as .glb, ready by the PLY's time", i.glb_over_ply, "times", 2);
}

// ---- For machines ----

Json to_json(const SceneFigures& f) {
  return Json::Object{{"name", f.name},
                      {"camera_samples", f.statistics.camera_samples},
                      {"samples_per_pixel", f.samples_per_pixel},
                      {"camera_samples_per_s_per_core", f.samples_per_s.median},
                      {"spread", both_ends(f.samples_per_s)},
                      {"rays_per_s_per_core", rays_per_second(f)},
                      {"floor_ratio", f.floor.ratio.median},
                      {"floor_ratio_spread", both_ends(f.floor.ratio)},
                      {"floor", floor_figures(f.floor)},
                      {"stages", shares_of_stages(f)},
                      {"threads", f.threads},
                      {"scaling", f.scaling()},
                      {"fast_traversal", Json::Object{{"camera_samples_per_s_per_core", f.fast_samples_per_s},
                                                      {"missed_edges", f.missed_edges_fast},
                                                      {"missed_edges_robust", f.missed_edges_robust}}},
                      {"parse_mb_per_s", f.parse_mb_per_s},
                      {"build_mtris_per_s", f.build_mtris_per_s},
                      {"triangles", f.triangles},
                      {"invalid_samples", f.statistics.invalid_samples},
                      {"peak_memory_bytes", f.peak_memory}};
}

Json to_json(const Ingestion& i) {
  return Json::Object{{"text_megabytes", i.text_megabytes},
                      {"text_mb_per_s", i.text_mb_per_s.median},
                      {"text_mb_per_s_spread", both_ends(i.text_mb_per_s)},
                      {"ply_megabytes", i.ply_megabytes},
                      {"ply_mb_per_s", i.ply_mb_per_s.median},
                      {"ply_mb_per_s_spread", both_ends(i.ply_mb_per_s)},
                      {"triangles", i.triangles},
                      {"glb_over_ply", i.glb_over_ply.median},
                      {"glb_over_ply_spread", both_ends(i.glb_over_ply)},
                      {"build_mtris_per_s", i.build_mtris_per_s.median},
                      {"build_mtris_per_s_spread", both_ends(i.build_mtris_per_s)}};
}

}  // namespace whit
