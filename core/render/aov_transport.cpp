#include "core/render/aov_transport.h"

namespace whit {
namespace {

/// Light that a camera ray sees is emission. What a sampled direction meets right behind the first surface is direct
/// light, the same as that of samples of lights: the two share it by their densities. Mirrors and smooth boundaries
/// have no such share.
LightPart part_of(const Rays& rays, int ray, bool seen) {
  if (rays.depth == 0) return seen ? LightPart::Emission : LightPart::Direct;
  switch (static_cast<Via>(rays.via[ray])) {
    case Via::Mirrored: return LightPart::Reflection;
    case Via::Refracted: return LightPart::Refraction;
    case Via::Camera:
    case Via::Sampled: break;
  }
  return seen && rays.depth == 1 ? LightPart::Direct : LightPart::Indirect;
}

void add_to(SampleValues columns, int first, int slot, const RGB& light) {
  for (int c = 0; c < 3; ++c) columns[first + c][slot] += light[c];
}

}  // namespace

Points AovTransport::surfaces(const Rays& rays, const Hits& hits, Which which) {
  if (rays.depth > 0 || !plan_.surfaces) return inner_.surfaces(rays, hits, which);
  if (which == Which::All) {
    const Points points = inner_.surfaces(rays, hits, which);
    note_surfaces(points);
    return points;
  }
  // The integrator looks at emitters alone; the AOVs do not.
  Points all = inner_.surfaces(rays, hits, Which::All);
  inner_.shade(all);
  note_surfaces(all);
  return inner_.surfaces(rays, hits, which);
}

void AovTransport::shade(Points& points) {
  inner_.shade(points);
  if (points.rays.depth == 0 && plan_.surfaces) note_surfaces(points);
}

void AovTransport::note_surfaces(const Points& points) {
  const FirstSurfaces at{scene_, points};
  for (const AovLayer& layer : plan_.layers) {
    if (layer.row->surface) layer.row->surface(at, chunk_.aovs + layer.column);
  }
  for (int i = 0; i < points.n; ++i) chunk_.met[points.rays.slot[i]] = 1;
}

void AovTransport::add_part(const Rays& rays, int ray, const RGB& light, bool seen) {
  if (!plan_.parts) return;
  const int column = plan_.column_of_part[static_cast<size_t>(part_of(rays, ray, seen))];
  if (column >= 0) add_to(chunk_.aovs, column, rays.slot[ray], rays.throughput[ray] * light);
}

void AovTransport::add_to_group(int group, const Rays& rays, int ray, const RGB& light) {
  if (group < 0) return;
  add_to(chunk_.aovs, plan_.first_group + 3 * group, rays.slot[ray], rays.throughput[ray] * light);
}

void AovTransport::add(const Rays& rays, const Seen& seen) {
  inner_.add(rays, seen);
  for (int k = 0; k < seen.n; ++k) add_part(rays, seen.lane[k], seen.radiance[k], true);
  if (!seen.environments) return;
  for (size_t e = 0; e < plan_.group_of_environment.size(); ++e) {
    for (int k = 0; k < seen.n; ++k)
      add_to_group(plan_.group_of_environment[e], rays, seen.lane[k], seen.environments[e][k]);
  }
}

void AovTransport::add(const Points& points, const Seen& seen) {
  inner_.add(points, seen);
  for (int k = 0; k < seen.n; ++k) {
    const int i = seen.lane[k];
    add_part(points.rays, i, seen.radiance[k], true);
    if (plan_.light_groups.empty()) continue;
    const int group = plan_.group_of_shape[static_cast<size_t>(points.hits.shape[i])];
    add_to_group(group, points.rays, i, seen.radiance[k]);
  }
}

void AovTransport::add(const Points& points, const DirectSamples& samples, const RGBLanes& light) {
  inner_.add(points, samples, light);
  for (int i = 0; i < points.n; ++i) {
    add_part(points.rays, i, light[i], false);
    const int number = samples.lights ? samples.lights[i] : samples.light;
    if (plan_.light_groups.empty() || number < 0) continue;
    add_to_group(plan_.group_of_light[static_cast<size_t>(number)], points.rays, i, light[i]);
  }
}

}  // namespace whit
