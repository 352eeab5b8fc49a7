// Direct light: one sample of one light for every surface point of a round, and its shadow ray.

#include <algorithm>
#include <cmath>

#include "core/base/fastmath.h"
#include "core/batch/gather.h"
#include "core/render/round.h"
#include "core/render/round_log.h"

namespace whit {
namespace {

/// Where a shadow ray stops in front of an emitting triangle and of what else lies in its plane, when the ray tracer's
/// planes are off by `error` at most.
inline float in_front(float distance, float error, float cosine) {
  return max_of(0.0f, distance - error / max_of(std::abs(cosine), 1e-3f));
}

}  // namespace

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
  samples.p = points_.p;
  samples.wi = arena_.vec3(n);
  samples.distance = arena_.floats(n);
  samples.radiance = arena_.rgb(n);
  if (!light.is_delta) {
    float *u = arena_.floats(n), *v = arena_.floats(n);
    scene_.sampler().get_2d(keys_, worker_.layout.of_light(depth_, light.dimension), u, v);
    samples.u = u, samples.v = v;
  }
  if (light.end.on == RayEnd::On::Plane && light.end.touched) samples.q = arena_.vec3(n);
  if (light.light) {
    light.light->sample(samples);
  } else {
    sample_emitter(light, samples);
  }
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

void Round::sample_emitter(const SceneLight& light, const LightSamples& samples) const {
  if (scene_.shapes[static_cast<size_t>(light.shape)].mesh) {
    sample_triangle(light, samples);
  } else {
    sample_analytic(light, samples);
  }
}

/// Uniform by area (PBR 3e, section 13.6.5), the density turned into one over solid angle.
void Round::sample_triangle(const SceneLight& light, const LightSamples& samples) const {
  const SceneShape& shape = scene_.shapes[static_cast<size_t>(light.shape)];
  const Mesh& mesh = *shape.mesh;
  const uint32_t* index = &mesh.indices[3 * static_cast<size_t>(light.prim)];
  const Vec3f a = mesh.position(index[0]), b = mesh.position(index[1]), c = mesh.position(index[2]);
  const Vec3d area_vector = (Vec3d(b) - Vec3d(a)).cross(Vec3d(c) - Vec3d(a)) * 0.5;
  const float area = static_cast<float>(area_vector.length());
  Vec3f n(area_vector.normalized());
  bool has_normals = false;
  Vec3f na(0, 0, 0), nb(0, 0, 0), nc(0, 0, 0);
  if (!mesh.normals.empty()) {
    na = mesh.normal(index[0]), nb = mesh.normal(index[1]), nc = mesh.normal(index[2]);
    has_normals = true;
  }
  const float flip = shape.flips ? -1.0f : 1.0f;
  const RGB radiance = light.radiance;
  const bool two_sided = light.two_sided;
  const Vec3f error =
      (Vec3f(std::abs(a.x), std::abs(a.y), std::abs(a.z)) + Vec3f(std::abs(b.x), std::abs(b.y), std::abs(b.z)) +
       Vec3f(std::abs(c.x), std::abs(c.y), std::abs(c.z))) *
      6e-7f;
  // Where more than its own plane is near, rays end on the triangle, and the ray tracer decides what is before them.
  const float back =
      light.end.touched ? 0.0f : std::abs(n.x) * error.x + std::abs(n.y) * error.y + std::abs(n.z) * error.z;
  // Points in the plane of the triangle are on neither side of it; of what else is there, too, none can tell.
  const Vec3d& e = light.end.error;
  const Vec3f rounding(e * 2.0);  // the triangle's and the point's
  const float off = std::abs(n.x) * rounding.x + std::abs(n.y) * rounding.y + std::abs(n.z) * rounding.z;
  const float unsure = light.end.touched ? off : 0.0f;
  const LightSamples out = samples;
  for_lanes(samples.n, [=](int i) {
    const float root = safe_sqrt(out.u[i]);
    const float b0 = 1 - root, b1 = out.v[i] * root, b2 = 1 - b0 - b1;
    const Vec3f q = a * b0 + b * b1 + c * b2;
    // The front is where a ray that hits sees it (mesh_surfaces): flipped, then turned to the flipped shading normal.
    const Vec3f interpolated = (na * b0 + nb * b1 + nc * b2) * flip;
    Vec3f front = n * flip;
    const bool turned = has_normals & (dot(front, interpolated) < 0);
    const float side = turned ? -1.0f : 1.0f;
    front = front * side;
    const Vec3f to = q - out.p[i];
    const float squared = dot(to, to);
    const float distance = std::sqrt(squared);
    const float inverse = squared > 0 ? 1 / distance : 0.0f;
    const Vec3f wi = to * inverse;
    const float cosine = -dot(front, wi);
    const bool lit =
        ((cosine > 0) | (two_sided & (cosine < 0))) & (squared > 0) & !(std::abs(cosine) * distance < unsure);
    const float geometry = lit ? std::abs(cosine) * area / squared : 0.0f;
    out.wi.set(i, wi);
    out.distance[i] = in_front(distance, back, cosine);
    out.radiance.set(i, {radiance.x * geometry, radiance.y * geometry, radiance.z * geometry});
  });
  if (!out.q) return;
  for_lanes(samples.n, [=](int i) {
    const float root = safe_sqrt(out.u[i]);
    const float b0 = 1 - root, b1 = out.v[i] * root;
    out.q.set(i, a * b0 + b * b1 + c * (1 - b0 - b1));
  });
}

void Round::sample_analytic(const SceneLight& light, const LightSamples& samples) const {
  const AnalyticShape& shape = *scene_.shapes[static_cast<size_t>(light.shape)].analytic;
  float *cosines = arena_.floats(samples.n), *pdfs = arena_.floats(samples.n);
  shape.sample_lanes({samples.n, samples.p, samples.u, samples.v, samples.wi, samples.distance, cosines, pdfs});
  const RGB radiance = light.radiance;
  const bool two_sided = light.two_sided;
  for_lanes(samples.n, [&](int i) {
    const float cosine = cosines[i];
    const bool lit = (pdfs[i] > 0) & ((cosine > 0) | (two_sided & (cosine < 0)));
    const float weight = lit ? 1 / pdfs[i] : 0.0f;
    samples.radiance.set(i, {radiance.x * weight, radiance.y * weight, radiance.z * weight});
  });
}

}  // namespace whit
