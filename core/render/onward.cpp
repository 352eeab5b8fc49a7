// Where light is followed to: the rays that points send on.

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/fastmath.h"
#include "core/base/hash.h"
#include "core/batch/fields.h"
#include "core/render/surface.h"
#include "core/render/tracer.h"

namespace whit {
namespace {

/// Differential rays of specular reflection (PBR 3e, section 10.1.3) and transmission (Igehy 1999).
void specular_differentials(const MaterialRun& run, bool refraction, const RayDifferentials& in, const Onward& onward) {
  const RayDifferentials& out = onward.differentials;
  const ShadingBatch& s = run.points;
  const int first = run.first;
  const float* eta_in = run.lobes.eta;
  for_lanes(s.n, [&](int i) {
    const int k = first + i;
    const Vec3f wo = s.wo[i], wi = onward.wi[k];
    Vec3f ns = s.ns[i];
    Vec3f dndx = s.dndu[i] * s.dudx[i] + s.dndv[i] * s.dvdx[i];
    Vec3f dndy = s.dndu[i] * s.dudy[i] + s.dndv[i] * s.dvdy[i];
    const Vec3f dwodx = -in.rx_d[k] - wo, dwody = -in.ry_d[k] - wo;
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
    const bool any_x = in.rx_d[k] != kNoDifferential, any_y = in.ry_d[k] != kNoDifferential;
    out.rx_d.set(k, any_x ? (refraction ? refract_x : mirror_x) : kNoDifferential);
    out.ry_d.set(k, any_y ? (refraction ? refract_y : mirror_y) : kNoDifferential);
  });
}

/// The points that send a ray on, in the order of their batch's rays, with the place of each ray among those that are
/// made. Two kinds of onward rays of a point follow each other.
struct Senders {
  int n = 0;
  int32_t *point = nullptr, *to = nullptr;
};

struct SenderPair {
  Senders first, second;
  int total = 0;
};

SenderPair find_senders(const Points& points, const Onward& a, const Onward& b, Arena& arena) {
  SenderPair found;
  int32_t* point_of = arena.alloc<int32_t>(points.notes->rays);
  std::fill_n(point_of, points.notes->rays, -1);
  for (int i = 0; i < points.n; ++i) point_of[points.ray[i]] = i;
  for (Senders* s : {&found.first, &found.second})
    s->point = arena.alloc<int32_t>(points.n), s->to = arena.alloc<int32_t>(points.n);
  const auto take = [&](const Onward& onward, int i, Senders& senders) {
    if (!onward || is_black(onward.weight[i])) return;
    senders.point[senders.n] = i;
    senders.to[senders.n++] = found.total++;
  };
  for (int ray = 0; ray < points.notes->rays; ++ray) {
    const int i = point_of[ray];
    if (i < 0) continue;
    take(a, i, found.first);
    take(b, i, found.second);
  }
  return found;
}

/// How a ray leaves a point: a sampled direction of a specular lobe is mirrored or refracted by its side.
Via way_of(const Points& points, const Onward& onward, int i) {
  if (onward.kind == Onward::Kind::Mirrored) return Via::Mirrored;
  if (onward.kind == Onward::Kind::Refracted) return Via::Refracted;
  if (onward.pdf[i] != std::numeric_limits<float>::infinity()) return Via::Sampled;
  const Vec3f ng = points.at.ng[i];
  return (dot(ng, points.at.wo[i]) > 0) != (dot(ng, onward.wi[i]) > 0) ? Via::Refracted : Via::Mirrored;
}

/// How the rays' samples left their first surface.
void fill_via(const Points& points, const Onward& onward, const Senders& senders, const Rays& out) {
  for (int k = 0; k < senders.n; ++k) {
    const int i = senders.point[k];
    out.via[senders.to[k]] =
        points.rays.depth == 0 ? static_cast<int32_t>(way_of(points, onward, i)) : points.rays.via[i];
  }
}

/// Hashed into a ray's branch, so that the branches of a sample draw different numbers. A path has no branches.
uint32_t branch_of(Onward::Kind kind) {
  return kind == Onward::Kind::Mirrored ? 1 : kind == Onward::Kind::Refracted ? 2 : 0;
}

void fill_rays(const Points& points, const Onward& onward, const Senders& senders, const Rays& out) {
  const int32_t *point = senders.point, *to = senders.to;
  const ShadingBatch& at = points.at;
  const Rays& in = points.rays;
  for_lanes(senders.n, [&](int k) {
    const int i = point[k], ray = to[k];
    const Vec3f wi = onward.wi[i];
    out.o.set(ray, offset_origin(at.p[i], at.p_error[i], at.ng[i], wi));
    out.d.set(ray, wi);
    out.throughput.set(ray, in.throughput[i] * onward.weight[i]);
    out.slot[ray] = in.slot[i];
  });
  const uint32_t branch = branch_of(onward.kind);
  for_lanes(senders.n, [&](int k) {
    const uint32_t stream = in.stream[point[k]];
    out.stream[to[k]] = branch == 0 ? stream : hash_combine(stream, branch);
  });
  constexpr float kSpecular = std::numeric_limits<float>::infinity();
  if (out.time) for_lanes(senders.n, [&](int k) { out.time[to[k]] = in.time[point[k]]; });
  if (out.pdf) for_lanes(senders.n, [&](int k) { out.pdf[to[k]] = onward.pdf ? onward.pdf[point[k]] : kSpecular; });
  if (out.from) for_lanes(senders.n, [&](int k) { out.from.set(to[k], at.p[point[k]]); });
  if (out.eta2) {
    for_lanes(senders.n,
              [&](int k) { out.eta2[to[k]] = in.eta2[point[k]] * (onward.eta2 ? onward.eta2[point[k]] : 1.0f); });
  }
  if (out.via) fill_via(points, onward, senders, out);
  if (!out.differentials) return;
  const RayDifferentials& from = onward.differentials;
  for_lanes(senders.n, [&](int k) {
    const int i = point[k], ray = to[k];
    out.differentials.rx_o.set(ray, from.rx_o[i]), out.differentials.rx_d.set(ray, from.rx_d[i]);
    out.differentials.ry_o.set(ray, from.ry_o[i]), out.differentials.ry_d.set(ray, from.ry_d[i]);
  });
}

/// Counts rays by what they are.
void count_sent(const Points& points, const Onward& onward, const Senders& senders, RenderStatistics& statistics) {
  if (onward.kind == Onward::Kind::Mirrored) statistics.reflection_rays += senders.n;
  if (onward.kind == Onward::Kind::Refracted) statistics.refraction_rays += senders.n;
  if (onward.kind != Onward::Kind::Sampled) return;
  for (int k = 0; k < senders.n; ++k) {
    const Via way = way_of(points, onward, senders.point[k]);
    statistics.reflection_rays += way == Via::Mirrored, statistics.refraction_rays += way == Via::Refracted;
    statistics.indirect_rays += way == Via::Sampled;
  }
}

}  // namespace

/// Directions, weights and differentials of one kind of specular rays at every point.
Onward Tracer::specular(const Points& points, LobeType type, int dimension) {
  const bool refraction = type == LobeType::SpecularTransmission;
  const auto has = [&](const MaterialRun& r) { return refraction ? r.refracts : r.mirrors; };
  Onward out;
  out.kind = refraction ? Onward::Kind::Refracted : Onward::Kind::Mirrored;
  const Effect effect = refraction ? Effect::Refraction : Effect::Reflection;
  if (!scene_.plan.live(effect) || std::none_of(points.materials.begin(), points.materials.end(), has)) return out;
  out.wi = arena_.vec3(points.n), out.weight = arena_.rgb(points.n);
  const bool differentials = kKnowsDifferentials && points.rays.differentials;
  if (differentials) out.differentials = allocate_like(points.rays.differentials, points.n, arena_);
  const auto several = [&](const MaterialRun& r) { return count_lobes(r.lobes, type) > 1; };
  const float* choice = nullptr;
  if (std::any_of(points.materials.begin(), points.materials.end(), several)) choice = draw_1d(points, dimension);
  for (const MaterialRun& run : points.materials) {
    const Vec3Lanes wi = out.wi.from(run.first);
    const RGBLanes weight = out.weight.from(run.first);
    if (!has(run)) {
      for_lanes(run.points.n, [&](int i) { weight.set(i, RGB(0.0f)); });
      continue;
    }
    const float* u = choice ? choice + run.first : nullptr;
    if (refraction) {
      specular_transmission(run.lobes, run.points, u, wi, weight);
    } else {
      specular_reflection(run.lobes, run.points, u, wi, weight);
    }
    if (differentials) specular_differentials(run, refraction, points.rays.differentials, out);
  }
  return out;
}

Onward Tracer::mirrored(const Points& points, int dimension) {
  return specular(points, LobeType::SpecularReflection, dimension);
}

Onward Tracer::refracted(const Points& points, int dimension) {
  return specular(points, LobeType::SpecularTransmission, dimension);
}

Onward Tracer::sampled(const Points& points, int dimension, LobeKinds kinds) {
  const int n = points.n;
  Onward out;
  out.kind = Onward::Kind::Sampled;
  out.wi = arena_.vec3(n), out.weight = arena_.rgb(n), out.pdf = arena_.floats(n);
  if (points.rays.eta2) out.eta2 = arena_.floats(n);
  const float* const lobe = draw_1d(points, dimension);
  const Uniform2 direction = draw_2d(points, dimension + 1);
  for (const MaterialRun& run : points.materials) {
    const int first = run.first;
    const LobeSamples samples{out.wi.from(first), out.weight.from(first), out.pdf + first,
                              out.eta2 ? out.eta2 + first : nullptr};
    sample_lobes(run.lobes, run.points, run.frame, lobe + first, direction.u + first, direction.v + first, kinds,
                 samples);
  }
  return out;
}

void Tracer::roulette(const Points& points, const Onward& onward, int dimension, float threshold) {
  const float* const u = draw_1d(points, dimension);
  const RGBLanes &weight = onward.weight, &throughput = points.rays.throughput;
  for_lanes(points.n, [&](int i) {
    const float eta2 = points.rays.eta2 ? points.rays.eta2[i] * onward.eta2[i] : 1.0f;
    const float carried =
        max_of(max_of(throughput.r[i] * weight.r[i], throughput.g[i] * weight.g[i]), throughput.b[i] * weight.b[i]) *
        eta2;
    const float q = max_of(0.05f, 1 - carried);
    const float survives = u[i] < q ? 0.0f : 1 / (1 - q);
    const float scale = carried < threshold ? survives : 1.0f;
    weight.r[i] *= scale, weight.g[i] *= scale, weight.b[i] *= scale;
  });
}

Rays Tracer::rays(const Points& points, const Onward& onward) {
  const SenderPair senders = find_senders(points, onward, {}, arena_);
  Rays like = points.rays;
  if (!onward.differentials) like.differentials = {};
  if (onward.pdf) like.pdf = onward.pdf, like.from = points.at.p;
  Rays out = allocate_like(like, senders.total, arena_);
  out.n = senders.total, out.depth = points.rays.depth + 1;
  fill_rays(points, onward, senders.first, out);
  worker_.statistics.probe_rays += senders.total;
  return out;
}

void Tracer::send(const Points& points, const Onward& onward, const Onward& also) {
  if (!onward && !also) return;
  const SenderPair senders = find_senders(points, onward, also, arena_);
  const Rays out = worker_.level(points.rays.depth + 1).append(senders.total);
  fill_rays(points, onward, senders.first, out);
  if (also) fill_rays(points, also, senders.second, out);
  count_sent(points, onward, senders.first, worker_.statistics);
  count_sent(points, also, senders.second, worker_.statistics);
}

}  // namespace whit
