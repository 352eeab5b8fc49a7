#include "core/render/round.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "core/base/fastmath.h"
#include "core/base/hash.h"
#include "core/batch/sort.h"
#include "core/plugin/bump.h"

namespace whit {
namespace {

void gather(const int32_t* from, int n, const float* values, float* out) {
  for_lanes(n, [&](int i) { out[i] = values[from[i]]; });
}
void gather(const int32_t* from, int n, const Vec3Lanes& values, const Vec3Lanes& out) {
  gather(from, n, values.x, out.x);
  gather(from, n, values.y, out.y);
  gather(from, n, values.z, out.z);
}

/// Where a shadow ray stops in front of an emitter whose points are off by `error` at most, measured along the ray.
inline float in_front(float distance, float error, float cosine) {
  return max_of(0.0f, distance - error / max_of(std::abs(cosine), 1e-3f));
}

/// Shadow rays stop this fraction short of the light's surface: the rounding of t in the ray tracer.
constexpr float kShadowShortening = 1 - 4e-6f;

}  // namespace

Round::Round(Worker& worker, int depth, int first, int count)
    : worker_(worker),
      scene_(worker.scene),
      arena_(worker.arena),
      scope_(worker.arena),
      depth_(depth),
      rays_(worker.level(depth)),
      first_(first),
      count_(count),
      runs_(worker.runs) {
  runs_.clear();
  auto& s = worker_.statistics;
  if (depth == 0) s.camera_rays += count;
}

// ---- Intersection ----

void Round::intersect() {
  ray_hits_ = {arena_.floats(count_),         arena_.alloc<int32_t>(count_), arena_.alloc<uint32_t>(count_),
               arena_.alloc<int32_t>(count_), arena_.floats(count_),         arena_.floats(count_)};
  const float* time = nullptr;
  if (worker_.chunk.time) {
    float* t = arena_.floats(count_);
    gather(rays_.slot + first_, count_, worker_.chunk.time, t);
    time = t;
  }
  ray_time_ = time;
  ray_o_ = rays_.o.from(first_), ray_d_ = rays_.d.from(first_);
  if (rays_.rx_o) {
    ray_rx_o_ = rays_.rx_o.from(first_), ray_rx_d_ = rays_.rx_d.from(first_);
    ray_ry_o_ = rays_.ry_o.from(first_), ray_ry_d_ = rays_.ry_d.from(first_);
  }
  scene_.accel->intersect({count_, ray_o_, ray_d_, nullptr, time}, ray_hits_, depth_ == 0);
  if (scene_.plan.live(Effect::Interface)) pass_through_interfaces();
}

/// Rays that hit an interface go on from behind it, without differentials, until all have met a material or left.
void Round::pass_through_interfaces() {
  const auto passes = [&](int i) {
    return ray_hits_.shape[i] >= 0 && scene_.shapes[static_cast<size_t>(ray_hits_.shape[i])].passes_through;
  };
  int32_t* lanes = arena_.alloc<int32_t>(count_);
  int n = 0;
  for (int i = 0; i < count_; ++i) {
    if (passes(i)) lanes[n++] = i;
  }
  if (n == 0) return;
  // Origins (and footprints) change: from here on the round has copies of its own.
  const auto copy = [&](Vec3Lanes& v) {
    const Vec3Lanes own = arena_.vec3(count_);
    for_lanes(count_, [&](int i) { own.set(i, v[i]); });
    v = own;
  };
  copy(ray_o_);
  if (ray_rx_o_) copy(ray_rx_o_), copy(ray_rx_d_), copy(ray_ry_o_), copy(ray_ry_d_);
  while (n > 0) {
    ArenaScope scope(arena_);
    gather_hits(lanes, n);
    const ShadingBatch surface = compute_surfaces(scene_, hits_, arena_);
    const Vec3Lanes o = arena_.vec3(n);
    for (int i = 0; i < n; ++i) {
      const Vec3f d = hits_.d[i];
      o.set(i, offset_origin(surface.p[i], surface.p_error[i], surface.ng[i], d));
      ray_o_.set(lanes[i], o[i]);
      if (!ray_rx_o_) continue;
      ray_rx_o_.set(lanes[i], o[i]), ray_ry_o_.set(lanes[i], o[i]);
      ray_rx_d_.set(lanes[i], d), ray_ry_d_.set(lanes[i], d);
    }
    const HitLanes next{arena_.floats(n),         arena_.alloc<int32_t>(n), arena_.alloc<uint32_t>(n),
                        arena_.alloc<int32_t>(n), arena_.floats(n),         arena_.floats(n)};
    scene_.accel->intersect({n, o, hits_.d, nullptr, hits_.time}, next, false);
    worker_.statistics.passing_rays += n;
    int left = 0;
    for (int i = 0; i < n; ++i) {
      const int lane = lanes[i];
      ray_hits_.t[lane] = next.t[i], ray_hits_.shape[lane] = next.shape[i], ray_hits_.prim[lane] = next.prim[i];
      ray_hits_.instance[lane] = next.instance[i], ray_hits_.u[lane] = next.u[i], ray_hits_.v[lane] = next.v[i];
      if (passes(lane)) lanes[left++] = lane;
    }
    n = left;
  }
}

void Round::add_escaped() {
  report_lost_rays();
  if (scene_.environments.empty()) return;
  ArenaScope scope(arena_);
  int32_t* lanes = arena_.alloc<int32_t>(count_);
  int n = 0;
  for (int i = 0; i < count_; ++i) {
    if (ray_hits_.shape[i] < 0) lanes[n++] = i;
  }
  if (n == 0) return;
  const Vec3Lanes o = arena_.vec3(n), d = arena_.vec3(n);
  gather(lanes, n, ray_o_, o);
  gather(lanes, n, ray_d_, d);
  const RGBLanes radiance = arena_.rgb(n);
  for_lanes(n, [&](int i) { radiance.set(i, RGB(0.0f)); });
  for (const Light* light : scene_.environments) light->add_escaped(n, o, d, radiance);
  const RGBLanes& sum = worker_.chunk.radiance;
  for (int i = 0; i < n; ++i) {
    const int ray = first_ + lanes[i], slot = rays_.slot[ray];
    sum.set(slot, sum[slot] + rays_.throughput[ray] * radiance[i]);
  }
}

/// A ray that could not be traced makes its sample invalid, so that it is counted and not just missing.
void Round::report_lost_rays() {
  const RGBLanes& sum = worker_.chunk.radiance;
  for (int i = 0; i < count_; ++i) {
    if (std::isnan(ray_hits_.t[i])) sum.set(rays_.slot[first_ + i], RGB(std::numeric_limits<float>::quiet_NaN()));
  }
}

// ---- Surfaces ----

/// Gathers rays and hits of the given lanes, in that order, into hits_.
void Round::gather_hits(const int32_t* order, int n) {
  hits_ = {};
  hits_.n = n;
  hits_.o = arena_.vec3(n), hits_.d = arena_.vec3(n);
  hits_.t = arena_.floats(n), hits_.u = arena_.floats(n), hits_.v = arena_.floats(n);
  hits_.shape = arena_.alloc<int32_t>(n), hits_.instance = arena_.alloc<int32_t>(n);
  hits_.prim = arena_.alloc<uint32_t>(n);
  gather(order, n, ray_o_, hits_.o);
  gather(order, n, ray_d_, hits_.d);
  for_lanes(n, [&](int i) {
    const int32_t from = order[i];
    hits_.t[i] = ray_hits_.t[from], hits_.u[i] = ray_hits_.u[from], hits_.v[i] = ray_hits_.v[from];
    hits_.shape[i] = ray_hits_.shape[from], hits_.instance[i] = ray_hits_.instance[from];
    hits_.prim[i] = ray_hits_.prim[from];
  });
  if (ray_time_) {
    hits_.time = arena_.floats(n);
    gather(order, n, ray_time_, hits_.time);
  }
  if (!ray_rx_o_) return;
  hits_.rx_o = arena_.vec3(n), hits_.rx_d = arena_.vec3(n), hits_.ry_o = arena_.vec3(n), hits_.ry_d = arena_.vec3(n);
  gather(order, n, ray_rx_o_, hits_.rx_o);
  gather(order, n, ray_rx_d_, hits_.rx_d);
  gather(order, n, ray_ry_o_, hits_.ry_o);
  gather(order, n, ray_ry_d_, hits_.ry_d);
}

void Round::find_surfaces() {
  ray_of_ = arena_.alloc<int32_t>(count_);
  int32_t* keys = arena_.alloc<int32_t>(count_);
  int n = 0;
  for (int i = 0; i < count_; ++i) {
    if (ray_hits_.shape[i] < 0) continue;
    keys[i] = scene_.shapes[static_cast<size_t>(ray_hits_.shape[i])].sort_key;
    ray_of_[n++] = i;
  }
  sort_lanes(keys, n, ray_of_, arena_);
  gather_hits(ray_of_, n);
  throughput_ = arena_.rgb(n), radiance_ = arena_.rgb(n);
  slot_ = arena_.alloc<int32_t>(n), stream_ = arena_.alloc<uint32_t>(n);
  for_lanes(n, [&](int i) {
    const int ray = first_ + ray_of_[i];
    throughput_.r[i] = rays_.throughput.r[ray], throughput_.g[i] = rays_.throughput.g[ray];
    throughput_.b[i] = rays_.throughput.b[ray];
    slot_[i] = rays_.slot[ray], stream_[i] = rays_.stream[ray];
    radiance_.r[i] = radiance_.g[i] = radiance_.b[i] = 0;
  });
  points_ = compute_surfaces(scene_, hits_, arena_);
  worker_.statistics.surface_points += n;
  if (hits_.rx_o) worker_.statistics.footprints += n;
  shade_runs();
}

/// Splits the points into runs of one material, tilts normals by bump maps and asks for the lobes.
void Round::shade_runs() {
  const auto material_of = [&](int i) { return scene_.shapes[static_cast<size_t>(hits_.shape[i])].material; };
  for (int first = 0, last; first < hits_.n; first = last) {
    last = first + 1;
    while (last < hits_.n && material_of(last) == material_of(first)) ++last;
    runs_.push_back({points_.range(first, last - first), LobeSet(arena_), {}, first});
    Run& run = runs_.back();
    const Material& material = *scene_.materials[static_cast<size_t>(material_of(first))];
    if (!material.bump.is_constant()) apply_bump(material.bump, static_cast<float>(scene_.space.scale), run.points);
    material.lobes(run.points, run.lobes);
    for (int l = 0; l < run.lobes.count; ++l) {
      const LobeType type = run.lobes.lobes[l].type;
      run.scatters |= !is_specular(type);
      run.mirrors |= type == LobeType::SpecularReflection;
      run.refracts |= type == LobeType::SpecularTransmission;
    }
    if (run.scatters) run.frame = prepare_frame(run.lobes, run.points);
  }
}

void Round::add_emitted() {
  if (!scene_.plan.live(Effect::AreaLight)) return;
  for (int i = 0; i < hits_.n; ++i) {
    const int e = scene_.shapes[static_cast<size_t>(hits_.shape[i])].emission;
    if (e < 0) continue;
    const Emission& emission = scene_.emissions[static_cast<size_t>(e)];
    if (emission.two_sided || dot(points_.ng[i], points_.wo[i]) > 0) {
      radiance_.set(i, radiance_[i] + emission.radiance);
    }
  }
}

// ---- Direct light ----

SampleKeys Round::keys() const {
  const SampleChunk& chunk = worker_.chunk;
  SampleKeys k;
  k.n = hits_.n;
  int32_t *px = arena_.alloc<int32_t>(k.n), *py = arena_.alloc<int32_t>(k.n);
  uint32_t* index = arena_.alloc<uint32_t>(k.n);
  for_lanes(k.n, [&](int i) {
    px[i] = chunk.px[slot_[i]], py[i] = chunk.py[slot_[i]];
    index[i] = chunk.index[slot_[i]];
  });
  k.px = px, k.py = py, k.index = index, k.stream = stream_;
  return k;
}

void Round::add_direct(int number) {
  const int n = hits_.n;
  if (std::none_of(runs_.begin(), runs_.end(), [](const Run& r) { return r.scatters; })) return;
  ArenaScope scope(arena_);
  const SceneLight& light = scene_.lights[static_cast<size_t>(number)];
  LightSamples samples;
  samples.n = n;
  samples.p = points_.p;
  samples.wi = arena_.vec3(n);
  samples.distance = arena_.floats(n);
  samples.radiance = arena_.rgb(n);
  if (!light.is_delta) {
    float *u = arena_.floats(n), *v = arena_.floats(n);
    scene_.sampler().get_2d(keys(), worker_.layout.of_light(depth_, light.dimension), u, v);
    samples.u = u, samples.v = v;
  }
  if (light.light) {
    light.light->sample(samples);
  } else {
    sample_emitter(light, samples);
  }
  const RGBLanes f = arena_.rgb(n);
  for (const Run& run : runs_) {
    const RGBLanes out = f.from(run.first);
    if (run.scatters) {
      eval_lobes(run.lobes, run.points, run.frame, samples.wi.from(run.first), out);
    } else {
      for_lanes(run.points.n, [&](int i) { out.set(i, RGB(0.0f)); });
    }
  }
  for_lanes(n, [&](int i) {
    f.r[i] *= samples.radiance.r[i];
    f.g[i] *= samples.radiance.g[i];
    f.b[i] *= samples.radiance.b[i];
  });
  add_unshadowed(samples, f);
}

/// Traces shadow rays for the points that the light would reach, and adds the light of those it does.
void Round::add_unshadowed(const LightSamples& samples, const RGBLanes& contribution) {
  int32_t* lanes = arena_.alloc<int32_t>(hits_.n);
  int n = 0;
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
    t_max[i] = samples.distance[from] * kShadowShortening;
  });
  float* time = nullptr;
  if (hits_.time) {
    time = arena_.floats(n);
    gather(lanes, n, hits_.time, time);
  }
  uint8_t* blocked = arena_.alloc<uint8_t>(n);
  scene_.accel->occluded({n, o, d, t_max, time}, blocked, true);
  worker_.statistics.shadow_rays += n;
  for (int i = 0; i < n; ++i) {
    const int to = lanes[i];
    const float open = blocked[i] ? 0.0f : 1.0f;
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
  const float back = std::abs(n.x) * error.x + std::abs(n.y) * error.y + std::abs(n.z) * error.z;
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
    const bool lit = ((cosine > 0) | (two_sided & (cosine < 0))) & (squared > 0);
    const float geometry = lit ? std::abs(cosine) * area / squared : 0.0f;
    out.wi.set(i, wi);
    out.distance[i] = in_front(distance, back, cosine);
    out.radiance.set(i, {radiance.x * geometry, radiance.y * geometry, radiance.z * geometry});
  });
}

