// From rays to surface points with lobes, and from what they send to the samples.

#include "core/render/tracer.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/fastmath.h"
#include "core/batch/fields.h"
#include "core/batch/runs.h"
#include "core/batch/sort.h"
#include "core/plugin/bump.h"
#include "core/render/surface.h"

namespace whit {
namespace {

Hits allocate_hits(int n, Arena& arena) {
  return {arena.floats(n),         arena.alloc<int32_t>(n), arena.alloc<uint32_t>(n),
          arena.alloc<int32_t>(n), arena.floats(n),         arena.floats(n)};
}

/// Whether each number is one more than that before it.
bool are_consecutive(const int32_t* numbers, int n) {
  int others = 0;
  const int first = numbers[0];
#pragma omp simd reduction(+ : others)
  for (int i = 0; i < n; ++i) others += numbers[i] != first + i;
  return others == 0;
}

}  // namespace

Hits Tracer::intersect(Rays& rays) {
  const Hits hits = allocate_hits(rays.n, arena_);
  scene_.accel->intersect({rays.n, rays.o, rays.d, nullptr, rays.time}, hits, rays.depth == 0);
  if (rays.depth == 0) worker_.statistics.camera_rays += rays.n;
  if (scene_.plan.live(Effect::Interfaces)) {
    const Passed passed = pass_through_interfaces(scene_, rays, hits, arena_);
    worker_.statistics.passing_rays += passed.traced, worker_.statistics.stopped_rays += passed.stopped;
  }
  // A ray that could not be traced makes its sample invalid, so that it is counted and not just missing.
  int untraced = 0;
#pragma omp simd reduction(| : untraced)
  for (int i = 0; i < rays.n; ++i) untraced |= std::isnan(hits.t[i]) ? 1 : 0;
  for (int i = 0; untraced != 0 && i < rays.n; ++i) {
    if (std::isnan(hits.t[i])) worker_.chunk.radiance.set(rays.slot[i], RGB(std::numeric_limits<float>::quiet_NaN()));
  }
  return hits;
}

Points Tracer::surfaces(const Rays& rays, const Hits& hits, Which which) {
  int32_t* ray = arena_.alloc<int32_t>(rays.n);
  int32_t* keys = arena_.alloc<int32_t>(rays.n);
  const bool all = which == Which::All;
  int n = 0;
  for (int i = 0; i < rays.n; ++i) {
    if (hits.shape[i] < 0) continue;
    const SceneShape& shape = scene_.shapes[static_cast<size_t>(hits.shape[i])];
    keys[i] = shape.sort_key;
    ray[n] = i;
    n += all || shape.emitter >= 0;
  }
  if (scene_.sort_keys > 1) sort_lanes(keys, n, ray, arena_);
  // As where one material fills the view: then nothing is copied.
  const bool in_place = n == rays.n && std::is_sorted(ray, ray + n);
  Points points;
  points.n = n;
  points.ray = ray;
  points.rays = in_place ? rays : gathered(rays, ray, n, arena_);
  points.rays.n = n;
  points.hits = in_place ? hits : gathered(hits, ray, n, arena_);
  points.radiance = arena_.rgb(n);
  for_lanes(n, [&](int i) { points.radiance.set(i, RGB(0.0f)); });
  points.at = compute_surfaces(scene_, {points.rays, points.hits}, arena_);
  points.at.texture_values = &worker_.statistics.texture_values;
  points.notes = new (arena_.alloc<PointNotes>(1)) PointNotes;
  points.notes->rays = rays.n;
  points.notes->px = arena_.alloc<int32_t>(n), points.notes->py = arena_.alloc<int32_t>(n);
  points.notes->index = arena_.alloc<uint32_t>(n);
  worker_.statistics.surface_points += n;
  if (kKnowsDifferentials && points.rays.differentials) worker_.statistics.footprints += n;
  delivering_.push_back(points);
  return points;
}

void Tracer::shade(Points& points) {
  const auto material_of = [&](int i) { return scene_.shapes[static_cast<size_t>(points.hits.shape[i])].material; };
  int count = 0;
  for (int i = 0; i < points.n; ++i) count += i == 0 || material_of(i) != material_of(i - 1);
  MaterialRun* const runs = arena_.alloc<MaterialRun>(count);
  int number = 0;
  for_runs(0, points.n, material_of, [&](int first, int last) {
    MaterialRun& run =
        *new (runs + number++) MaterialRun{points.at.range(first, last - first), LobeSet(arena_), {}, first};
    const Material& material = *scene_.materials[static_cast<size_t>(material_of(first))];
    if (scene_.plan.live(Effect::Bump)) {
      apply_bump(material.bump, static_cast<float>(scene_.space.scale), run.points);
      if (material.has_normal_map()) apply_normal_map(material.normalmap, material.normalscale, run.points);
    }
    material.lobes(run.points, run.lobes);
    run.lobes.keep(scene_.plan.lobes());
    for (int l = 0; l < run.lobes.count; ++l) {
      const LobeType type = run.lobes.lobes[l].type;
      run.scatters |= !is_specular(type);
      run.mirrors |= type == LobeType::SpecularReflection;
      run.refracts |= type == LobeType::SpecularTransmission;
    }
    if (run.scatters) run.frame = prepare_frame(run.lobes, run.points);
    points.notes->scatters |= run.scatters;
  });
  points.materials = {runs, static_cast<size_t>(count)};
}

void Tracer::add(const Rays& rays, const Seen& seen) {
  const RGBLanes& sum = worker_.chunk.radiance;
  for (int i = 0; i < seen.n; ++i) {
    const int ray = seen.lane[i], slot = rays.slot[ray];
    sum.set(slot, sum[slot] + rays.throughput[ray] * seen.radiance[i]);
  }
}

void Tracer::add(const Points& points, const Seen& seen) {
  for (int i = 0; i < seen.n; ++i) {
    const int to = seen.lane[i];
    points.radiance.set(to, points.radiance[to] + seen.radiance[i]);
  }
}

void Tracer::add(const Points& points, const DirectSamples&, const RGBLanes& light) {
  for_lanes(points.n, [&](int i) {
    points.radiance.r[i] += light.r[i], points.radiance.g[i] += light.g[i], points.radiance.b[i] += light.b[i];
  });
}

void Tracer::finish() {
  const RGBLanes& sum = worker_.chunk.radiance;
  for (const Points& p : delivering_) {
    const int32_t* const slot = p.rays.slot;
    if (p.n > 0 && are_consecutive(slot, p.n)) {
      const RGBLanes to = sum.from(slot[0]);
      for_lanes(p.n, [&](int i) { to.set(i, to[i] + p.rays.throughput[i] * p.radiance[i]); });
      continue;
    }
    for (int i = 0; i < p.n; ++i) sum.set(slot[i], sum[slot[i]] + p.rays.throughput[i] * p.radiance[i]);
  }
  delivering_.clear();
}

/// Which samples the points belong to, for the sampler.
const SampleKeys& Tracer::keys_of(const Points& points) {
  PointNotes& notes = *points.notes;
  if (notes.keys.px) return notes.keys;
  const SampleChunk& chunk = worker_.chunk;
  const int32_t* slot = points.rays.slot;
  for_lanes(points.n, [&](int i) {
    notes.px[i] = chunk.px[slot[i]], notes.py[i] = chunk.py[slot[i]];
    notes.index[i] = chunk.index[slot[i]];
  });
  notes.keys = {points.n, notes.px, notes.py, notes.index, points.rays.stream};
  return notes.keys;
}

const float* Tracer::draw_1d(const Points& points, int dimension) {
  float* const u = arena_.floats(points.n);
  scene_.sampler().get_1d(keys_of(points), worker_.layout.of_bounce(points.rays.depth, dimension), u);
  return u;
}

Uniform2 Tracer::draw_2d(const Points& points, int dimension) {
  const Uniform2 out{arena_.floats(points.n), arena_.floats(points.n)};
  scene_.sampler().get_2d(keys_of(points), worker_.layout.of_bounce(points.rays.depth, dimension), out.u, out.v);
  return out;
}

}  // namespace whit
