// Surface points of triangles.

#include <algorithm>

#include "core/base/fastmath.h"
#include "core/batch/runs.h"
#include "core/render/surface_kinds.h"

namespace whit {
namespace {

/// Three values per lane, one for each corner of its triangle.
struct Corners {
  Vec3Lanes a, b, c;
  Corners(Arena& arena, int n) : a(arena.vec3(n)), b(arena.vec3(n)), c(arena.vec3(n)) {}
  Corners() = default;

  /// Fills n lanes from `first` on with the vertices' vectors, 3 floats each, of triangles of one mesh; with 0 where the
  /// mesh has no such vectors.
  void gather(const std::vector<float>& vectors, const std::vector<uint32_t>& indices, const uint32_t* prim, int first,
              int n) const {
    const float* const v = vectors.data();
    const auto at = [v](uint32_t i) { return Vec3f(v[3 * i], v[3 * i + 1], v[3 * i + 2]); };
    const bool has = !vectors.empty();
    for_triangles(prim, first, n, [&](uint32_t triangle, int from, int to) {
      const uint32_t* index = &indices[3 * static_cast<size_t>(triangle)];
      fill(a, from, to, has ? at(index[0]) : Vec3f(0, 0, 0));
      fill(b, from, to, has ? at(index[1]) : Vec3f(0, 0, 0));
      fill(c, from, to, has ? at(index[2]) : Vec3f(0, 0, 0));
    });
  }

  /// Calls f(triangle, from, to) for every stretch of lanes on one triangle: a wall's are long.
  template <class F>
  static void for_triangles(const uint32_t* prim, int first, int n, const F& f) {
    for_runs(
        first, first + n, [&](int i) { return prim[i]; }, [&](int from, int to) { f(prim[from], from, to); });
  }

 private:
  static void fill(const Vec3Lanes& lanes, int from, int to, const Vec3f& v) {
    float *const x = lanes.x, *const y = lanes.y, *const z = lanes.z;
    for (int i = from; i < to; ++i) x[i] = v.x, y[i] = v.y, z[i] = v.z;
  }
};

/// What is gathered from meshes, lane by lane, before the arithmetic that vectorises.
struct TriangleLanes {
  Corners p, n, s;
  float *u0, *v0, *u1, *v1, *u2, *v2;
  float* unit;  ///< The length of a world unit.
  bool any_normals = false, any_tangents = false, any_signs = false, any_exact = false;

