// The kinds of geometry that surfaces are made of, each in a file of its own; and what these share.
#pragma once

#include <cmath>

#include "core/batch/arena.h"
#include "core/batch/shading.h"
#include "core/render/surface.h"
#include "core/scene/motion.h"

namespace whit {

/// gamma(n) = n eps / (1 - n eps): the bound on n accumulated rounding errors (PBR 3e, section 3.9.1).
constexpr float gamma_bound(int n) {
  constexpr float kHalfUlp = 0x1p-24f;
  return static_cast<float>(n) * kHalfUlp / (1 - static_cast<float>(n) * kHalfUlp);
}

/// Geometric partial derivatives, which footprints need beside the shading ones.
struct GeometricPartials {
  Vec3Lanes dpdu, dpdv;
};

/// Points, normals and derivatives of the hits from `first` on, s.n of them, that all lie on meshes. Here and below in the
/// space of the shapes' group.
void mesh_surfaces(const Scene& scene, const SurfaceHits& hits, int first, const ShadingBatch& s,
                   const GeometricPartials& g, Arena& arena);
/// What vertices have beside, of the same hits, where somebody asks for it; `bary_u` and `bary_v` are where the points are
/// in their triangles. After their partial derivatives.
void mesh_attributes(const Scene& scene, const SurfaceHits& hits, int first, const ShadingBatch& s,
                     const GeometricPartials& g, const float* bary_u, const float* bary_v);
/// The same of points on shapes that have nothing beside.
void no_attributes(const ShadingBatch& s);

/// The same of analytic shapes,
void analytic_surfaces(const Scene& scene, const SurfaceHits& hits, int first, const ShadingBatch& s,
                       const GeometricPartials& g);
/// and of curves.
void curve_surfaces(const Scene& scene, const SurfaceHits& hits, int first, const ShadingBatch& s,
                    const GeometricPartials& g);

inline Vec3f to_float(const Vec3d& v) {
  return Vec3f(static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z));
}

/// m applied to a point, one coordinate; m is affine, so that nothing is divided, unlike by transform_point().
[[gnu::always_inline]] inline double affine(const Mat4d& m, int c, double x, double y, double z) {
  return x * m[0][c] + y * m[1][c] + z * m[2][c] + m[3][c];
}

[[gnu::always_inline]] inline Vec3d unit_vector(const Vec3d& v) { return v * (1 / std::sqrt(v.dot(v))); }

/// The change of a unit normal n by `dn`, as a transform's normal matrix carries it along: the change of the unit normal
/// there, whatever the matrix's scale.
[[gnu::always_inline]] inline Vec3d transform_normal_change(const Mat4d& normal_matrix, const Vec3d& n,
                                                            const Vec3d& dn) {
  const Vec3d m = transform_vector(normal_matrix, n), d = transform_vector(normal_matrix, dn);
  const double length2 = m.dot(m);
  return (d - m * (m.dot(d) / length2)) * (1 / std::sqrt(length2));
}

/// The group's local space of a hit: render space itself for world geometry.
inline Mat4d render_to_local(const Scene& scene, const SurfaceHits& h, int i) {
  if (h.instance[i] < 0) return Mat4d();
  const SceneInstance& instance = scene.instances[static_cast<size_t>(h.instance[i])];
  return interpolate_keys(scene.keys_of(instance), h.time_of(i)).inverse();
}

/// The unit normal of derivatives that m has transformed. pbrt flips the object's normal and then transforms it, so the
/// cross product's own change of sign under a mirroring goes.
inline Vec3d oriented_normal(const Vec3d& dpdu, const Vec3d& dpdv, const Mat4d& m, bool flips) {
  return dpdu.cross(dpdv).normalized() * (flips != swaps_handedness(m) ? -1.0 : 1.0);
}

/// The error that makes rays leave at `distance` along the unit normal n, to either side, whichever way n points.
inline Vec3f error_along(const Vec3d& n, double distance) {
  return to_float(Vec3d(std::abs(n.x), std::abs(n.y), std::abs(n.z)) * distance);
}

}  // namespace whit
