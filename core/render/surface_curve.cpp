// Surface points of curves.

#include <algorithm>

#include "core/base/fastmath.h"
#include "core/render/surface_kinds.h"

namespace whit {
namespace {

/// Derivative of a cubic Bezier segment by its parameter in [0,1], full width and a ribbon's normal.
struct CurvePoint {
  Vec3d tangent, normal;
  double width;
};

CurvePoint evaluate_curve(const Curves& curves, uint32_t segment, double w) {
  const float* c = &curves.control_points[16 * static_cast<size_t>(segment)];
  const double a = 1 - w;
  const double slope[3] = {3 * a * a, 6 * a * w, 3 * w * w};
  CurvePoint out{{0, 0, 0}, {0, 0, 0}, 2 * (a * static_cast<double>(c[3]) + w * static_cast<double>(c[15]))};
  for (int k = 0; k < 3; ++k) {
    out.tangent += slope[k] * Vec3d(c[4 * k + 4] - c[4 * k], c[4 * k + 5] - c[4 * k + 1], c[4 * k + 6] - c[4 * k + 2]);
  }
  // Where control points coincide the derivative may vanish: the chord stands for it, as in pbrt.
  if (!(out.tangent.length2() > 0)) out.tangent = Vec3d(c[12] - c[0], c[13] - c[1], c[14] - c[2]);
  if (!curves.normals.empty()) out.normal = ribbon_normal(&curves.normals[12 * static_cast<size_t>(segment)], w);
  return out;
}

/// v rotated about a unit axis by an angle in radians (Rodrigues).
Vec3d rotate_about(const Vec3d& v, const Vec3d& axis, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return v * c + axis.cross(v) * s + axis * (axis.dot(v) * (1 - c));
}

/// The partial derivative across a curve, in its own space: as long as the curve is wide for the ray d (unit).
Vec3d across_curve(CurveData::Kind kind, const CurvePoint& c, const Vec3d& d, double v) {
  const bool ribbon = kind == CurveData::Kind::Ribbon;
  const double width = ribbon ? c.width * std::abs(c.normal.dot(d)) : c.width;
  Vec3d side = (ribbon ? c.normal : d).cross(c.tangent);
  // A curve seen along itself has no side of its own.
  if (!(side.length2() > 0)) side = c.tangent.cross(std::abs(d.x) < 0.6 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0));
  side = side.normalized() * width;
  return kind == CurveData::Kind::Cylinder ? rotate_about(side, c.tangent.normalized(), -(v - 0.5) * M_PI) : side;
}

}  // namespace

void curve_surfaces(const Scene& scene, const SurfaceHits& h, int first, const ShadingBatch& s,
                    const GeometricPartials& g) {
  for (int i = 0; i < s.n; ++i) {
    const int lane = first + i;
    const Curves& curves = *scene.shapes[static_cast<size_t>(h.shape[lane])].curves;
    const Mat4d to_local = render_to_local(scene, h, lane);
    const Mat4d& m = curves.to_group;
    const Vec3d o = transform_point(to_local, Vec3d(h.o[lane])), d = transform_vector(to_local, Vec3d(h.d[lane]));
    const CurvePoint c = evaluate_curve(curves, h.prim[lane], h.u[lane]);
    const float* range = &curves.u_range[2 * static_cast<size_t>(h.prim[lane])];
    s.u[i] = range[0] + h.u[lane] * (range[1] - range[0]), s.v[i] = h.v[lane];
    const Vec3d own_dpdu = c.tangent / std::max(1e-30, static_cast<double>(range[1] - range[0]));
    const Vec3d own_dpdv = across_curve(curves.kind, c, transform_vector(curves.from_group, d).normalized(), h.v[lane]);
    const Vec3d dpdu = transform_vector(m, own_dpdu), dpdv = transform_vector(m, own_dpdv);
    s.p.set(i, to_float(o + static_cast<double>(h.t[lane]) * d));
    g.dpdu.set(i, to_float(dpdu)), g.dpdv.set(i, to_float(dpdv));
    s.dpdu.set(i, to_float(dpdu)), s.dpdv.set(i, to_float(dpdv));
    const Vec3d n = oriented_normal(dpdu, dpdv, m, s.flips[i] != 0);
    s.ng.set(i, to_float(n)), s.ns.set(i, to_float(n));
    // A curve stands for a tube: rays leave from outside of it. pbrt's bound is a box in the curve's own space, twice
    // the width to each side; it is turned with the curve.
    const Vec3d box = transform_vector(m.transposed(), n);
    s.p_error.set(i, error_along(n, 2 * own_dpdv.length() * (std::abs(box.x) + std::abs(box.y) + std::abs(box.z))));
    if (s.dndu) s.dndu.set(i, {0, 0, 0}), s.dndv.set(i, {0, 0, 0});
  }
}

}  // namespace whit
