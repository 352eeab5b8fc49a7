// A round until its surfaces are known; what light does there is in round_direct.cpp and round_specular.cpp.

#include "core/render/round.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/fastmath.h"
#include "core/batch/gather.h"
#include "core/batch/sort.h"
#include "core/plugin/bump.h"
#include "core/render/round_log.h"

namespace whit {
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
  const StageScope stage(worker_.clock(), Stage::Intersect);
  ray_hits_ = {arena_.floats(count_),         arena_.alloc<int32_t>(count_), arena_.alloc<uint32_t>(count_),
               arena_.alloc<int32_t>(count_), arena_.floats(count_),         arena_.floats(count_)};
  const float* time = nullptr;
  if (scene_.plan.live(Effect::MotionBlur)) {
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
  if (scene_.plan.live(Effect::Interfaces)) pass_through_interfaces();
  if (worker_.log) worker_.log->rays(*this);
}

namespace {

/// Rays pass through so many interfaces, and are so often moved by no more than the error of their origin, before they are
/// taken to have stopped: nobody stacks as many shells, and a few coincident ones are passed in as many short steps.
constexpr int kMostPasses = 10000, kMostShortSteps = 64;

/// Whether a ray got ahead by less than a few units in the last place of where it is. NaN is no way ahead.
bool is_short_step(const Vec3f& from, const Vec3f& to, const Vec3f& d) {
  const float error = 5e-7f * std::max({std::abs(to.x), std::abs(to.y), std::abs(to.z)});
  return !(dot(to - from, d) > error);
}

}  // namespace

/// Rays that hit an interface go on from behind it, without differentials, until all have met a material or left. Those
/// that do not get ahead are lost, which is counted.
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
  uint8_t* short_steps = arena_.alloc<uint8_t>(count_);
  std::fill_n(short_steps, count_, uint8_t{0});
  for (int pass = 1; n > 0; ++pass) {
    ArenaScope scope(arena_);
    gather_hits(lanes, n);
    const ShadingBatch surface = compute_surfaces(scene_, hits_, arena_);
    const Vec3Lanes o = arena_.vec3(n);
    for (int i = 0; i < n; ++i) {
      const Vec3f d = hits_.d[i];
      o.set(i, offset_origin(surface.p[i], surface.p_error[i], surface.ng[i], d));
      short_steps[lanes[i]] += is_short_step(hits_.o[i], o[i], d);
      ray_o_.set(lanes[i], o[i]);
      if (!ray_rx_o_) continue;
      ray_rx_o_.set(lanes[i], o[i]), ray_ry_o_.set(lanes[i], o[i]);
      ray_rx_d_.set(lanes[i], kNoDifferential), ray_ry_d_.set(lanes[i], kNoDifferential);
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
      if (!passes(lane)) continue;
      if (pass < kMostPasses && short_steps[lane] < kMostShortSteps) {
        lanes[left++] = lane;
        continue;
      }
      ray_hits_.t[lane] = std::numeric_limits<float>::quiet_NaN(), ray_hits_.shape[lane] = -1;  // a lost ray
      ++worker_.statistics.stopped_rays;
    }
    n = left;
  }
}

void Round::add_escaped() {
  const StageScope stage(worker_.clock(), Stage::LightSampling);
  report_lost_rays();
  if (!scene_.plan.live(Effect::EnvironmentLights)) return;
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
    if (worker_.log) worker_.log->escaped(*this, lanes[i], radiance[i]);
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
  if (scene_.plan.live(Effect::MotionBlur)) {
    float* time = arena_.floats(n);
    gather(order, n, ray_time_, time);
    hits_.time = time;
  }
  if (!ray_rx_o_) return;
  hits_.rx_o = arena_.vec3(n), hits_.rx_d = arena_.vec3(n), hits_.ry_o = arena_.vec3(n), hits_.ry_d = arena_.vec3(n);
  gather(order, n, ray_rx_o_, hits_.rx_o);
  gather(order, n, ray_rx_d_, hits_.rx_d);
  gather(order, n, ray_ry_o_, hits_.ry_o);
  gather(order, n, ray_ry_d_, hits_.ry_d);
}

