#include "core/render/round_log.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/lobe/table.h"

namespace whit {
namespace {

/// Adding 0 turns -0 into 0.
std::string text_of(const Vec3d& v) { return fmt::format("({:.9g}, {:.9g}, {:.9g})", v.x + 0, v.y + 0, v.z + 0); }
std::string text_of(const Vec3f& v) { return text_of(Vec3d(v)); }
std::string text_of(const RGB& c) { return fmt::format("[{:.6g} {:.6g} {:.6g}]", c.x, c.y, c.z); }

}  // namespace

Vec3d RoundLog::to_world(const Vec3f& p) const { return transform_point(scene_.space.to_world(), Vec3d(p)); }

/// Rays are numbered within their round, points by the rays that found them.
std::string RoundLog::point_name(const Round& r, int point) const {
  return fmt::format("depth {} ray {}", r.depth_, r.first_ + r.ray_of_[point]);
}

void RoundLog::rays(const Round& r) {
  for (int ray = 0; ray < r.count_; ++ray) {
    line(fmt::format("depth {} ray {}: from {} along {}, throughput {}", r.depth_, r.first_ + ray,
                     text_of(to_world(r.ray_o_[ray])), text_of(r.ray_d_[ray]),
                     text_of(r.rays_.throughput[r.first_ + ray])));
    line(r.ray_hits_.shape[ray] < 0 ? "  meets nothing" : hit(r, ray));
  }
}

std::string RoundLog::hit(const Round& r, int ray) const {
  const HitLanes& h = r.ray_hits_;
  const SceneShape& shape = scene_.shapes[static_cast<size_t>(h.shape[ray])];
  std::string what = fmt::format("  meets the shape of {}", place_(shape.where));
  if (shape.mesh) what += fmt::format(", triangle {}", h.prim[ray]);
  if (shape.curves) what += fmt::format(", segment {}", h.prim[ray]);
  if (h.instance[ray] >= 0) what += fmt::format(", instance {}", h.instance[ray]);
  return what + fmt::format(" at distance {:.9g}", static_cast<double>(h.t[ray]) / scene_.space.scale);
}

void RoundLog::surfaces(const Round& r) {
  const ShadingBatch& s = r.points_;
  for (int i = 0; i < r.hits_.n; ++i) {
    const Vec3d error = Vec3d(s.p_error[i]) / scene_.space.scale;
    line(fmt::format("  {}: point {} within {}", point_name(r, i), text_of(to_world(s.p[i])), text_of(error)));
    line(fmt::format("    normal {}, shading normal {}, uv ({:.6g}, {:.6g})", text_of(s.ng[i]), text_of(s.ns[i]),
                     s.u[i], s.v[i]));
    lobes(r, i);
  }
}

void RoundLog::lobes(const Round& r, int point) {
  for (const MaterialRun& run : r.runs_) {
    if (point < run.first || point >= run.first + run.points.n) continue;
    std::string names;
    for (int l = 0; l < run.lobes.count; ++l) {
      names += fmt::format("{}{}", l > 0 ? ", " : "", row_of(run.lobes.lobes[l].type).name);
    }
    const int material = scene_.shapes[static_cast<size_t>(r.hits_.shape[point])].material;
    const Bound<Material>& bound = scene_.bound.materials[static_cast<size_t>(material)];
    const bool given = bound.where.offset != 0 || bound.where.file != 0;
    line(fmt::format("    material {}: {}", given ? "of " + place_(bound.where) : "by default",
                     names.empty() ? "no lobes" : names));
  }
}

void RoundLog::escaped(const Round& r, int ray, const RGB& radiance) {
  line(fmt::format("  depth {} ray {} leaves, the sky gives {}", r.depth_, r.first_ + ray, text_of(radiance)));
}

void RoundLog::emitted(const Round& r, int point, const RGB& radiance) {
  line(fmt::format("  {} sees an emitter of {}", point_name(r, point), text_of(radiance)));
}

void RoundLog::light(const Round& r, const SceneLight& light, const LightSamples& samples,
                     const RGBLanes& contribution) {
  const auto number = &light - scene_.lights.data();
  for (int i = 0; i < r.hits_.n; ++i) {
    line(fmt::format("  {} light {}: along {}, distance {:.9g}, radiance over pdf {}, reflected {}", point_name(r, i),
                     number, text_of(samples.wi[i]), static_cast<double>(samples.distance[i]) / scene_.space.scale,
                     text_of(samples.radiance[i]), text_of(contribution[i])));
  }
}

void RoundLog::shadow(const Round& r, int point, bool blocked) {
  line(fmt::format("    {}: shadow ray {}", point_name(r, point), blocked ? "blocked" : "free"));
}

void RoundLog::spawned(const Round& r, int point, bool reflected, const Vec3f& wi, const RGB& weight) {
  line(fmt::format("  {} sends a {} ray along {}, weight {}", point_name(r, point),
                   reflected ? "mirrored" : "refracted", text_of(wi), text_of(weight)));
}

}  // namespace whit
