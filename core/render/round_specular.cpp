// Mirrors and refraction: the rays that a round sends on to the next.

#include <algorithm>
#include <cmath>

#include "core/base/fastmath.h"
#include "core/base/hash.h"
#include "core/render/round.h"
#include "core/render/round_log.h"

namespace whit {

Round::Spawned Round::allocate_spawned() {
  const int n = hits_.n;
  Spawned s{arena_.vec3(n), arena_.rgb(n), {}, {}, {}, {}};
  if (hits_.has_differentials())
    s.rx_o = arena_.vec3(n), s.rx_d = arena_.vec3(n), s.ry_o = arena_.vec3(n), s.ry_d = arena_.vec3(n);
  return s;
}

void Round::spawn_specular() {
  bool mirrors = false, refracts = false;
  const EffectPlan& plan = scene_.plan;
  for (const Run& run : runs_) mirrors |= run.mirrors, refracts |= run.refracts;
  mirrors = plan.live(Effect::Reflection) && (mirrors || plan.everything_on);
  refracts = plan.live(Effect::Refraction) && (refracts || plan.everything_on);
  if (!mirrors && !refracts) return;
  const StageScope stage(worker_.clock(), Stage::Spawn);
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
        keys_, refraction ? worker_.layout.of_refraction(depth_) : worker_.layout.of_reflection(depth_), choice);
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
    if (hits_.has_differentials()) spawn_differentials(run, refraction, out);
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
    // What has no differentials sends none on.
    const bool any_x = hits_.rx_d[k] != kNoDifferential, any_y = hits_.ry_d[k] != kNoDifferential;
    out.rx_d.set(k, any_x ? (refraction ? refract_x : mirror_x) : kNoDifferential);
    out.ry_d.set(k, any_y ? (refraction ? refract_y : mirror_y) : kNoDifferential);
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
    if (worker_.log) worker_.log->spawned(*this, i, branch == 1, wi, weight);
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
