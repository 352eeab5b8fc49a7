// Surface points of analytic shapes, in double precision.

#include <algorithm>

#include "core/base/fastmath.h"
#include "core/render/surface_kinds.h"

namespace whit {
namespace {

/// The computed hits of rays with one analytic shape, in its object space.
void object_hits(const Scene& scene, const SurfaceHits& h, int first, const Mat4d& to_object, SurfacePointLanes& out) {
  for_lanes(out.n, [&](int i) {
    const double t = static_cast<double>(h.t[first + i]);
    const auto at = [&](const float* o, const float* d) {
      return static_cast<double>(o[first + i]) + t * static_cast<double>(d[first + i]);
    };
    out.p.set(i, {at(h.o.x, h.d.x), at(h.o.y, h.d.y), at(h.o.z, h.d.z)});
  });
  for (int i = 0; i < out.n && scene.has_instances; ++i) {
    if (h.instance[first + i] >= 0) out.p.set(i, transform_point(render_to_local(scene, h, first + i), out.p[i]));
  }
  for_lanes(out.n, [&](int i) {
    const double x = out.p.x[i], y = out.p.y[i], z = out.p.z[i];
    out.p.set(i, {affine(to_object, 0, x, y, z), affine(to_object, 1, x, y, z), affine(to_object, 2, x, y, z)});
  });
}

/// Takes points of a shape from its object space by m to the space it is placed in.
void place_points(const Mat4d& m, const SurfacePointLanes& in, const ShadingBatch& s, const GeometricPartials& g) {
  const double mirrored = swaps_handedness(m) ? -1 : 1;
  for_lanes(in.n, [&](int i) {
    // Of the point, and of four roundings of a double on its way through m.
    constexpr double kRoundings = 4.5e-16;
    const Vec3d error =
        in.p_error[i] + Vec3d(std::abs(in.p.x[i]), std::abs(in.p.y[i]), std::abs(in.p.z[i])) * kRoundings;
    const auto coordinate = [&](int c) { return affine(m, c, in.p.x[i], in.p.y[i], in.p.z[i]); };
    const Vec3d q(coordinate(0), coordinate(1), coordinate(2));
    const Vec3f p = to_float(q);
    // The rounding to floats as it is, not a bound on it: a ray that leaves must not jump over a neighbour that is a few
    // units in the last place away. A little more than that, because errors along a curved surface leave it, too.
    const auto error_of = [&](int c, double exact, float rounded) {
      const double object = std::abs(m[0][c]) * error.x + std::abs(m[1][c]) * error.y + std::abs(m[2][c]) * error.z;
      const double rounding = std::abs(exact - static_cast<double>(rounded)) * 1.0001;
      return static_cast<float>(object + std::abs(m[3][c]) * kRoundings + rounding);
    };
    s.p.set(i, p);
    s.p_error.set(i, {error_of(0, q.x, p.x), error_of(1, q.y, p.y), error_of(2, q.z, p.z)});
    s.u[i] = static_cast<float>(in.u[i]), s.v[i] = static_cast<float>(in.v[i]);
    const Vec3d dpdu = transform_vector(m, in.dpdu[i]), dpdv = transform_vector(m, in.dpdv[i]);
    g.dpdu.set(i, to_float(dpdu)), g.dpdv.set(i, to_float(dpdv));
    s.dpdu.set(i, to_float(dpdu)), s.dpdv.set(i, to_float(dpdv));
    // pbrt flips the object's normal and then transforms it: the cross product's own change of sign goes.
    const Vec3d n = unit_vector(dpdu.cross(dpdv)) * (s.flips[i] ? -mirrored : mirrored);
    s.ng.set(i, to_float(n)), s.ns.set(i, to_float(n));
  });
}

/// The derivatives of the unit normal, carried from object space by a placement's inverse.
void place_normal_derivatives(const Mat4d& to_object, const SurfacePointLanes& in, const ShadingBatch& s) {
  const Mat4d normals = to_object.transposed();
  for_lanes(in.n, [&](int i) {
    const Vec3d n = unit_vector(in.dpdu[i].cross(in.dpdv[i]));
    const double side = s.flips[i] ? -1 : 1;
    s.dndu.set(i, to_float(transform_normal_change(normals, n, in.dndu[i]) * side));
    s.dndv.set(i, to_float(transform_normal_change(normals, n, in.dndv[i]) * side));
  });
}

}  // namespace

void analytic_surfaces(const Scene& scene, const SurfaceHits& h, int first, const ShadingBatch& s,
                       const GeometricPartials& g) {
  SurfacePointLanes points;
  for (int begin = 0, end; begin < s.n; begin = end) {
    const int index = h.shape[first + begin];
    const int limit = std::min(s.n, begin + SurfacePointLanes::kWidth);
    for (end = begin + 1; end < limit && h.shape[first + end] == index;) ++end;
    const AnalyticShape& shape = *scene.shapes[static_cast<size_t>(index)].analytic;
    points.n = end - begin;
    object_hits(scene, h, first + begin, shape.scene_to_object(), points);
    shape.surfaces(points);
    const ShadingBatch run = s.range(begin, points.n);
    place_points(shape.object_to_scene(), points, run, {g.dpdu.from(begin), g.dpdv.from(begin)});
    if (s.dndu) place_normal_derivatives(shape.scene_to_object(), points, run);
  }
}

}  // namespace whit