void Round::sample_analytic(const SceneLight& light, const LightSamples& samples) const {
  const AnalyticShape& shape = *scene_.shapes[static_cast<size_t>(light.shape)].analytic;
  float *cosines = arena_.floats(samples.n), *pdfs = arena_.floats(samples.n);
  shape.sample_lanes({samples.n, samples.p, samples.u, samples.v, samples.wi, samples.distance, cosines, pdfs});
  const RGB radiance = light.radiance;
  const bool two_sided = light.two_sided;
  for_lanes(samples.n, [&](int i) {
    const float cosine = cosines[i], distance = samples.distance[i];
    const bool lit = (pdfs[i] > 0) & ((cosine > 0) | (two_sided & (cosine < 0)));
    const float weight = lit ? 1 / pdfs[i] : 0.0f;
    samples.radiance.set(i, {radiance.x * weight, radiance.y * weight, radiance.z * weight});
    const Vec3f q = samples.p[i] + samples.wi[i] * distance;
    samples.distance[i] = in_front(distance, 6e-7f * (std::abs(q.x) + std::abs(q.y) + std::abs(q.z)), cosine);
  });
}

void Round::deliver() {
  const RGBLanes& sum = worker_.chunk.radiance;
  for (int i = 0; i < hits_.n; ++i) sum.set(slot_[i], sum[slot_[i]] + throughput_[i] * radiance_[i]);
}

