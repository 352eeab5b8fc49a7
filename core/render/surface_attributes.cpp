// What the vertices of meshes have beside: a second set of texture coordinates, colours.
#include "core/batch/runs.h"
#include "core/render/surface_kinds.h"

namespace whit {
namespace {

/// As triangle_geometry() and exact_geometry() interpolate: the weights of corners.
template <class T>
float mix(const T (&b)[3], float x, float y, float z) {
  return static_cast<float>(b[0] * static_cast<T>(x) + b[1] * static_cast<T>(y) + b[2] * static_cast<T>(z));
}

/// The changes of (u1, v1) with u and with v: (u, v) change along the partial derivatives, which span the triangle's
/// plane, and (u1, v1) linearly over it.
void second_derivatives(const Mesh& mesh, uint32_t prim, const ShadingBatch& s, int i, const GeometricPartials& g) {
  const uint32_t* const index = mesh.corners(prim);
  const auto uv_of = [&](size_t k) {
    return Vec2f(mesh.uvs1[2 * size_t{index[k]}], mesh.uvs1[2 * size_t{index[k]} + 1]);
  };
  const Vec2f uv[] = {uv_of(0), uv_of(1), uv_of(2)};
  const Vec3d a = mesh.corner(prim, 0), e1 = mesh.corner(prim, 1) - a, e2 = mesh.corner(prim, 2) - a;
  const Vec3d n = e1.cross(e2);
  const double length2 = n.dot(n), inverse = length2 > 0 ? 1 / length2 : 0;
  const auto along = [&](const Vec3f& tangent, float& du1, float& dv1) {
    const Vec3d t(tangent);
    const double x = t.cross(e2).dot(n) * inverse, y = e1.cross(t).dot(n) * inverse;
    const auto change = [&](float at_a, float at_b, float at_c) {
      return static_cast<float>(x * (static_cast<double>(at_b) - static_cast<double>(at_a)) +
                                y * (static_cast<double>(at_c) - static_cast<double>(at_a)));
    };
    du1 = change(uv[0].x, uv[1].x, uv[2].x), dv1 = change(uv[0].y, uv[1].y, uv[2].y);
  };
  along(g.dpdu[i], s.du1du[i], s.dv1du[i]);
  along(g.dpdv[i], s.du1dv[i], s.dv1dv[i]);
}

/// What the mesh has of a point, at the weights of its triangle's corners.
template <class T>
void point_attributes(const Mesh& mesh, uint32_t prim, const T (&b)[3], const ShadingBatch& s, int i) {
  const uint32_t* const index = mesh.corners(prim);
  const auto mix_of = [&](const std::vector<float>& values, size_t stride, size_t c) {
    const auto of = [&](size_t corner) { return values[stride * size_t{index[corner]} + c]; };
    return mix(b, of(0), of(1), of(2));
  };
  if (s.u1 && !mesh.uvs1.empty()) s.u1[i] = mix_of(mesh.uvs1, 2, 0), s.v1[i] = mix_of(mesh.uvs1, 2, 1);
  if (!s.color || mesh.colors.empty()) return;
  s.color.set(i, {mix_of(mesh.colors, 4, 0), mix_of(mesh.colors, 4, 1), mix_of(mesh.colors, 4, 2)});
  s.color_alpha[i] = mix_of(mesh.colors, 4, 3);
}

void no_second_uvs(const ShadingBatch& s) {
  for_lanes(s.n, [&](int i) { s.u1[i] = s.u[i], s.v1[i] = s.v[i]; });
  if (!s.du1du) return;
  for_lanes(s.n, [&](int i) { s.du1du[i] = 1, s.dv1du[i] = 0, s.du1dv[i] = 0, s.dv1dv[i] = 1; });
}

void no_colors(const ShadingBatch& s) {
  for_lanes(s.n, [&](int i) { s.color.set(i, RGB(1.0f)), s.color_alpha[i] = 1; });
}

}  // namespace

void no_attributes(const ShadingBatch& s) {
  if (s.u1) no_second_uvs(s);
  if (s.color) no_colors(s);
}

void mesh_attributes(const Scene& scene, const SurfaceHits& h, int first, const ShadingBatch& s,
                     const GeometricPartials& g, const float* bary_u, const float* bary_v) {
  const auto mesh_run = [&](const Mesh& mesh, int from, int to) {
    const ShadingBatch run = s.range(from, to - from);
    const bool second = s.u1 && !mesh.uvs1.empty(), coloured = s.color && !mesh.colors.empty();
    if (s.u1 && !second) no_second_uvs(run);
    if (s.color && !coloured) no_colors(run);
    for (int i = from; i < to && (second || coloured); ++i) {
      const uint32_t prim = h.prim[first + i];
      if (mesh.exact.empty()) {
        const float b1 = bary_u[i], b2 = bary_v[i], b[] = {1 - b1 - b2, b1, b2};
        point_attributes(mesh, prim, b, s, i);
      } else {
        // Weights as floats are off by more than what is seen of a huge triangle.
        const Vec2d at = weights_at(mesh.exact[prim], Vec3d(s.p[i]));
        const double b[] = {1 - at.x - at.y, at.x, at.y};
        point_attributes(mesh, prim, b, s, i);
      }
      if (second && s.du1du) second_derivatives(mesh, prim, s, i, g);
    }
  };
  for_runs(
      0, s.n, [&](int i) { return h.shape[first + i]; },
      [&](int from, int to) { mesh_run(*scene.shapes[static_cast<size_t>(h.shape[first + from])].mesh, from, to); });
}

}  // namespace whit
