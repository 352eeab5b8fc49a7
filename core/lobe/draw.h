// What drawing directions from lobes has in common: the way to the local frame and back, and directions around the
// normal.
#pragma once

#include "core/base/fastmath.h"
#include "core/base/sampling.h"
#include "core/lobe/table.h"

namespace whit {

/// The tangents of a point: those of the frame, or any.
struct GivenTangents {
  const LobeFrame& frame;
  Frame operator()(int i, const Vec3f& /*n*/) const { return {frame.ss[i], frame.ts[i]}; }
};
struct AnyTangents {
  Frame operator()(int /*i*/, const Vec3f& n) const { return coordinate_system(n); }
};

inline Vec3f to_local(const Frame& t, const Vec3f& n, const Vec3f& w) { return {dot(w, t.s), dot(w, t.t), dot(w, n)}; }
inline Vec3f to_render(const Frame& t, const Vec3f& n, const Vec3f& w) { return t.s * w.x + t.t * w.y + n * w.z; }

/// Draws direction(i, wo, u, v) for the lanes that chose the lobe. Both directions are in the local frame, in which the
/// normal is z; no direction is the zero vector.
template <class Direction>
void draw_lanes(const LobeDraw& d, const Direction& direction) {
  const ShadingBatch& s = d.s;
  const auto run = [&](const auto& tangents) {
    for_lanes(s.n, [&](int i) {
      // Loaded before they are chosen from, or the compiler makes branches of the choices.
      const Vec3f before = d.wi[i], n = s.ns[i];
      const Frame t = tangents(i, n);
      const Vec3f wo = to_local(t, n, s.wo[i]);
      const Vec3f wi = normalize(to_render(t, n, direction(i, wo, d.u[i], d.v[i])));
      const bool mine = d.chosen[i] == d.index;
      const float on = wo.z != 0 ? 1.0f : 0.0f;
      d.wi.set(i, {mine ? wi.x * on : before.x, mine ? wi.y * on : before.y, mine ? wi.z * on : before.z});
    });
  };
  if (d.frame.ss) {
    run(GivenTangents{d.frame});
  } else {
    run(AnyTangents{});
  }
}

/// The same, lane by lane: for what does not vectorise.
template <class Direction>
void draw_one_by_one(const LobeDraw& d, const Direction& direction) {
  const ShadingBatch& s = d.s;
  for (int i = 0; i < s.n; ++i) {
    if (d.chosen[i] != d.index) continue;
    const Vec3f n = s.ns[i];
    const Frame t = d.frame.ss ? GivenTangents{d.frame}(i, n) : AnyTangents{}(i, n);
    const Vec3f wo = to_local(t, n, s.wo[i]);
    d.wi.set(i, wo.z != 0 ? normalize(to_render(t, n, direction(i, wo, d.u[i], d.v[i]))) : Vec3f(0, 0, 0));
  }
}
inline float side_of(float z) { return z < 0 ? -1.0f : 1.0f; }

/// Draws evenly lit directions on wo's side, as all lobes do that are more or less diffuse.
inline void draw_diffuse(const LobeDraw& d) {
  draw_lanes(d, [](int, const Vec3f& wo, float u, float v) {
    const Vec3f w = cosine_hemisphere(u, v);
    return Vec3f(w.x, w.y, w.z * side_of(wo.z));
  });
}

}  // namespace whit
