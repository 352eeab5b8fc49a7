// Direct light: one sample of one light for every surface point of a round, and its shadow ray.

#include <algorithm>
#include <cmath>

#include "core/base/fastmath.h"
#include "core/batch/gather.h"
#include "core/render/round.h"
#include "core/render/round_log.h"

namespace whit {
void Round::add_direct(int number) {
  const int n = hits_.n;
  if (std::none_of(runs_.begin(), runs_.end(), [](const Run& r) { return r.scatters; })) return;
  const StageScope stage(worker_.clock(), Stage::LightSampling);
  const SceneLight& light = scene_.lights[static_cast<size_t>(number)];
  if (leaves_dark(light)) {
    ++worker_.statistics.lights_skipped;
    return;
  }
  ArenaScope scope(arena_);
  LightSamples samples;
  samples.n = n;
  samples.arena = &arena_;
  samples.p = points_.p;
  samples.wi = arena_.vec3(n);
  samples.distance = arena_.floats(n);
  samples.radiance = arena_.rgb(n);
  if (light.dimension >= 0) {
    float *u = arena_.floats(n), *v = arena_.floats(n);
    scene_.sampler().get_2d(keys_, worker_.layout.of_light(depth_, light.dimension), u, v);
    samples.u = u, samples.v = v;
  }
  if (light.end.on == RayEnd::On::Plane && light.end.touched) samples.q = arena_.vec3(n);
  light.light->sample(samples);
  const RGBLanes f = arena_.rgb(n);
  scatter(samples, f);
  add_unshadowed(light, samples, f);
}

/// Whether the light adds nothing to any point, as far as bounds can tell. Not while there is a log, which tells what
/// became of every light.
bool Round::leaves_dark(const SceneLight& light) {
  if (!scene_.skip_lights || worker_.log || light.reach.from == LightReach::From::Anywhere) return false;
  if (!bounds_) bounds_ = bounds_of(points_, runs_);
  if (!cannot_reach(light.reach, *bounds_, points_)) return false;
  if (!finite_) finite_ = are_finite(points_, runs_);
  return *finite_;
}

/// What the lobes send to the camera of each sample's light: f |cos| times its radiance.
void Round::scatter(const LightSamples& samples, const RGBLanes& f) {
  const StageScope stage(worker_.clock(), Stage::Lobes);
  for (const Run& run : runs_) {
    const RGBLanes out = f.from(run.first);
    if (run.scatters) {
      eval_lobes(run.lobes, run.points, run.frame, samples.wi.from(run.first), out);
    } else {
      for_lanes(run.points.n, [&](int i) { out.set(i, RGB(0.0f)); });
    }
  }
  for_lanes(samples.n, [&](int i) {
    f.r[i] *= samples.radiance.r[i];
    f.g[i] *= samples.radiance.g[i];
    f.b[i] *= samples.radiance.b[i];
  });
}

/// Traces shadow rays for the points that the light would reach, and adds the light of those it does.
void Round::add_unshadowed(const SceneLight& light, const LightSamples& samples, const RGBLanes& contribution) {
  const StageScope stage(worker_.clock(), Stage::Shadow);
  int32_t* lanes = arena_.alloc<int32_t>(hits_.n);
  int n = 0;
  if (worker_.log) worker_.log->light(*this, light, samples, contribution);
  for (int i = 0; i < hits_.n; ++i) {
    // Not "> 0": a NaN must reach the film's counter.
    lanes[n] = i;
    n += !(contribution.r[i] == 0 && contribution.g[i] == 0 && contribution.b[i] == 0);
  }
  if (n == 0) return;
  const Vec3Lanes o = arena_.vec3(n), d = arena_.vec3(n);
  float* t_max = arena_.floats(n);
  for_lanes(n, [&](int i) {
    const int from = lanes[i];
    const Vec3f wi = samples.wi[from];
    d.set(i, wi);
    o.set(i, offset_origin(points_.p[from], points_.p_error[from], points_.ng[from], wi));
    t_max[i] = samples.distance[from];
  });
  Vec3Lanes q;
  if (samples.q) {
    q = arena_.vec3(n);
    gather(lanes, n, samples.q, q);
  }
  float* time = nullptr;
  if (scene_.plan.live(Effect::MotionBlur)) {
    time = arena_.floats(n);
    gather(lanes, n, hits_.time, time);
  }
  uint8_t* blocked = arena_.alloc<uint8_t>(n);
  if (scene_.plan.live(Effect::Shadows)) {
    scene_.accel->occluded({n, o, d, t_max, time, &light.end, q}, blocked);
    worker_.statistics.shadow_rays += n;
  } else {
    std::fill_n(blocked, n, uint8_t{0});
  }
  for (int i = 0; i < n; ++i) {
    const int to = lanes[i];
    const float open = blocked[i] ? 0.0f : 1.0f;
    if (worker_.log) worker_.log->shadow(*this, to, blocked[i] != 0);
    radiance_.r[to] += open * contribution.r[to];
    radiance_.g[to] += open * contribution.g[to];
    radiance_.b[to] += open * contribution.b[to];
  }
}

}  // namespace whit