// ---- Mirrors and refraction ----

Round::Spawned Round::allocate_spawned() {
  const int n = hits_.n;
  Spawned s{arena_.vec3(n), arena_.rgb(n), {}, {}, {}, {}};
  if (hits_.rx_o) s.rx_o = arena_.vec3(n), s.rx_d = arena_.vec3(n), s.ry_o = arena_.vec3(n), s.ry_d = arena_.vec3(n);
  return s;
}

void Round::spawn_specular() {
  bool mirrors = false, refracts = false;
  for (const Run& run : runs_) mirrors |= run.mirrors, refracts |= run.refracts;
  if (!mirrors && !refracts) return;
  ArenaScope scope(arena_);
  Spawned reflected, refracted;
  if (mirrors) spawn(false, reflected = allocate_spawned());
  if (refracts) spawn(true, refracted = allocate_spawned());
  append_children(reflected, refracted, mirrors, refracts);
}

/// Directions, weights and differentials of one kind of specular rays at every point.
void Round::spawn(bool refraction, const Spawned& out) {
  const LobeType type = refraction ? LobeType::SpecularTransmission : LobeType::SpecularReflection;
  float* choice = nullptr;
  if (std::any_of(runs_.begin(), runs_.end(), [&](const Run& r) { return count_lobes(r.lobes, type) > 1; })) {
    choice = arena_.floats(hits_.n);
    scene_.sampler().get_1d(
        keys(), refraction ? worker_.layout.of_refraction(depth_) : worker_.layout.of_reflection(depth_), choice);
  }
  for (const Run& run : runs_) {
    const Vec3Lanes wi = out.wi.from(run.first);
    const RGBLanes weight = out.weight.from(run.first);
    if (!(refraction ? run.refracts : run.mirrors)) {
      for_lanes(run.points.n, [&](int i) { weight.set(i, RGB(0.0f)); });
      continue;
    }
    const float* u = choice ? choice + run.first : nullptr;
    if (refraction) {
      specular_transmission(run.lobes, run.points, u, wi, weight);
    } else {
      specular_reflection(run.lobes, run.points, u, wi, weight);
    }
    if (hits_.rx_o) spawn_differentials(run, refraction, out);
  }
}

