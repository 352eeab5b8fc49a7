#include "plugins/shared/texture_mapping.h"

#include "core/base/fastmath.h"

namespace whit {

namespace {

/// Where a direction lies on the sphere: s = theta / pi, t = phi / (2 pi) in [0, 1). Not for its length.
struct SphericalAngles {
  static constexpr float delta = 0.1f;  ///< pbrt's step for derivatives, as a part of the footprint.
  static Vec2f st(const Vec3f& p) {
    const float theta = atan2_of(std::sqrt(p.x * p.x + p.y * p.y), p.z);
    const float phi = atan2_of(p.y, p.x);
    return {theta * kInvPi, (phi < 0 ? phi + kTwoPi : phi) * (0.5f * kInvPi)};
  }
};

/// s = the angle around z over 2 pi, t = the cosine to z (pbrt normalises the point first).
struct CylindricalAngles {
  static constexpr float delta = 0.01f;
  static Vec2f st(const Vec3f& p) { return {(kPi + atan2_of(p.y, p.x)) * (0.5f * kInvPi), normalize_any(p).z}; }
};

/// pbrt's remedy for the seam, applied to t of both mappings.
inline float unwrap(float d) {
  const float low = d < -0.5f ? -(d + 1) : d;
  return d > 0.5f ? 1 - d : low;
}

MappedPoints alloc_points(const ShadingBatch& s) {
  MappedPoints m;
  m.s = s.arena->floats(s.n), m.t = s.arena->floats(s.n);
  if (!s.has_footprint()) return m;
  m.dsdx = s.arena->floats(s.n), m.dtdx = s.arena->floats(s.n);
  m.dsdy = s.arena->floats(s.n), m.dtdy = s.arena->floats(s.n);
  return m;
}

/// A mapping by angles: derivatives are differences over a small part of the footprint.
template <class Angles>
void map_angles(const AffineMap& from_render, const ShadingBatch& s, const MappedPoints& m) {
  for_lanes(s.n, [&](int i) {
    const Vec2f st = Angles::st(from_render.point(s.p[i]));
    m.s[i] = st.x, m.t[i] = st.y;
  });
  if (!s.has_footprint()) return;
  const auto differences = [&](const Vec3Lanes& dp, float* ds, float* dt) {
    for_lanes(s.n, [&](int i) {
      const Vec2f st = Angles::st(from_render.point(s.p[i] + dp[i] * Angles::delta));
      ds[i] = (st.x - m.s[i]) / Angles::delta;
      dt[i] = unwrap((st.y - m.t[i]) / Angles::delta);
    });
  };
  differences(s.dpdx, m.dsdx, m.dtdx);
  differences(s.dpdy, m.dsdy, m.dtdy);
}

void map_planar(const AffineMap& from_render, const ShadingBatch& s, const MappedPoints& m) {
  for_lanes(s.n, [&](int i) {
    const Vec3f st = from_render.point(s.p[i]);
    m.s[i] = st.x, m.t[i] = st.y;
  });
  if (!s.has_footprint()) return;
  for_lanes(s.n, [&](int i) {
    const Vec3f dx = from_render.vector(s.dpdx[i]), dy = from_render.vector(s.dpdy[i]);
    m.dsdx[i] = dx.x, m.dtdx[i] = dx.y, m.dsdy[i] = dy.x, m.dtdy[i] = dy.y;
  });
}

/// A set of texture coordinates with its footprints.
struct UvSet {
  const float *u, *v, *dudx, *dvdx, *dudy, *dvdy;
  UvSet(const ShadingBatch& s, bool second) : u(s.u), v(s.v), dudx(s.dudx), dvdx(s.dvdx), dudy(s.dudy), dvdy(s.dvdy) {
    if (second && s.u1) u = s.u1, v = s.v1, dudx = s.du1dx, dvdx = s.dv1dx, dudy = s.du1dy, dvdy = s.dv1dy;
  }
};

void map_uv_turned(const TextureMapping2D& uv, const ShadingBatch& s, const UvSet& from, const MappedPoints& m) {
  for_lanes(s.n, [&](int i) {
    m.s[i] = uv.su * from.u[i] + uv.s_of_v * from.v[i] + uv.du;
    m.t[i] = uv.t_of_u * from.u[i] + uv.sv * from.v[i] + uv.dv;
  });
  if (!s.has_footprint()) return;
  for_lanes(s.n, [&](int i) {
    m.dsdx[i] = uv.su * from.dudx[i] + uv.s_of_v * from.dvdx[i];
    m.dtdx[i] = uv.t_of_u * from.dudx[i] + uv.sv * from.dvdx[i];
    m.dsdy[i] = uv.su * from.dudy[i] + uv.s_of_v * from.dvdy[i];
    m.dtdy[i] = uv.t_of_u * from.dudy[i] + uv.sv * from.dvdy[i];
  });
}

void map_uv(const TextureMapping2D& uv, const ShadingBatch& s, const MappedPoints& m) {
  const UvSet from(s, uv.second_uvs);
  if (uv.turns) return map_uv_turned(uv, s, from, m);
  for_lanes(s.n, [&](int i) { m.s[i] = uv.su * from.u[i] + uv.du, m.t[i] = uv.sv * from.v[i] + uv.dv; });
  if (!s.has_footprint()) return;
  for_lanes(s.n, [&](int i) {
    m.dsdx[i] = uv.su * from.dudx[i], m.dtdx[i] = uv.sv * from.dvdx[i];
    m.dsdy[i] = uv.su * from.dudy[i], m.dtdy[i] = uv.sv * from.dvdy[i];
  });
}

/// World space to (s, t, 0): s = v1 . p + du, t = v2 . p + dv.
Mat4d planar_matrix(const Vec3d& v1, const Vec3d& v2, double du, double dv) {
  return Mat4d(v1.x, v2.x, 0, 0, v1.y, v2.y, 0, 0, v1.z, v2.z, 0, 0, du, dv, 0, 1);
}

}  // namespace

AffineMap::AffineMap(const Mat4d& m)
    : x(static_cast<float>(m[0][0]), static_cast<float>(m[1][0]), static_cast<float>(m[2][0])),
      y(static_cast<float>(m[0][1]), static_cast<float>(m[1][1]), static_cast<float>(m[2][1])),
      z(static_cast<float>(m[0][2]), static_cast<float>(m[1][2]), static_cast<float>(m[2][2])),
      offset(static_cast<float>(m[3][0]), static_cast<float>(m[3][1]), static_cast<float>(m[3][2])) {}

AffineMap mapping_3d(const Mat4d& texture_to_world, const RenderSpace& space) {
  return AffineMap(space.to_world() * texture_to_world);
}

MappedPoints TextureMapping2D::map(const ShadingBatch& s) const {
  const MappedPoints m = alloc_points(s);
  switch (kind) {
    case Uv: map_uv(*this, s, m); break;
    case Spherical: map_angles<SphericalAngles>(from_render, s, m); break;
    case Cylindrical: map_angles<CylindricalAngles>(from_render, s, m); break;
    case Planar: map_planar(from_render, s, m); break;
  }
  return m;
}

template <class T>
TextureMapping2D Texture2D<T>::make_mapping(int kind, const UvParameters& uv, const Vec3d& v1, const Vec3d& v2,
                                            const Mat4d& texture_to_world, const RenderSpace& space) {
  TextureMapping2D m;
  m.kind = static_cast<TextureMapping2D::Kind>(kind);
  m.su = uv.su, m.sv = uv.sv, m.du = uv.du, m.dv = uv.dv;
  if (uv.matrix.size() == 6) {
    // The matrix, then scale and shift: in one, rounded once.
    const auto scaled = [&](float scale, size_t i) { return static_cast<float>(double{scale} * uv.matrix[i]); };
    const auto shifted = [&](float scale, float shift, size_t i) {
      return static_cast<float>(double{scale} * uv.matrix[i] + double{shift});
    };
    m.su = scaled(uv.su, 0), m.s_of_v = scaled(uv.su, 1), m.du = shifted(uv.su, uv.du, 2);
    m.t_of_u = scaled(uv.sv, 3), m.sv = scaled(uv.sv, 4), m.dv = shifted(uv.sv, uv.dv, 5);
    m.turns = m.s_of_v != 0 || m.t_of_u != 0;
  }
  // The planar mapping takes world points as they are: pbrt-v3 ignores the CTM there.
  if (m.kind == TextureMapping2D::Planar)
    m.from_render = AffineMap(space.to_world() * planar_matrix(v1, v2, uv.du, uv.dv));
  else if (m.kind != TextureMapping2D::Uv) m.from_render = AffineMap(space.to_world() * texture_to_world.inverse());
  return m;
}

template class Texture2D<float>;
template class Texture2D<RGB>;

}  // namespace whit