  /// Texture coordinates of triangles of one mesh, as Corners::gather(); pbrt's where the mesh has none.
  void gather_uvs(const Mesh& mesh, const uint32_t* prim, int first, int count) const {
    const auto fill = [&](int from, int to, const Vec2f& a, const Vec2f& b, const Vec2f& c) {
      std::fill(u0 + from, u0 + to, a.x), std::fill(v0 + from, v0 + to, a.y);
      std::fill(u1 + from, u1 + to, b.x), std::fill(v1 + from, v1 + to, b.y);
      std::fill(u2 + from, u2 + to, c.x), std::fill(v2 + from, v2 + to, c.y);
    };
    if (mesh.uvs.empty()) return fill(first, first + count, {0, 0}, {1, 0}, {1, 1});
    Corners::for_triangles(prim, first, count, [&](uint32_t triangle, int from, int to) {
      const uint32_t* index = &mesh.indices[3 * static_cast<size_t>(triangle)];
      fill(from, to, mesh.uv(index[0]), mesh.uv(index[1]), mesh.uv(index[2]));
    });
  }
};

TriangleLanes gather_triangles(const Scene& scene, const SurfaceHits& h, int offset, int count, Arena& arena) {
  TriangleLanes t;
  const int32_t* const shapes = h.shape + offset;
  const uint32_t* const prim = h.prim + offset;
  const auto shape_of = [&](int i) -> const SceneShape& { return scene.shapes[static_cast<size_t>(shapes[i])]; };
  // Calls f(shape, first, n) for every stretch of lanes of one shape.
  const auto for_shapes = [&](const auto& f) {
    for_runs(
        0, count, [&](int i) { return shapes[i]; },
        [&](int first, int last) { f(shape_of(first), first, last - first); });
  };
  t.p = Corners(arena, count);
  t.u0 = arena.floats(count), t.v0 = arena.floats(count), t.u1 = arena.floats(count);
  t.v1 = arena.floats(count), t.u2 = arena.floats(count), t.v2 = arena.floats(count), t.unit = arena.floats(count);
  for_shapes([&](const SceneShape& shape, int first, int n) {
    const Mesh& mesh = *shape.mesh;
    t.p.gather(mesh.positions, mesh.indices, prim, first, n);
    t.gather_uvs(mesh, prim, first, n);
    std::fill_n(t.unit + first, n, shape.unit);
    t.any_normals |= !mesh.normals.empty();
    t.any_tangents |= !mesh.tangents.empty();
    t.any_signs |= !mesh.bitangent_signs.empty();
    t.any_exact |= !mesh.exact.empty();
  });
  const auto gather_vectors = [&](Corners& to, std::vector<float> Mesh::*vectors) {
    to = Corners(arena, count);
    for_shapes([&](const SceneShape& shape, int first, int n) {
      to.gather(shape.mesh->*vectors, shape.mesh->indices, prim, first, n);
    });
  };
  if (t.any_normals) gather_vectors(t.n, &Mesh::normals);
  if (t.any_tangents) gather_vectors(t.s, &Mesh::tangents);
  return t;
}

/// Points, partial derivatives and the geometric normal of triangles.
void triangle_geometry(const TriangleLanes& t, const ShadingBatch& s, const GeometricPartials& g, const float* bary_u,
                       const float* bary_v) {
  for_lanes(s.n, [&](int i) {
    const float b1 = bary_u[i], b2 = bary_v[i], b0 = 1 - b1 - b2;
    const Vec3f p0 = t.p.a[i], p1 = t.p.b[i], p2 = t.p.c[i];
    const auto mix = [&](float x, float y, float z) { return b0 * x + b1 * y + b2 * z; };
    const auto bound = [&](float x, float y, float z) {
      return gamma_bound(7) * (std::abs(b0 * x) + std::abs(b1 * y) + std::abs(b2 * z));
    };
    s.p.set(i, {mix(p0.x, p1.x, p2.x), mix(p0.y, p1.y, p2.y), mix(p0.z, p1.z, p2.z)});
    s.p_error.set(i, {bound(p0.x, p1.x, p2.x), bound(p0.y, p1.y, p2.y), bound(p0.z, p1.z, p2.z)});
    s.u[i] = mix(t.u0[i], t.u1[i], t.u2[i]);
    s.v[i] = mix(t.v0[i], t.v1[i], t.v2[i]);
    const Vec3f e02 = p0 - p2, e12 = p1 - p2;
    const float du02 = t.u0[i] - t.u2[i], du12 = t.u1[i] - t.u2[i];
    const float dv02 = t.v0[i] - t.v2[i], dv12 = t.v1[i] - t.v2[i];
    const Vec3f n = normalize_any(cross(e02, e12));
    // Where the texture coordinates span no area, any tangent frame serves. Its vectors, like interpolated ones, have
    // the length 1 in world space: bump maps measure against them.
    const float det = du02 * dv12 - dv02 * du12;
    const float inverse = det != 0 ? 1 / det : 0.0f;
    Vec3f dpdu = (e02 * dv12 - e12 * dv02) * inverse, dpdv = (e12 * du02 - e02 * du12) * inverse;
    const Vec3f area = cross(dpdu, dpdv);
    const Frame frame = coordinate_system(n);
    const bool usable = dot(area, area) > 0;
    const float unit = t.unit[i];
    const auto pick = [&](float a, float b) { return usable ? a : b * unit; };
    dpdu = {pick(dpdu.x, frame.s.x), pick(dpdu.y, frame.s.y), pick(dpdu.z, frame.s.z)};
    dpdv = {pick(dpdv.x, frame.t.x), pick(dpdv.y, frame.t.y), pick(dpdv.z, frame.t.z)};
    g.dpdu.set(i, dpdu), g.dpdv.set(i, dpdv);
    s.dpdu.set(i, dpdu), s.dpdv.set(i, dpdv);
    const float flip = s.flips[i] ? -1.0f : 1.0f;
    s.ng.set(i, n * flip);
    s.ns.set(i, n * flip);
  });
}

/// Interpolated normals and tangents, for lanes whose mesh has them; the geometric normal turns to their side.
template <bool kNormals, bool kTangents>
void triangle_shading(const TriangleLanes& t, const ShadingBatch& s, const float* bary_u, const float* bary_v) {
  for_lanes(s.n, [&](int i) {
    const float b1 = bary_u[i], b2 = bary_v[i], b0 = 1 - b1 - b2;
    Vec3f nsum(0, 0, 0), tsum(0, 0, 0);
    if constexpr (kNormals) nsum = t.n.a[i] * b0 + t.n.b[i] * b1 + t.n.c[i] * b2;
    if constexpr (kTangents) tsum = t.s.a[i] * b0 + t.s.b[i] * b1 + t.s.c[i] * b2;
    const bool has_n = dot(nsum, nsum) > 0, has_t = dot(tsum, tsum) > 0;
    const auto pick = [](bool c, const Vec3f& a, const Vec3f& b) {
      return Vec3f(c ? a.x : b.x, c ? a.y : b.y, c ? a.z : b.z);
    };
    const float flip = s.flips[i] ? -1.0f : 1.0f;
    // Before any flip: pbrt flips the finished shading normal.
    const Vec3f ns = pick(has_n, normalize_any(nsum), s.ng[i] * flip);
    Vec3f ss = pick(has_t, normalize_any(tsum), normalize_any(s.dpdu[i]));
    const Vec3f side = cross(ss, ns);
    const bool framed = dot(side, side) > 0;
    const Frame frame = coordinate_system(ns);
    const Vec3f ts = pick(framed, normalize_any(side), frame.t);
    ss = pick(framed, cross(ts, ns), frame.s);
    const bool shaded = has_n | has_t;
    const Vec3f turned = ns * flip, ng = s.ng[i];
    s.dpdu.set(i, pick(shaded, ss * t.unit[i], s.dpdu[i]));
    s.dpdv.set(i, pick(shaded, ts * t.unit[i], s.dpdv[i]));
    s.ns.set(i, pick(shaded, turned, s.ns[i]));
    s.ng.set(i, pick(shaded & (dot(ng, turned) < 0), -ng, ng));
  });
}

/// Of meshes that say where their bitangents point: dpdu goes along the tangent, and dpdv to that side of it. For others
/// triangle_shading() has turned both around the normal by 180 degrees, as pbrt: cross(cross(s, n), n) is -s. A normal map
/// would be turned with them, so where there is one they go where the tangents say, or the texture coordinates.
void turn_tangents(const Scene& scene, const SurfaceHits& h, int first, bool normal_map, const ShadingBatch& s,
                   const GeometricPartials& g, const float* bary_u, const float* bary_v) {
  for (int i = 0; i < s.n; ++i) {
    const Mesh& mesh = *scene.shapes[static_cast<size_t>(h.shape[first + i])].mesh;
    if (mesh.normals.empty() && mesh.tangents.empty()) continue;
    float side = 1;
    if (!mesh.bitangent_signs.empty()) {
      const uint32_t* const index = mesh.corners(h.prim[first + i]);
      const float b1 = bary_u[i], b2 = bary_v[i], b0 = 1 - b1 - b2;
      const float* const sign = mesh.bitangent_signs.data();
      side = b0 * sign[index[0]] + b1 * sign[index[1]] + b2 * sign[index[2]];
    } else if (!normal_map) {
      continue;
    } else if (mesh.tangents.empty()) {
      side = -dot(s.dpdv[i], g.dpdv[i]);
    }
    s.dpdu.set(i, -s.dpdu[i]);
    if (!(side < 0)) s.dpdv.set(i, -s.dpdv[i]);
  }
}

/// Derivatives of the interpolated normal, made a unit vector, with respect to (u, v).
void triangle_normal_derivatives(const TriangleLanes& t, const ShadingBatch& s, const float* bary_u,
                                 const float* bary_v) {
  if (!t.any_normals) {
    for_lanes(s.n, [&](int i) { s.dndu.set(i, {0, 0, 0}), s.dndv.set(i, {0, 0, 0}); });
    return;
  }
  for_lanes(s.n, [&](int i) {
    const float b1 = bary_u[i], b2 = bary_v[i], b0 = 1 - b1 - b2;
    const float du02 = t.u0[i] - t.u2[i], du12 = t.u1[i] - t.u2[i];
    const float dv02 = t.v0[i] - t.v2[i], dv12 = t.v1[i] - t.v2[i];
    const Vec3f sum = t.n.a[i] * b0 + t.n.b[i] * b1 + t.n.c[i] * b2, n = normalize_any(sum);
    const float scale = (du02 * dv12 - dv02 * du12) * dot(sum, n);
    const float inverse = scale != 0 ? (s.flips[i] ? -1.0f : 1.0f) / scale : 0.0f;
    const Vec3f n02 = t.n.a[i] - t.n.c[i], n12 = t.n.b[i] - t.n.c[i];
    const Vec3f du = (n02 * dv12 - n12 * dv02) * inverse, dv = (n12 * du02 - n02 * du12) * inverse;
    s.dndu.set(i, du - n * dot(n, du));
    s.dndv.set(i, dv - n * dot(n, dv));
  });
}

/// Partial derivatives from the corners' texture coordinates, as triangle_geometry() has them; false where they span no
/// area.
bool exact_partials(const ExactTriangle& t, const TriangleLanes& lanes, int i, Vec3d& dpdu, Vec3d& dpdv) {
  const double du02 = lanes.u0[i] - lanes.u2[i], du12 = lanes.u1[i] - lanes.u2[i];
  const double dv02 = lanes.v0[i] - lanes.v2[i], dv12 = lanes.v1[i] - lanes.v2[i];
  const double det = du02 * dv12 - dv02 * du12;
  if (det == 0) return false;
  const Vec3d e02 = t.a - t.c, e12 = t.b - t.c;
  dpdu = (e02 * dv12 - e12 * dv02) / det, dpdv = (e12 * du02 - e02 * du12) / det;
  return dpdu.cross(dpdv).length2() > 0;
}

/// What triangle_geometry() computes, in double precision, for lanes on huge triangles: where the ray meets the plane, for
/// Embree's weights are as far off as the triangle is large. Corrects these weights, too.
void exact_geometry(const Scene& scene, const SurfaceHits& h, int first, const TriangleLanes& lanes,
                    const ShadingBatch& s, const GeometricPartials& g, float* bary_u, float* bary_v) {
  for (int i = 0; i < s.n; ++i) {
    const int lane = first + i;
    const Mesh& mesh = *scene.shapes[static_cast<size_t>(h.shape[lane])].mesh;
    if (mesh.exact.empty()) continue;
    const ExactTriangle& t = mesh.exact[h.prim[lane]];
    Vec3d o(h.o[lane]), d(h.d[lane]);
    if (h.instance[lane] >= 0) {
      const Mat4d to_local = render_to_local(scene, h, lane);
      o = transform_point(to_local, o), d = transform_vector(to_local, d);
    }
    const double along = plane_distance(t, o, d);
    const Vec3d met = o + (std::isfinite(along) ? along : static_cast<double>(h.t[lane])) * d;
    const Vec3d p = met + t.n * (t.height - t.n.dot(met));
    const Vec2d b = weights_at(t, p);
    const auto mix = [&](float x, float y, float z) {
      return static_cast<float>((1 - b.x - b.y) * static_cast<double>(x) + b.x * static_cast<double>(y) +
                                b.y * static_cast<double>(z));
    };
    bary_u[i] = static_cast<float>(b.x), bary_v[i] = static_cast<float>(b.y);
    s.u[i] = mix(lanes.u0[i], lanes.u1[i], lanes.u2[i]), s.v[i] = mix(lanes.v0[i], lanes.v1[i], lanes.v2[i]);
    const Vec3f rounded = to_float(p);
    // The rounding as it is, as in place_points(), and what the plane may be off beside a neighbour's.
    const auto error = [&](int c) {
      const double rounding = std::abs(p[c] - static_cast<double>(rounded[c])) * 1.0001;
      return static_cast<float>(rounding + std::abs(t.n[c]) * t.error + std::abs(p[c]) * 4.5e-16);
    };
    s.p.set(i, rounded);
    s.p_error.set(i, {error(0), error(1), error(2)});
    const Vec3f n = to_float(t.n) * (s.flips[i] ? -1.0f : 1.0f);
    s.ng.set(i, n), s.ns.set(i, n);
    Vec3d dpdu, dpdv;
    if (!exact_partials(t, lanes, i, dpdu, dpdv)) {
      const Frame frame = coordinate_system(to_float(t.n));
      dpdu = Vec3d(frame.s * lanes.unit[i]), dpdv = Vec3d(frame.t * lanes.unit[i]);
    }
    for (const Vec3Lanes* u : {&s.dpdu, &g.dpdu}) u->set(i, to_float(dpdu));
    for (const Vec3Lanes* v : {&s.dpdv, &g.dpdv}) v->set(i, to_float(dpdv));
  }
}

}  // namespace

void mesh_surfaces(const Scene& scene, const SurfaceHits& h, int first, const ShadingBatch& s,
                   const GeometricPartials& g, Arena& arena) {
  ArenaScope scope(arena);
  const TriangleLanes t = gather_triangles(scene, h, first, s.n, arena);
  const float *bu = h.u + first, *bv = h.v + first;
  triangle_geometry(t, s, g, bu, bv);
  if (t.any_exact) {
    float *exact_u = arena.floats(s.n), *exact_v = arena.floats(s.n);
    std::copy_n(bu, s.n, exact_u), std::copy_n(bv, s.n, exact_v);
    exact_geometry(scene, h, first, t, s, g, exact_u, exact_v);
    bu = exact_u, bv = exact_v;
  }
  // All of these points are of one material.
  const int material = scene.shapes[static_cast<size_t>(h.shape[first])].material;
  const bool normal_map =
      scene.plan.live(Effect::Bump) && scene.materials[static_cast<size_t>(material)]->has_normal_map();
  if (t.any_normals && t.any_tangents) triangle_shading<true, true>(t, s, bu, bv);
  if (t.any_normals && !t.any_tangents) triangle_shading<true, false>(t, s, bu, bv);
  if (!t.any_normals && t.any_tangents) triangle_shading<false, true>(t, s, bu, bv);
  if (t.any_signs || normal_map) turn_tangents(scene, h, first, normal_map, s, g, bu, bv);
  if (s.dndu) triangle_normal_derivatives(t, s, bu, bv);
  if (s.u1 || s.color) mesh_attributes(scene, h, first, s, g, bu, bv);
}

}  // namespace whit
