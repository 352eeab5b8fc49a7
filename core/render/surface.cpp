#include "core/render/surface.h"

#include "core/base/fastmath.h"
#include "core/batch/fields.h"
#include "core/batch/runs.h"
#include "core/render/surface_kinds.h"
#include "core/scene/bake.h"

namespace whit {
namespace {

/// Takes the points of placed objects from their group's space to render space.
void place_surfaces(const Scene& scene, const SurfaceHits& h, const ShadingBatch& s, const GeometricPartials& g) {
  for (int i = 0; i < s.n; ++i) {
    if (h.instance[i] < 0) continue;
    const SceneInstance& instance = scene.instances[static_cast<size_t>(h.instance[i])];
    const Mat4d m = interpolate_keys(scene.keys_of(instance), h.time_of(i)), nm = normal_matrix(m);
    const Vec3f local = s.p[i], known = s.p_error[i];
    // Embree meets the object with rays that it takes there in floats, however well the point itself is known.
    const auto reached = [](float error, float at) { return max_of(error, gamma_bound(3) * std::abs(at)); };
    const Vec3f error(reached(known.x, local.x), reached(known.y, local.y), reached(known.z, local.z));
    const Vec3d p = transform_point(m, Vec3d(local));
    const auto error_of = [&](int c) {
      // The float matrix Embree used differs from ours by half a unit in the last place of each entry.
      const double spread = std::abs(m[0][c]) * error.x + std::abs(m[1][c]) * error.y + std::abs(m[2][c]) * error.z;
      const double rounding =
          std::abs(m[0][c] * local.x) + std::abs(m[1][c] * local.y) + std::abs(m[2][c] * local.z) + std::abs(m[3][c]);
      return static_cast<float>(spread) + gamma_bound(4) * static_cast<float>(rounding);
    };
    s.p.set(i, to_float(p));
    const Vec3d local_ng(s.ng[i]), ng = transform_vector(nm, local_ng).normalized();
    if (scene.shapes[static_cast<size_t>(h.shape[i])].curves) {
      // A width, not a rounding error, and along the normal: see curve_surfaces().
      const double outside =
          std::abs(local_ng.x) * error.x + std::abs(local_ng.y) * error.y + std::abs(local_ng.z) * error.z;
      s.p_error.set(i, error_along(ng, outside * std::abs(transform_vector(m, local_ng).dot(ng))));
    } else {
      s.p_error.set(i, {error_of(0), error_of(1), error_of(2)});
    }
    for (const Vec3Lanes* v : {&s.dpdu, &s.dpdv, &g.dpdu, &g.dpdv})
      v->set(i, to_float(transform_vector(m, Vec3d((*v)[i]))));
    // The normal keeps the side it has on the object (pbrt does not flip for the instance's own handedness).
    const Vec3d local_ns(s.ns[i]), ns = transform_vector(nm, local_ns).normalized();
    // Which side the shading normal is on is for this space to say: where an object is flat as a needle, the sign of a
    // product of normals is not the same in both.
    s.ns.set(i, to_float(ns));
    s.ng.set(i, to_float(ns.dot(ng) < 0 ? -ng : ng));
    if (s.dndu) {
      for (const Vec3Lanes* v : {&s.dndu, &s.dndv})
        v->set(i, to_float(transform_normal_change(nm, local_ns, Vec3d((*v)[i]))));
    }
  }
}

/// The axis pair that a tangent plane projects onto best, and the 2x2 solve for a derivative of (u, v).
void solve_uv(const Vec3f& n, const Vec3f& dpdu, const Vec3f& dpdv, const Vec3f& dp, float& du, float& dv) {
  const float ax = std::abs(n.x), ay = std::abs(n.y), az = std::abs(n.z);
  const bool drop_x = ax > ay && ax > az, drop_y = !drop_x && ay > az;
  const auto first = [&](const Vec3f& v) { return drop_x ? v.y : v.x; };
  const auto second = [&](const Vec3f& v) { return drop_x || drop_y ? v.z : v.y; };
  const float a = first(dpdu), b = first(dpdv), c = second(dpdu), d = second(dpdv);
  const float det = a * d - b * c;
  const float inverse = det != 0 ? 1 / det : 0.0f;
  const float u = (d * first(dp) - b * second(dp)) * inverse, v = (a * second(dp) - c * first(dp)) * inverse;
  du = std::abs(u) < 1e30f ? u : 0.0f;
  dv = std::abs(v) < 1e30f ? v : 0.0f;
}

/// Footprints: where the differential rays meet the tangent plane (PBR 3e, section 10.1.1).
void compute_footprints(const SurfaceHits& h, const ShadingBatch& s, const GeometricPartials& g) {
  for_lanes(s.n, [&](int i) {
    const Vec3f n = s.ng[i], p = s.p[i];
    const auto meet = [&](const Vec3f& o, const Vec3f& d) {
      const float along = dot(n, d);
      const float t = along != 0 ? dot(n, p - o) / along : 0.0f;
      return o + d * t - p;
    };
    Vec3f dpdx = meet(h.differentials.rx_o[i], h.differentials.rx_d[i]),
          dpdy = meet(h.differentials.ry_o[i], h.differentials.ry_d[i]);
    const bool good = std::abs(dot(n, h.differentials.rx_d[i])) > 0 && std::abs(dot(n, h.differentials.ry_d[i])) > 0;
    const float keep = good ? 1.0f : 0.0f;
    dpdx = dpdx * keep, dpdy = dpdy * keep;
    s.dpdx.set(i, dpdx), s.dpdy.set(i, dpdy);
    solve_uv(n, g.dpdu[i], g.dpdv[i], dpdx, s.dudx[i], s.dvdx[i]);
    solve_uv(n, g.dpdu[i], g.dpdv[i], dpdy, s.dudy[i], s.dvdy[i]);
  });
}

/// The footprints of the second set of texture coordinates, from those of the first.
void second_footprints(const ShadingBatch& s) {
  for_lanes(s.n, [&](int i) {
    s.du1dx[i] = s.du1du[i] * s.dudx[i] + s.du1dv[i] * s.dvdx[i];
    s.dv1dx[i] = s.dv1du[i] * s.dudx[i] + s.dv1dv[i] * s.dvdx[i];
    s.du1dy[i] = s.du1du[i] * s.dudy[i] + s.du1dv[i] * s.dvdy[i];
    s.dv1dy[i] = s.dv1du[i] * s.dudy[i] + s.dv1dv[i] * s.dvdy[i];
  });
}

ShadingBatch allocate(const SurfaceHits& h, bool bumps, const MeshAttributes& attributes, Arena& arena) {
  ShadingBatch s = with_all_fields<ShadingBatch>();
  const bool footprints = h.has_differentials();
  if (!bumps && !footprints) s.dndu = s.dndv = {};
  if (!footprints) s.dudx = s.dvdx = s.dudy = s.dvdy = nullptr, s.dpdx = s.dpdy = {};
  if (!attributes.uvs1) s.u1 = s.v1 = nullptr;
  if (!attributes.uvs1 || (!bumps && !footprints)) s.du1du = s.dv1du = s.du1dv = s.dv1dv = nullptr;
  if (!attributes.uvs1 || !footprints) s.du1dx = s.dv1dx = s.du1dy = s.dv1dy = nullptr;
  if (!attributes.colors) s.color = {}, s.color_alpha = nullptr;
  s = allocate_like(s, h.n, arena);
  s.n = h.n;
  s.arena = &arena;
  return s;
}

}  // namespace

ShadingBatch compute_surfaces(const Scene& scene, const SurfaceHits& h, Arena& arena) {
  const ShadingBatch s = allocate(h, scene.plan.live(Effect::Bump), scene.attributes, arena);
  // Footprints need those of the geometry, instances turn what there is, and so do normal maps, which also ask where the
  // texture coordinates go: else there is no telling them apart.
  const bool apart = h.has_differentials() || scene.has_instances || scene.plan.live(Effect::Bump);
  const GeometricPartials g =
      apart ? GeometricPartials{arena.vec3(h.n), arena.vec3(h.n)} : GeometricPartials{s.dpdu, s.dpdv};
  const auto shape_of = [&](int i) -> const SceneShape& { return scene.shapes[static_cast<size_t>(h.shape[i])]; };
  for (int i = 0; i < h.n; ++i) s.flips[i] = shape_of(i).flips;
  for_lanes(h.n, [&](int i) { s.wo.set(i, -h.d[i]); });
  for_runs(
      0, h.n, [&](int i) { return shape_of(i).sort_key; },
      [&](int first, int last) {
        const SceneShape& shape = shape_of(first);
        const ShadingBatch run = s.range(first, last - first);
        const GeometricPartials partials{g.dpdu.from(first), g.dpdv.from(first)};
        if (shape.mesh) {
          mesh_surfaces(scene, h, first, run, partials, arena);
        } else if (shape.analytic) {
          analytic_surfaces(scene, h, first, run, partials);
          no_attributes(run);
        } else {
          curve_surfaces(scene, h, first, run, partials);
          no_attributes(run);
        }
      });
  if (scene.has_instances) place_surfaces(scene, h, s, g);
  if (h.has_differentials()) compute_footprints(h, s, g);
  if (s.du1dx) second_footprints(s);
  return s;
}

}  // namespace whit
