// Points of one shape as textures see them where there is no batch of surfaces: for alpha, and where lights are sampled.
#pragma once

#include "core/scene/scene.h"

namespace whit {

/// Room for n points: where they are, their (u, v), and what vertices have beside, if `mesh` (which may be null) has it.
/// Without footprints. Textures take what is not there as pbrt does: no second set is the first, no colour is 1.
ShadingBatch texture_points(const Mesh* mesh, int n, Arena& arena);

/// Fills in all of point i but where it is: of a triangle, at the weights `b1` and `b2` of its second and third corner.
template <class T>
void set_triangle_point(const Mesh& mesh, uint32_t prim, T b1, T b2, const ShadingBatch& s, int i) {
  const uint32_t* const index = mesh.corners(prim);
  const T b0 = 1 - b1 - b2;
  const auto mix = [&](T a, T b, T c) { return static_cast<float>(a * b0 + b * b1 + c * b2); };
  const auto mix_of = [&](const std::vector<float>& values, size_t stride, size_t c) {
    const auto of = [&](size_t corner) { return static_cast<T>(values[stride * size_t{index[corner]} + c]); };
    return mix(of(0), of(1), of(2));
  };
  s.u[i] = mesh.uvs.empty() ? mix(0, 1, 1) : mix_of(mesh.uvs, 2, 0);
  s.v[i] = mesh.uvs.empty() ? mix(0, 0, 1) : mix_of(mesh.uvs, 2, 1);
  if (s.u1) s.u1[i] = mix_of(mesh.uvs1, 2, 0), s.v1[i] = mix_of(mesh.uvs1, 2, 1);
  if (!s.color) return;
  s.color.set(i, {mix_of(mesh.colors, 4, 0), mix_of(mesh.colors, 4, 1), mix_of(mesh.colors, 4, 2)});
  s.color_alpha[i] = mix_of(mesh.colors, 4, 3);
}

/// The same of an analytic shape, at a point of its placement's space.
inline void set_analytic_point(const AnalyticShape& shape, const Vec3d& p, const ShadingBatch& s, int i) {
  const SurfacePoint at = shape.surface(transform_point(shape.scene_to_object(), p));
  s.u[i] = static_cast<float>(at.u), s.v[i] = static_cast<float>(at.v);
}

}  // namespace whit
