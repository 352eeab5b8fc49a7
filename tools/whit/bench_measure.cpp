#include "tools/whit/bench_measure.h"

#include <tbb/task_arena.h>

#include <numeric>
#include <random>

#include "core/render/render.h"
#include "tools/whit/bench_floor.h"
#include "tools/whit/terminal.h"

namespace whit {
namespace {

/// The world, built for measuring; without a scene when that cannot be.
BuiltWorld build(const SceneDescription& world, const Sources& sources, const BuildOptions& options,
                 Diagnostics& diagnostics) {
  PlannedWorld planned = plan_world(world, sources);
  diagnostics.append(planned.said);
  BuiltWorld built = build_world(std::move(planned), options);
  diagnostics.append(built.said);
  if (diagnostics.has_errors()) built.scene.reset();
  return built;
}

/// Camera samples per second and core over the runs; 0 threads are all. The first run warms caches and is not counted.
Spread samples_per_core(const Scene& scene, int threads, int runs) {
  std::vector<double> rates;
  RenderOptions options;
  options.threads = threads;
  for (int run = 0; run <= runs; ++run) {
    const RenderResult r = render(scene, options);
    if (run > 0) rates.push_back(static_cast<double>(r.statistics.camera_samples) / r.seconds / r.threads);
  }
  return spread_of(rates);
}

/// The share of rays aimed from the camera at points on edges between two triangles that hit nothing up to there.
double missed_edges(const Scene& scene) {
  constexpr int kRays = 1 << 17;
  std::vector<const Mesh*> meshes;
  for (const SceneShape& shape : scene.shapes) {
    if (shape.mesh && shape.mesh->indices.size() > 300) meshes.push_back(shape.mesh);
  }
  if (meshes.empty() || !scene.instances.empty()) return 0;
  std::mt19937 random(1);
  std::uniform_real_distribution<float> uniform;
  std::vector<float> o(3 * kRays), d(3 * kRays), t_max(kRays);
  std::vector<uint8_t> blocked(kRays);
  float* const od[] = {&o[0], &o[kRays], &o[2 * kRays], &d[0], &d[kRays], &d[2 * kRays]};
  const RayLanes rays{kRays, {od[0], od[1], od[2]}, {od[3], od[4], od[5]}, t_max.data()};
  const Vec3f eye(transform_point(scene.camera_keys.front(), Vec3d(0, 0, 0)));
  for (int i = 0; i < kRays;) {
    const Mesh& mesh = *meshes[random() % meshes.size()];
    const uint32_t* triangle = &mesh.indices[3 * (random() % (mesh.indices.size() / 3))];
    const Vec3f a = mesh.position(triangle[0]), b = mesh.position(triangle[1]), c = mesh.position(triangle[2]);
    const Vec3f to = a + (b - a) * uniform(random) - eye;
    // Only where the surface faces the camera well, so that the edge is not a silhouette.
    if (std::abs((b - a).cross(c - a).normalized().dot(to.normalized())) < 0.3f) continue;
    rays.o.set(i, eye), rays.d.set(i, to.normalized());
    t_max[static_cast<size_t>(i++)] = to.length() * 1.001f;
  }
  scene.accel->occluded(rays, blocked.data());
  return 1 - static_cast<double>(std::accumulate(blocked.begin(), blocked.end(), 0)) / kRays;
}

/// Samples per pixel at which a scene stays within the limit of camera samples; 0 for the scene's own.
int fewer_samples(const Scene& scene, double most) {
  const Vec2i size = scene.camera().film.resolution;
  const double samples = static_cast<double>(size.x) * size.y * scene.samples_per_pixel;
  return samples <= most ? 0 : std::max(1, static_cast<int>(scene.samples_per_pixel * most / samples));
}

}  // namespace

std::array<double, kStages> SceneFigures::stage_shares() const {
  std::array<double, kStages> shares = statistics.stage_seconds;
  const double sum = std::accumulate(shares.begin(), shares.end(), 0.0);
  for (double& s : shares) s /= sum;
  return shares;
}

std::optional<SceneFigures> measure_scene(const std::string& name, const ParsedFile& file,
                                          const SceneDescription& world, const BenchSettings& settings,
                                          Diagnostics& diagnostics) {
  BuildOptions options;
  BuiltWorld built = build(world, *file.sources, options, diagnostics);
  if (!built.scene) return std::nullopt;
  options.samples_per_pixel = fewer_samples(*built.scene, settings.most_camera_samples);
  if (options.samples_per_pixel > 0) {
    diagnostics.append(set_samples(built, options.samples_per_pixel, options.seed));
  }
  const Scene& scene = *built.scene;

  SceneFigures out;
  out.name = name;
  out.samples_per_pixel = scene.samples_per_pixel;
  out.threads = tbb::this_task_arena::max_concurrency();
  out.samples_per_s = samples_per_core(scene, 1, settings.runs);
  out.samples_per_s_of_all = samples_per_core(scene, 0, settings.runs);
  RenderOptions timed;
  timed.threads = 1;
  timed.time_stages = true;
  const RenderResult stages = render(scene, timed);
  out.statistics = stages.statistics, out.seconds = stages.seconds;
  out.floor = measure_floor(scene, settings.runs);

  options.robust_traversal = false;
  Diagnostics repeated;
  const BuiltWorld fast = build(world, *file.sources, options, repeated);
  out.fast_samples_per_s = samples_per_core(*fast.scene, 1, settings.runs).median;
  out.missed_edges_fast = missed_edges(*fast.scene), out.missed_edges_robust = missed_edges(scene);
  out.parse_mb_per_s = static_cast<double>(file.bytes) / 1e6 / std::max(1e-9, file.elapsed.wall);
  out.triangles = static_cast<int64_t>(scene.triangle_count());
  out.build_mtris_per_s = static_cast<double>(out.triangles) / 1e6 / built.elapsed.wall;
  out.peak_memory = static_cast<double>(peak_memory());
  return out;
}

}  // namespace whit
