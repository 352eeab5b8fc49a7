// What rays see of lights: those at infinity, and surfaces that emit.

#include <limits>

#include "core/base/fastmath.h"
#include "core/batch/gather.h"
#include "core/batch/runs.h"
#include "core/render/aov_plan.h"
#include "core/render/tracer.h"
#include "core/scene/emission_map.h"

namespace whit {

Seen Tracer::escaped(const Rays& rays, const Hits& hits, Heuristic heuristic) {
  Seen seen;
  if (!scene_.plan.live(Effect::EnvironmentLights)) return seen;
  int32_t* lanes = arena_.alloc<int32_t>(rays.n);
  int n = 0;
  for (int i = 0; i < rays.n; ++i) {
    if (hits.shape[i] < 0) lanes[n++] = i;
  }
  if (n == 0) return seen;
  const Vec3Lanes o = arena_.vec3(n), d = arena_.vec3(n);
  gather(lanes, n, rays.o, o);
  gather(lanes, n, rays.d, d);
  seen = {n, lanes, arena_.rgb(n), nullptr};
  for_lanes(n, [&](int i) { seen.radiance.set(i, RGB(0.0f)); });
  const bool weighed = heuristic && rays.pdf, apart = worker_.aovs && !worker_.aovs->light_groups.empty();
  if (!weighed && !apart) {
    for (const SceneEnvironment& e : scene_.environments) e.light->add_escaped(n, o, d, seen.radiance, nullptr);
    return seen;
  }
  float* const pdf = weighed ? arena_.floats(n) : nullptr;
  RGBLanes* const shares = apart ? arena_.alloc<RGBLanes>(static_cast<int>(scene_.environments.size())) : nullptr;
  seen.environments = shares;
  RGBLanes one = arena_.rgb(n);
  for (size_t k = 0; k < scene_.environments.size(); ++k) {
    const SceneEnvironment& e = scene_.environments[k];
    if (apart) shares[k] = one = arena_.rgb(n);
    for_lanes(n, [&](int i) { one.set(i, RGB(0.0f)); });
    e.light->add_escaped(n, o, d, one, pdf);
    for (int i = 0; weighed && i < n; ++i) {
      const float chosen = e.number < 0 ? 0.0f : expected_samples(e.number, rays.from[lanes[i]]);
      one.set(i, one[i] * heuristic(rays.pdf[lanes[i]], chosen * pdf[i]));
    }
    for_lanes(n, [&](int i) { seen.radiance.set(i, seen.radiance[i] + one[i]); });
  }
  return seen;
}

namespace {

/// The number of the light that samples what is met of an emitting shape.
int number_of(const SceneShape& shape, int prim) {
  if (shape.first_light < 0) return DirectSamples::kNone;
  if (!shape.light_of_prim) return shape.first_light + prim;
  const int32_t number = (*shape.light_of_prim)[static_cast<size_t>(prim)];
  return number < 0 ? DirectSamples::kNone : number;
}

/// What is seen there.
const Light& light_of(const Scene& scene, const SceneShape& shape, int prim, int number) {
  if (!shape.light_of_prim) return *scene.emitters[static_cast<size_t>(shape.emitter + prim)];
  return number < 0 ? *scene.emitters[static_cast<size_t>(shape.emitter)]
                    : *scene.lights[static_cast<size_t>(number)].light;
}

/// By what the radiance of points is to be multiplied; of those that emit.
RGBLanes emission_maps(const Scene& scene, const Points& points, Arena& arena) {
  const RGBLanes out = arena.rgb(points.n);
  for_runs(
      0, points.n, [&](int i) { return points.hits.shape[i]; },
      [&](int first, int last) {
        const int emitter = scene.shapes[static_cast<size_t>(points.hits.shape[first])].emitter;
        const Tex<RGB>* map = emitter < 0 ? nullptr : scene.emitters[static_cast<size_t>(emitter)]->emission_map();
        if (!map) {
          for_lanes(last - first, [&](int i) { out.set(first + i, RGB(1.0f)); });
          return;
        }
        const ArenaScope scratch(arena);
        const RGBLanes values = emission_values(*map, points.at.range(first, last - first));
        for_lanes(last - first, [&](int i) { out.set(first + i, values[i]); });
      });
  return out;
}

}  // namespace

Seen Tracer::emitted(const Points& points, Heuristic heuristic) {
  Seen seen;
  if (!scene_.plan.live(Effect::AreaLights)) return seen;
  const auto shape_of = [&](int i) -> const SceneShape& {
    return scene_.shapes[static_cast<size_t>(points.hits.shape[i])];
  };
  int32_t* lanes = arena_.alloc<int32_t>(points.n);
  int n = 0;
  for (int i = 0; i < points.n; ++i) {
    if (shape_of(i).emitter >= 0) lanes[n++] = i;
  }
  if (n == 0) return seen;
  int32_t* numbers = arena_.alloc<int32_t>(n);
  seen = {n, lanes, arena_.rgb(n), numbers};
  const float* const pdf = heuristic ? points.rays.pdf : nullptr;
  const RGBLanes maps = scene_.has_emission_maps ? emission_maps(scene_, points, arena_) : RGBLanes{};
  for (int k = 0; k < n; ++k) {
    const int i = lanes[k];
    const SceneShape& shape = shape_of(i);
    const auto prim = shape.mesh && shape.first_light >= 0 ? static_cast<int>(points.hits.prim[i]) : 0;
    numbers[k] = number_of(shape, prim);
    const Light& light = light_of(scene_, shape, prim, numbers[k]);
    const Vec3f p = points.at.p[i], ng = points.at.ng[i];
    RGB radiance = light.emitted({points.rays.o[i], points.rays.d[i], points.hits.t[i], p, ng});
    if (maps) radiance = radiance * maps[i];
    if (pdf && numbers[k] >= 0 && pdf[i] < std::numeric_limits<float>::infinity() && !is_black(radiance)) {
      // Where a sample of the light would have been asked for.
      const Vec3f from = points.rays.from[i], to = p - from;
      const LightHit hit{from, normalize(to), length(to), p, ng};
      radiance = radiance * heuristic(pdf[i], expected_samples(numbers[k], from) * light.pdf(hit));
    }
    seen.radiance.set(k, radiance);
  }
  return seen;
}

}  // namespace whit
