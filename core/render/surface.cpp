#include "core/render/surface.h"

#include "core/base/fastmath.h"
#include "core/batch/fields.h"
#include "core/scene/bake.h"
#include "core/scene/motion.h"

namespace whit {
namespace {

/// gamma(n) = n eps / (1 - n eps): the bound on n accumulated rounding errors (PBR 3e, section 3.9.1).
constexpr float gamma_bound(int n) {
  constexpr float kHalfUlp = 0x1p-24f;
  return static_cast<float>(n) * kHalfUlp / (1 - static_cast<float>(n) * kHalfUlp);
}

/// Geometric partial derivatives, which footprints need beside the shading ones.
struct GeometricPartials {
  Vec3Lanes dpdu, dpdv;
};

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
    for (int i = first; i < first + n; ++i) {
      const uint32_t* index = &indices[3 * static_cast<size_t>(prim[i])];
      const bool has = !vectors.empty();
      a.set(i, has ? at(index[0]) : Vec3f(0, 0, 0));
      b.set(i, has ? at(index[1]) : Vec3f(0, 0, 0));
      c.set(i, has ? at(index[2]) : Vec3f(0, 0, 0));
    }
  }
};

/// What is gathered from meshes, lane by lane, before the arithmetic that vectorises.
struct TriangleLanes {
  Corners p, n, s;
  float *u0, *v0, *u1, *v1, *u2, *v2;
  float* unit;  ///< The length of a world unit.
  bool any_normals = false, any_tangents = false, any_exact = false;

  /// Texture coordinates of triangles of one mesh, as Corners::gather(); pbrt's where the mesh has none.
  void gather_uvs(const Mesh& mesh, const uint32_t* prim, int first, int count) const {
    const bool has = !mesh.uvs.empty();
    for (int i = first; i < first + count; ++i) {
      const uint32_t* index = &mesh.indices[3 * static_cast<size_t>(prim[i])];
      const Vec2f a = has ? mesh.uv(index[0]) : Vec2f(0, 0), b = has ? mesh.uv(index[1]) : Vec2f(1, 0);
      const Vec2f c = has ? mesh.uv(index[2]) : Vec2f(1, 1);
      u0[i] = a.x, v0[i] = a.y, u1[i] = b.x, v1[i] = b.y, u2[i] = c.x, v2[i] = c.y;
    }
  }
};

TriangleLanes gather_triangles(const Scene& scene, const SurfaceHits& h, int offset, int count, Arena& arena) {
  TriangleLanes t;
  const int32_t* const shapes = h.shape + offset;
  const uint32_t* const prim = h.prim + offset;
  const auto shape_of = [&](int i) -> const SceneShape& { return scene.shapes[static_cast<size_t>(shapes[i])]; };
  // Calls f(shape, first, n) for every stretch of lanes of one shape.
  const auto for_shapes = [&](const auto& f) {
    for (int first = 0, last; first < count; first = last) {
      for (last = first + 1; last < count && shapes[last] == shapes[first];) ++last;
      f(shape_of(first), first, last - first);
    }
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

Vec3f to_float(const Vec3d& v) {
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
Mat4d render_to_local(const Scene& scene, const SurfaceHits& h, int i) {
  if (h.instance[i] < 0) return Mat4d();
  const SceneInstance& instance = scene.instances[static_cast<size_t>(h.instance[i])];
  return interpolate_keys(scene.keys_of(instance), h.time_of(i)).inverse();
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
  if (t.any_normals && t.any_tangents) triangle_shading<true, true>(t, s, bu, bv);
  if (t.any_normals && !t.any_tangents) triangle_shading<true, false>(t, s, bu, bv);
  if (!t.any_normals && t.any_tangents) triangle_shading<false, true>(t, s, bu, bv);
  if (s.dndu) triangle_normal_derivatives(t, s, bu, bv);
}

/// The unit normal of derivatives that m has transformed. pbrt flips the object's normal and then transforms it, so the
/// cross product's own change of sign under a mirroring goes.
Vec3d oriented_normal(const Vec3d& dpdu, const Vec3d& dpdv, const Mat4d& m, bool flips) {
  return dpdu.cross(dpdv).normalized() * (flips != swaps_handedness(m) ? -1.0 : 1.0);
}

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

/// The error that makes rays leave at `distance` along the unit normal n, to either side, whichever way n points.
Vec3f error_along(const Vec3d& n, double distance) {
  return to_float(Vec3d(std::abs(n.x), std::abs(n.y), std::abs(n.z)) * distance);
}

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

ShadingBatch allocate(const SurfaceHits& h, bool bumps, Arena& arena) {
  ShadingBatch s = with_all_fields<ShadingBatch>();
  const bool footprints = h.has_differentials();
  if (!bumps && !footprints) s.dndu = s.dndv = {};
  if (!footprints) s.dudx = s.dvdx = s.dudy = s.dvdy = nullptr, s.dpdx = s.dpdy = {};
  s = allocate_like(s, h.n, arena);
  s.n = h.n;
  s.arena = &arena;
  return s;
}

}  // namespace

ShadingBatch compute_surfaces(const Scene& scene, const SurfaceHits& h, Arena& arena) {
  const ShadingBatch s = allocate(h, scene.plan.live(Effect::Bump), arena);
  const GeometricPartials g{arena.vec3(h.n), arena.vec3(h.n)};
  for (int i = 0; i < h.n; ++i) s.flips[i] = scene.shapes[static_cast<size_t>(h.shape[i])].flips;
  for_lanes(h.n, [&](int i) { s.wo.set(i, -h.d[i]); });
  for (int first = 0, last; first < h.n; first = last) {
    const SceneShape& shape = scene.shapes[static_cast<size_t>(h.shape[first])];
    last = first + 1;
    while (last < h.n && scene.shapes[static_cast<size_t>(h.shape[last])].sort_key == shape.sort_key) ++last;
    const ShadingBatch run = s.range(first, last - first);
    const GeometricPartials partials{g.dpdu.from(first), g.dpdv.from(first)};
    if (shape.mesh) {
      mesh_surfaces(scene, h, first, run, partials, arena);
    } else if (shape.analytic) {
      analytic_surfaces(scene, h, first, run, partials);
    } else {
      curve_surfaces(scene, h, first, run, partials);
    }
  }
  if (scene.has_instances) place_surfaces(scene, h, s, g);
  if (h.has_differentials()) compute_footprints(h, s, g);
  return s;
}

}  // namespace whit