/// Differential rays of specular reflection (PBR 3e, section 10.1.3) and transmission (Igehy 1999).
void Round::spawn_differentials(const Run& run, bool refraction, const Spawned& out) const {
  const ShadingBatch& s = run.points;
  const int first = run.first;
  const float* eta_in = run.lobes.eta;
  for_lanes(s.n, [&](int i) {
    const int k = first + i;
    const Vec3f wo = s.wo[i], wi = out.wi[k];
    Vec3f ns = s.ns[i];
    Vec3f dndx = s.dndu[i] * s.dudx[i] + s.dndv[i] * s.dvdx[i];
    Vec3f dndy = s.dndu[i] * s.dudy[i] + s.dndv[i] * s.dvdy[i];
    const Vec3f dwodx = -hits_.rx_d[k] - wo, dwody = -hits_.ry_d[k] - wo;
    out.rx_o.set(k, s.p[i] + s.dpdx[i]);
    out.ry_o.set(k, s.p[i] + s.dpdy[i]);
    const bool leaving = refraction && dot(wo, ns) < 0;
    const float turn = leaving ? -1.0f : 1.0f;
    ns = ns * turn, dndx = dndx * turn, dndy = dndy * turn;
    const float ddndx = dot(dwodx, ns) + dot(wo, dndx), ddndy = dot(dwody, ns) + dot(wo, dndy);
    const float cos_o = dot(wo, ns), cos_i = std::abs(dot(wi, ns));
    const float inside = eta_in ? eta_in[i] : 1.0f;
    const float eta = leaving ? inside : 1 / inside;
    const float mu = eta * cos_o - cos_i;
    const float dmu = cos_i > 0 ? eta - eta * eta * cos_o / cos_i : 0.0f;
    const Vec3f mirror_x = wi - dwodx + (dndx * cos_o + ns * ddndx) * 2.0f;
    const Vec3f mirror_y = wi - dwody + (dndy * cos_o + ns * ddndy) * 2.0f;
    const Vec3f refract_x = wi - dwodx * eta + dndx * mu + ns * (dmu * ddndx);
    const Vec3f refract_y = wi - dwody * eta + dndy * mu + ns * (dmu * ddndy);
    out.rx_d.set(k, refraction ? refract_x : mirror_x);
    out.ry_d.set(k, refraction ? refract_y : mirror_y);
  });
}

