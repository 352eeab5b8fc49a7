// Surface points for tests: a batch with every array, filled with plausible random values or by hand.
#pragma once

#include <random>

#include "core/base/fastmath.h"
#include "core/batch/shading.h"

namespace whit::test {

struct ShadingPoints {
  explicit ShadingPoints(int n, bool footprint = true) {
    s.n = n, s.arena = &arena;
    for (Vec3Lanes* v : {&s.p, &s.p_error, &s.wo, &s.ng, &s.ns, &s.dpdu, &s.dpdv, &s.dndu, &s.dndv}) *v = arena.vec3(n);
    s.u = arena.floats(n), s.v = arena.floats(n);
    s.flips = arena.alloc<uint8_t>(n);
    if (footprint) {
      for (float** d : {&s.dudx, &s.dvdx, &s.dudy, &s.dvdy}) *d = arena.floats(n);
      s.dpdx = arena.vec3(n), s.dpdy = arena.vec3(n);
    }
    for (int i = 0; i < n; ++i) set_flat(i, 0.5f, 0.5f);
  }

  /// A point of the plane z = 0 with p = (u, v, 0), seen from above, without a footprint.
  void set_flat(int i, float u, float v) {
    s.p.set(i, {u, v, 0}), s.p_error.set(i, {0, 0, 0});
    s.u[i] = u, s.v[i] = v, s.flips[i] = 0;
    s.wo.set(i, normalize(Vec3f(0.3f, 0.2f, 1))), s.ng.set(i, {0, 0, 1}), s.ns.set(i, {0, 0, 1});
    s.dpdu.set(i, {1, 0, 0}), s.dpdv.set(i, {0, 1, 0});
    s.dndu.set(i, {0, 0, 0}), s.dndv.set(i, {0, 0, 0});
    set_footprint(i, 0, 0, 0, 0);
  }

  /// The change of (u, v) from one sample to the next in x and y, with p = (u, v, 0).
  void set_footprint(int i, float dudx, float dvdx, float dudy, float dvdy) {
    if (!s.dudx) return;
    s.dudx[i] = dudx, s.dvdx[i] = dvdx, s.dudy[i] = dudy, s.dvdy[i] = dvdy;
    s.dpdx.set(i, {dudx, dvdx, 0}), s.dpdy.set(i, {dudy, dvdy, 0});
  }

  /// Random points in general position.
  void randomise(unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<float> x;
    const auto vec = [&] { return Vec3f(x(random), x(random), x(random)); };
    for (int i = 0; i < s.n; ++i) {
      s.p.set(i, vec() * 3.0f), s.u[i] = 2 * x(random), s.v[i] = 2 * x(random);
      const Vec3f n = normalize(vec()), t = normalize(cross(n, vec()));
      s.ns.set(i, n), s.dpdu.set(i, t * 2.0f), s.dpdv.set(i, cross(n, t) + t * 0.3f);
      s.ng.set(i, face_forward(normalize(n + vec() * 0.1f), n));
      s.wo.set(i, normalize(vec())), s.dndu.set(i, vec()), s.dndv.set(i, vec());
      if (!s.dudx) continue;
      s.dudx[i] = 0.2f * x(random), s.dvdx[i] = 0.2f * x(random);
      s.dudy[i] = 0.2f * x(random), s.dvdy[i] = 0.2f * x(random);
      s.dpdx.set(i, vec() * 0.1f), s.dpdy.set(i, vec() * 0.1f);
    }
  }

  Arena arena;
  ShadingBatch s;
};

}  // namespace whit::test