/// All rays and hits as they stand, without copying.
void Round::take_hits() {
  hits_ = {
      count_,         ray_o_,    ray_d_,    ray_hits_.t, ray_hits_.u, ray_hits_.v, ray_hits_.shape, ray_hits_.instance,
      ray_hits_.prim, ray_time_, ray_rx_o_, ray_rx_d_,   ray_ry_o_,   ray_ry_d_};
}

void Round::find_surfaces() {
  const StageScope stage(worker_.clock(), Stage::Interaction);
  ray_of_ = arena_.alloc<int32_t>(count_);
  int32_t* keys = arena_.alloc<int32_t>(count_);
  int n = 0;
  for (int i = 0; i < count_; ++i) {
    if (ray_hits_.shape[i] < 0) continue;
    keys[i] = scene_.shapes[static_cast<size_t>(ray_hits_.shape[i])].sort_key;
    ray_of_[n++] = i;
  }
  if (scene_.sort_keys > 1 || scene_.plan.everything_on) sort_lanes(keys, n, ray_of_, arena_);
  // As where one material fills the view.
  const bool in_place = n == count_ && std::is_sorted(ray_of_, ray_of_ + n);
  if (in_place) take_hits();
  else gather_hits(ray_of_, n);
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
  points_.clock = worker_.clock();
  points_.texture_values = &worker_.statistics.texture_values;
  worker_.statistics.surface_points += n;
  if (hits_.has_differentials()) worker_.statistics.footprints += n;
  shade_runs();
  if (needs_numbers()) keys_ = make_keys();
  if (worker_.log) worker_.log->surfaces(*this);
}

/// Splits the points into runs of one material, tilts normals by bump maps and asks for the lobes.
void Round::shade_runs() {
  const StageScope stage(worker_.clock(), Stage::Lobes);
  const auto material_of = [&](int i) { return scene_.shapes[static_cast<size_t>(hits_.shape[i])].material; };
  for (int first = 0, last; first < hits_.n; first = last) {
    last = first + 1;
    while (last < hits_.n && material_of(last) == material_of(first)) ++last;
    runs_.push_back({points_.range(first, last - first), LobeSet(arena_), {}, first});
    Run& run = runs_.back();
    const Material& material = *scene_.materials[static_cast<size_t>(material_of(first))];
    if (scene_.plan.live(Effect::Bump)) apply_bump(material.bump, static_cast<float>(scene_.space.scale), run.points);
    material.lobes(run.points, run.lobes);
    run.lobes.keep(scene_.plan.lobes());
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
  const StageScope stage(worker_.clock(), Stage::LightSampling);
  if (!scene_.plan.live(Effect::AreaLights)) return;
  for (int i = 0; i < hits_.n; ++i) {
    const SceneShape& shape = scene_.shapes[static_cast<size_t>(hits_.shape[i])];
    if (shape.emitter < 0) continue;
    const Light& light = *scene_.emitters[static_cast<size_t>(shape.emitter)];
    const RGB radiance = light.emitted({hits_.o[i], hits_.d[i], hits_.t[i], points_.p[i], points_.ng[i]});
    if (is_black(radiance)) continue;
    radiance_.set(i, radiance_[i] + radiance);
    if (worker_.log) worker_.log->emitted(*this, i, radiance);
  }
}

/// Whether a light or a choice between specular lobes will draw random numbers.
bool Round::needs_numbers() const {
  return scene_.light_dimensions > 0 || std::any_of(runs_.begin(), runs_.end(), [](const Run& r) {
           return count_lobes(r.lobes, LobeType::SpecularReflection) > 1 ||
                  count_lobes(r.lobes, LobeType::SpecularTransmission) > 1;
         });
}

SampleKeys Round::make_keys() const {
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

void Round::deliver() {
  const RGBLanes& sum = worker_.chunk.radiance;
  for (int i = 0; i < hits_.n; ++i) sum.set(slot_[i], sum[slot_[i]] + throughput_[i] * radiance_[i]);
}

}  // namespace whit