/// Queues the new rays ray by ray, reflection before refraction: the order of a sample's rays is its own.
void Round::append_children(const Spawned& reflected, const Spawned& refracted, bool any_reflected,
                            bool any_refracted) {
  RayList& next = worker_.level(depth_ + 1);
  next.reserve(next.n + 2 * hits_.n);
  int32_t* point_of = arena_.alloc<int32_t>(count_);
  std::fill_n(point_of, count_, -1);
  for (int i = 0; i < hits_.n; ++i) point_of[ray_of_[i]] = i;
  const auto push = [&](int i, const Spawned& s, uint32_t branch) {
    const RGB weight = s.weight[i];
    if (weight.x == 0 && weight.y == 0 && weight.z == 0) return false;
    const int to = next.n++;
    const Vec3f wi = s.wi[i];
    next.o.set(to, offset_origin(points_.p[i], points_.p_error[i], points_.ng[i], wi));
    next.d.set(to, wi);
    next.throughput.set(to, throughput_[i] * weight);
    next.slot[to] = slot_[i];
    next.stream[to] = hash_combine(stream_[i], branch);
    if (next.rx_o) {
      next.rx_o.set(to, s.rx_o[i]), next.rx_d.set(to, s.rx_d[i]);
      next.ry_o.set(to, s.ry_o[i]), next.ry_d.set(to, s.ry_d[i]);
    }
    return true;
  };
  auto& stats = worker_.statistics;
  for (int ray = 0; ray < count_; ++ray) {
    const int i = point_of[ray];
    if (i < 0) continue;
    if (any_reflected) stats.reflection_rays += push(i, reflected, 1);
    if (any_refracted) stats.refraction_rays += push(i, refracted, 2);
  }
}

}  // namespace whit
