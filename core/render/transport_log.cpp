#include "core/render/transport_log.h"

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

Vec3d TransportLog::to_world(const Vec3f& p) const { return transform_point(scene_.space.to_world(), Vec3d(p)); }

namespace {

/// Rays are numbered within their batch, points by the rays that found them.
std::string ray_name(int depth, int ray) { return fmt::format("depth {} ray {}", depth, ray); }
std::string point_name(const Points& p, int point) { return ray_name(p.rays.depth, p.ray[point]); }

}  // namespace

Hits TransportLog::intersect(Rays& rays) {
  const Hits hits = inner_.intersect(rays);
  for (int ray = 0; ray < rays.n; ++ray) {
    line(fmt::format("{}: from {} along {}, throughput {}", ray_name(rays.depth, ray), text_of(to_world(rays.o[ray])),
                     text_of(rays.d[ray]), text_of(rays.throughput[ray])));
    line(hits.shape[ray] < 0 ? "  meets nothing" : hit(hits, ray));
  }
  return hits;
}

std::string TransportLog::hit(const Hits& h, int ray) const {
  const SceneShape& shape = scene_.shapes[static_cast<size_t>(h.shape[ray])];
  std::string what = fmt::format("  meets the shape of {}", place_(shape.where));
  if (shape.mesh) what += fmt::format(", triangle {}", h.prim[ray]);
  if (shape.curves) what += fmt::format(", segment {}", h.prim[ray]);
  if (h.instance[ray] >= 0) what += fmt::format(", instance {}", h.instance[ray]);
  return what + fmt::format(" at distance {:.9g}", static_cast<double>(h.t[ray]) / scene_.space.scale);
}

void TransportLog::shade(Points& points) {
  inner_.shade(points);
  for (int i = 0; i < points.n; ++i) surface(points, i);
}

void TransportLog::surface(const Points& points, int i) {
  const ShadingBatch& s = points.at;
  const Vec3d error = Vec3d(s.p_error[i]) / scene_.space.scale;
  line(fmt::format("  {}: point {} within {}", point_name(points, i), text_of(to_world(s.p[i])), text_of(error)));
  line(fmt::format("    normal {}, shading normal {}, uv ({:.6g}, {:.6g})", text_of(s.ng[i]), text_of(s.ns[i]), s.u[i],
                   s.v[i]));
  lobes(points, i);
}

void TransportLog::lobes(const Points& points, int point) {
  for (const MaterialRun& run : points.materials) {
    if (point < run.first || point >= run.first + run.points.n) continue;
    std::string names;
    for (int l = 0; l < run.lobes.count; ++l) {
      names += fmt::format("{}{}", l > 0 ? ", " : "", row_of(run.lobes.lobes[l].type).name);
    }
    const int material = scene_.shapes[static_cast<size_t>(points.hits.shape[point])].material;
    const Bound<Material>& bound = scene_.bound.materials[static_cast<size_t>(material)];
    const bool given = bound.where.offset != 0 || bound.where.file != 0;
    line(fmt::format("    material {}: {}", given ? "of " + place_(bound.where) : "by default",
                     names.empty() ? "no lobes" : names));
  }
}

Seen TransportLog::escaped(const Rays& rays, const Hits& hits, Heuristic h) {
  const Seen seen = inner_.escaped(rays, hits, h);
  for (int i = 0; i < seen.n; ++i) {
    line(fmt::format("  {} leaves, the sky gives {}", ray_name(rays.depth, seen.lane[i]), text_of(seen.radiance[i])));
  }
  return seen;
}

Seen TransportLog::emitted(const Points& points, Heuristic h) {
  const Seen seen = inner_.emitted(points, h);
  for (int i = 0; i < seen.n; ++i) {
    if (is_black(seen.radiance[i])) continue;
    line(fmt::format("  {} sees an emitter of {}", point_name(points, seen.lane[i]), text_of(seen.radiance[i])));
  }
  return seen;
}

RGBLanes TransportLog::visible(const Points& points, const DirectSamples& samples, const RGBLanes& light) {
  std::vector<RGB> sent;
  for (int i = 0; i < points.n; ++i) sent.push_back(light[i]);
  const RGBLanes seen = inner_.visible(points, samples, light);
  for (int i = 0; i < points.n; ++i) {
    const int number = samples.lights ? samples.lights[i] : samples.light;
    const std::string what = number >= 0 ? fmt::format("light {}", number) : "no light";
    const RGB radiance = samples.radiance ? samples.radiance[i] : RGB(1.0f);
    line(fmt::format("  {} {}: along {}, distance {:.9g}, radiance over pdf {}, reflected {}", point_name(points, i),
                     what, text_of(samples.wi[i]), static_cast<double>(samples.distance[i]) / scene_.space.scale,
                     text_of(radiance), text_of(sent[static_cast<size_t>(i)])));
    if (is_black(sent[static_cast<size_t>(i)])) continue;
    const bool blocked = is_black(seen[i]);
    line(fmt::format("    {}: shadow ray {}", point_name(points, i), blocked ? "blocked" : "free"));
  }
  return seen;
}

void TransportLog::send(const Points& points, const Onward& onward, const Onward& also) {
  inner_.send(points, onward, also);
  for (int i = 0; i < points.n; ++i) sent(points, onward, i), sent(points, also, i);
}

void TransportLog::sent(const Points& points, const Onward& onward, int i) {
  if (!onward || is_black(onward.weight[i])) return;
  const char* const how = onward.kind == Onward::Kind::Mirrored    ? "mirrored"
                          : onward.kind == Onward::Kind::Refracted ? "refracted"
                                                                   : "sampled";
  line(fmt::format("  {} sends a {} ray along {}, weight {}", point_name(points, i), how, text_of(onward.wi[i]),
                   text_of(onward.weight[i])));
}

}  // namespace whit
