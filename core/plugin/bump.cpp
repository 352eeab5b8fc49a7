#include "core/plugin/bump.h"

#include "core/base/fastmath.h"

namespace whit {

namespace {

/// Half the change of a surface parameter over the footprint: how far to step for the difference.
float* parameter_step(const ShadingBatch& s, const float* ddx, const float* ddy) {
  float* const step = s.arena->floats(s.n);
  if (!s.has_footprint()) {
    for_lanes(s.n, [&](int i) { step[i] = 0.0005f; });
  } else {
    for_lanes(s.n, [&](int i) {
      const float h = 0.5f * (std::abs(ddx[i]) + std::abs(ddy[i]));
      step[i] = h > 0 ? h : 0.0005f;
    });
  }
  return step;
}

/// The displacement at the points moved by `step` along a tangent and its surface parameter.
float* displacement_beside(const Tex<float>& displacement, const ShadingBatch& s, const float* step,
                           const Vec3Lanes& tangent, bool along_u) {
  ShadingBatch moved = s;
  moved.p = s.arena->vec3(s.n);
  float* const parameter = s.arena->floats(s.n);
  const float* const from = along_u ? s.u : s.v;
  for_lanes(s.n, [&](int i) {
    moved.p.set(i, s.p[i] + tangent[i] * step[i]);
    parameter[i] = from[i] + step[i];
  });
  (along_u ? moved.u : moved.v) = parameter;
  if (s.u1) {
    const float *const du1 = along_u ? s.du1du : s.du1dv, *const dv1 = along_u ? s.dv1du : s.dv1dv;
    moved.u1 = s.arena->floats(s.n), moved.v1 = s.arena->floats(s.n);
    for_lanes(s.n, [&](int i) {
      moved.u1[i] = s.u1[i] + du1[i] * step[i];
      moved.v1[i] = s.v1[i] + dv1[i] * step[i];
    });
  }
  return displacement(moved);
}

/// Adds the displacement's slope along the normal, and the normal's own change, to a tangent. All lengths in
/// render units.
void displace_tangent(int n, const Vec3Lanes& tangent, const float* here, const float* beside, const float* step,
                      float scale, const Vec3Lanes& normal, const Vec3Lanes& normal_derivative) {
  for_lanes(n, [&](int i) {
    const float slope = scale * (beside[i] - here[i]) / step[i];
    tangent.set(i, tangent[i] + normal[i] * slope);
  });
  if (!normal_derivative) return;
  for_lanes(n, [&](int i) { tangent.set(i, tangent[i] + normal_derivative[i] * (scale * here[i])); });
}

}  // namespace

void apply_bump(const Tex<float>& displacement, float scale, ShadingBatch& s) {
  if (displacement.is_constant()) return;
  const StageScope stage(s.clock, Stage::Textures);
  const ArenaScope scratch(*s.arena);
  const float* const du = parameter_step(s, s.dudx, s.dudy);
  const float* const dv = parameter_step(s, s.dvdx, s.dvdy);
  const float* const beside_u = displacement_beside(displacement, s, du, s.dpdu, true);
  const float* const beside_v = displacement_beside(displacement, s, dv, s.dpdv, false);
  const float* const here = displacement(s);
  displace_tangent(s.n, s.dpdu, here, beside_u, du, scale, s.ns, s.dndu);
  displace_tangent(s.n, s.dpdv, here, beside_v, dv, scale, s.ns, s.dndv);
  for_lanes(s.n, [&](int i) {
    // Facing ng makes the handedness of (dpdu, dpdv) irrelevant. Each is scaled first: their product may
    // underflow.
    const Vec3f c = normalize(cross(normalize_any(s.dpdu[i]), normalize_any(s.dpdv[i])));
    const Vec3f n = face_forward(c, s.ng[i]), old = s.ns[i];
    const bool usable = dot(c, c) > 0.5f;  // not where the tangents are parallel, or NaN
    s.ns.set(i, {usable ? n.x : old.x, usable ? n.y : old.y, usable ? n.z : old.z});
  });
}

void apply_normal_map(const Tex<RGB>& map, float scale, ShadingBatch& s) {
  const StageScope stage(s.clock, Stage::Textures);
  const ArenaScope scratch(*s.arena);
  const RGBLanes colour = map(s);
  constexpr float kLeastCosine = 1e-3f;
  for_lanes(s.n, [&](int i) {
    const Vec3f n = s.ns[i], ng = s.ng[i], u = s.dpdu[i], v = s.dpdv[i];
    const RGB c = colour[i];
    const Vec3f tilted = normalize(normalize_any(u) * (scale * (2 * c.x - 1)) +
                                   normalize_any(v) * (scale * (2 * c.y - 1)) + n * (2 * c.z - 1));
    const Vec3f above = normalize(tilted + ng * max_of(kLeastCosine - dot(tilted, ng), 0.0f));
    const bool usable = dot(above, above) > 0.5f;  // not where the tangents or the map are NaN
    const Vec3f to{usable ? above.x : n.x, usable ? above.y : n.y, usable ? above.z : n.z};
    s.ns.set(i, to);
    s.dpdu.set(i, u - to * dot(u, to));
    s.dpdv.set(i, v - to * dot(v, to));
  });
}

}  // namespace whit
