// Direct light: samples of lights for surface points, what lobes do with them, and shadow rays.

#include <algorithm>
#include <limits>

#include "core/base/fastmath.h"
#include "core/base/radical_inverse.h"
#include "core/base/sampling.h"
#include "core/batch/gather.h"
#include "core/batch/runs.h"
#include "core/batch/sort.h"
#include "core/render/light_reach.h"
#include "core/render/surface.h"
#include "core/render/tracer.h"

namespace whit {

int Tracer::next_light(const Points& points, int light) {
  PointNotes& notes = *points.notes;
  if (notes.scratch) arena_.release(*notes.scratch);
  notes.scratch.reset();
  if (!notes.scatters) return -1;
  for (const auto n = static_cast<int>(scene_.lights.size()); light < n; ++light) {
    if (leaves_dark(scene_.lights[static_cast<size_t>(light)], points)) {
      ++worker_.statistics.lights_skipped;
      continue;
    }
    keys_of(points);
    notes.scratch = arena_.mark();
    return light;
  }
  return -1;
}

/// Whether the light adds nothing to any point, as far as bounds can tell.
bool Tracer::leaves_dark(const SceneLight& light, const Points& points) const {
  if (!scene_.skip_lights || !skip_dark || light.reach.from == LightReach::From::Anywhere) return false;
  PointNotes& notes = *points.notes;
  if (!notes.bounds) notes.bounds = bounds_of(points.at, points.materials);
  if (!cannot_reach(light.reach, *notes.bounds, points.at)) return false;
  if (!notes.finite) notes.finite = are_finite(points.at, points.materials);
  return *notes.finite;
}

DirectSamples Tracer::allocate_samples(const Points& points, bool densities) {
  const int n = points.n;
  DirectSamples s;
  s.n = n, s.arena = &arena_, s.p = points.at.p;
  s.wi = arena_.vec3(n), s.distance = arena_.floats(n), s.radiance = arena_.rgb(n);
  if (densities) s.pdf = arena_.floats(n);
  return s;
}

/// How many samples of a light a point is sent, on average.
float Tracer::expected_samples(int light, const Vec3f& p) const {
  if (scene_.light_choice) return scene_.light_choice->probability(light, p) * static_cast<float>(scene_.chosen_lights);
  return static_cast<float>(scene_.lights[static_cast<size_t>(light)].samples);
}

namespace {

/// Whether a light is asked for the points it chose: rays then end there, and not before the light, whose own surface
/// must be told from others in double precision.
bool gives_points(const SceneLight& light) { return light.end.on == RayEnd::On::Plane && light.end.touched(); }

}  // namespace

DirectSamples Tracer::sample(const Points& points, int light_number, int number, int of, bool densities) {
  const SceneLight& light = scene_.lights[static_cast<size_t>(light_number)];
  DirectSamples s = allocate_samples(points, densities && light.dimension >= 0);
  s.light = light_number;
  if (light.dimension >= 0) {
    const Uniform2 numbers = draw_2d(points, light.dimension);
    if (number > 0) {
      for_lanes(points.n, [&](int i) {
        const Vec2f at = lattice_point({numbers.u[i], numbers.v[i]}, number);
        numbers.u[i] = at.x, numbers.v[i] = at.y;
      });
    }
    s.u = numbers.u, s.v = numbers.v;
  }
  if (gives_points(light)) s.q = arena_.vec3(points.n);
  light.light->sample(s);
  if (of == 1) return s;
  const auto count = static_cast<float>(of);
  const float share = 1 / count;
  for_lanes(s.n, [&](int i) { s.radiance.set(i, s.radiance[i] * share); });
  if (s.pdf) for_lanes(s.n, [&](int i) { s.pdf[i] *= count; });
  return s;
}

namespace {

/// The samples of one run of the lanes of a batch, of which the numbers are in, and the arrays begin at the run.
LightSamples run_of(const LightSamples& s, int first, int n, const SceneLight& light) {
  LightSamples run = s;
  run.n = n;
  run.p = s.p.from(first), run.u = s.u + first, run.v = s.v + first;
  run.wi = s.wi.from(first), run.distance = s.distance + first, run.radiance = s.radiance.from(first);
  run.q = gives_points(light) ? s.q.from(first) : Vec3Lanes{};
  run.pdf = light.dimension >= 0 ? s.pdf + first : nullptr;
  return run;
}

/// Samples of the lights of a batch's points, one light after another: `order` has the points by light.
void sample_runs(const Scene& scene, const int32_t* light, const int32_t* order, const LightSamples& s) {
  const auto light_of = [&](int i) { return light[order[i]]; };
  for_runs(0, s.n, light_of, [&](int first, int last) {
    const SceneLight& from = scene.lights[static_cast<size_t>(light_of(first))];
    const LightSamples run = run_of(s, first, last - first, from);
    from.light->sample(run);
    // No direction that is sampled otherwise meets a delta light.
    if (!run.pdf) std::fill(s.pdf + first, s.pdf + last, std::numeric_limits<float>::infinity());
    if (!s.q || run.q) return;
    for (int i = first; i < last; ++i) s.q.set(i, s.p[i] + s.wi[i] * s.distance[i]);
  });
}

}  // namespace

ChosenLights Tracer::choose_lights(const Points& points, int dimension) {
  const int n = points.n, of = scene_.chosen_lights;
  if (!scene_.light_choice || !points.notes->scatters) return {};
  const float* const number = draw_1d(points, dimension);
  const Uniform2 on_light = draw_2d(points, dimension + 1);
  int32_t* const light = arena_.alloc<int32_t>(n * of);
  float* const expected = arena_.floats(n * of);
  const ArenaScope scratch(arena_);
  float* const u = arena_.floats(n);
  const float share = 1 / static_cast<float>(of);
  for (int k = 0; k < of; ++k) {
    // One number in each of as many equal parts: what has more than a part of the choice is never left out.
    const auto part = static_cast<float>(k);
    for_lanes(n, [=](int i) { u[i] = min_of((part + number[i]) * share, kBelowOne); });
    scene_.light_choice->choose(n, points.at.p, u, light + k * n, expected + k * n);
  }
  const auto count = static_cast<float>(of);
  for_lanes(n * of, [=](int i) { expected[i] *= count; });
  return {of, light, expected, on_light};
}

DirectSamples Tracer::sample(const Points& points, const ChosenLights& chosen, int number) {
  const int n = points.n;
  const int32_t* const light = chosen.light + number * n;
  const float* const expected = chosen.expected + number * n;
  DirectSamples s = allocate_samples(points, true);
  s.lights = light;
  if (scene_.any_touched) s.q = arena_.vec3(n);
  const ArenaScope scratch(arena_);
  int32_t* const order = arena_.alloc<int32_t>(n);
  for (int i = 0; i < n; ++i) order[i] = i;
  if (scene_.lights.size() > 1) sort_lanes(light, n, order, arena_);
  LightSamples sorted;
  sorted.n = n, sorted.arena = &arena_;
  const Vec3Lanes p = arena_.vec3(n);
  float *const u = arena_.floats(n), *const v = arena_.floats(n);
  for_lanes(n, [&](int i) {
    const int from = order[i];
    const Vec2f at = lattice_point({chosen.numbers.u[from], chosen.numbers.v[from]}, number);
    p.set(i, points.at.p[from]), u[i] = at.x, v[i] = at.y;
  });
  sorted.p = p, sorted.u = u, sorted.v = v;
  sorted.wi = arena_.vec3(n), sorted.distance = arena_.floats(n), sorted.radiance = arena_.rgb(n);
  sorted.pdf = arena_.floats(n);
  if (s.q) sorted.q = arena_.vec3(n);
  sample_runs(scene_, light, order, sorted);
  for (int i = 0; i < n; ++i) {
    const int to = order[i];
    s.wi.set(to, sorted.wi[i]);
    s.distance[to] = sorted.distance[i];
    s.radiance.set(to, sorted.radiance[i] * (1 / expected[to]));
    s.pdf[to] = expected[to] * sorted.pdf[i];
    if (s.q) s.q.set(to, sorted.q[i]);
  }
  return s;
}

Scattered Tracer::scatter(const Points& points, const Vec3Lanes& wi, bool densities, LobeKinds kinds) {
  Scattered out{arena_.rgb(points.n), densities ? arena_.floats(points.n) : nullptr};
  for (const MaterialRun& run : points.materials) {
    const RGBLanes f = out.f.from(run.first);
    float* const pdf = densities ? out.pdf + run.first : nullptr;
    if (run.scatters) {
      eval_lobes(run.lobes, run.points, run.frame, wi.from(run.first), f, pdf, kinds);
    } else {
      for_lanes(run.points.n, [&](int i) { f.set(i, RGB(0.0f)); });
      if (pdf) std::fill_n(pdf, run.points.n, 0.0f);
    }
  }
  return out;
}

/// The shadow rays of the lanes of a list, or of all lanes, which are then not copied.
RayLanes Tracer::shadow_rays(const Points& points, const DirectSamples& samples, const int32_t* lanes, int n) {
  const ShadingBatch& at = points.at;
  const Vec3Lanes o = arena_.vec3(n);
  RayLanes rays{n, o, samples.wi, samples.distance, nullptr, nullptr, {}, nullptr};
  if (n == points.n) {
    const Vec3Lanes wi = samples.wi;
    for_lanes(n, [&](int i) { o.set(i, offset_origin(at.p[i], at.p_error[i], at.ng[i], wi[i])); });
    rays.q = samples.q, rays.time = points.rays.time;
  } else {
    const Vec3Lanes d = rays.d = arena_.vec3(n);
    float* const t_max = arena_.floats(n);
    rays.t_max = t_max;
    for_lanes(n, [&](int i) {
      const int from = lanes[i];
      const Vec3f wi = samples.wi[from];
      d.set(i, wi);
      o.set(i, offset_origin(at.p[from], at.p_error[from], at.ng[from], wi));
      t_max[i] = samples.distance[from];
    });
    if (samples.q) gather(lanes, n, samples.q, rays.q = arena_.vec3(n));
    if (points.rays.time) {
      float* const time = arena_.floats(n);
      gather(lanes, n, points.rays.time, time);
      rays.time = time;
    }
  }
  if (samples.light >= 0) rays.end = &scene_.lights[static_cast<size_t>(samples.light)].end;
  if (samples.lights) {
    const RayEnd** ends = arena_.alloc<const RayEnd*>(n);
    for (int i = 0; i < n; ++i) ends[i] = &scene_.lights[static_cast<size_t>(samples.lights[lanes[i]])].end;
    rays.ends = ends;
  }
  return rays;
}

RGBLanes Tracer::visible(const Points& points, const DirectSamples& samples, const RGBLanes& light) {
  int32_t* lanes = arena_.alloc<int32_t>(points.n);
  int n = 0;
  for (int i = 0; i < points.n; ++i) {
    // Not "> 0": a NaN must reach the film's counter.
    lanes[n] = i;
    n += !(light.r[i] == 0 && light.g[i] == 0 && light.b[i] == 0);
  }
  if (n == 0 || !scene_.plan.live(Effect::Shadows)) return light;
  const RayLanes rays = shadow_rays(points, samples, lanes, n);
  uint8_t* blocked = arena_.alloc<uint8_t>(n);
  worker_.statistics.clear_rays += scene_.accel->occluded(rays, blocked);
  worker_.statistics.shadow_rays += n;
  for (int i = 0; i < n; ++i) {
    const int to = lanes[i];
    const float open = blocked[i] ? 0.0f : 1.0f;
    light.r[to] *= open, light.g[to] *= open, light.b[to] *= open;
  }
  return light;
}

}  // namespace whit
