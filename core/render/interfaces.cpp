// Surfaces without a material, which rays pass.

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/fastmath.h"
#include "core/batch/fields.h"
#include "core/render/surface.h"
#include "core/render/tracer.h"

namespace whit {
namespace {

/// Rays pass through so many interfaces, and are so often moved by no more than the error of their origin, before they are
/// taken to have stopped: nobody stacks as many shells, and a few coincident ones are passed in as many short steps.
constexpr int kMostPasses = 10000, kMostShortSteps = 64;

/// Whether a ray got ahead by less than a few units in the last place of where it is. NaN is no way ahead.
bool is_short_step(const Vec3f& from, const Vec3f& to, const Vec3f& d) {
  const float error = 5e-7f * std::max({std::abs(to.x), std::abs(to.y), std::abs(to.z)});
  return !(dot(to - from, d) > error);
}

/// Copies what changes, so that it can be written to.
void own_origins(Rays& rays, Arena& arena) {
  const Vec3Lanes o = arena.vec3(rays.n);
  for_lanes(rays.n, [&](int i) { o.set(i, rays.o[i]); });
  rays.o = o;
  if (rays.pdf) rays.pdf = std::copy_n(rays.pdf, rays.n, arena.floats(rays.n)) - rays.n;
  if (!rays.differentials) return;
  const RayDifferentials own = allocate_like(rays.differentials, rays.n, arena);
  copy_lanes(rays.differentials, rays.n, own);
  rays.differentials = own;
}

/// Moves a ray's origin; what its neighbours would meet is not known from here on. Interfaces stop shadow rays, as in
/// pbrt-v3, so light that a sampled direction finds behind one counts as little: its density becomes 0.
void move_origin(const Rays& rays, int ray, const Vec3f& o) {
  rays.o.set(ray, o);
  if (rays.pdf && rays.pdf[ray] < std::numeric_limits<float>::infinity()) rays.pdf[ray] = 0;
  const RayDifferentials& d = rays.differentials;
  if (!d) return;
  d.rx_o.set(ray, o), d.ry_o.set(ray, o);
  d.rx_d.set(ray, kNoDifferential), d.ry_d.set(ray, kNoDifferential);
}

}  // namespace

Passed pass_through_interfaces(const Scene& scene, Rays& rays, const Hits& hits, Arena& arena) {
  const auto passes = [&](int i) {
    return hits.shape[i] >= 0 && scene.shapes[static_cast<size_t>(hits.shape[i])].passes_through;
  };
  Passed passed;
  int32_t* lanes = arena.alloc<int32_t>(rays.n);
  int n = 0;
  for (int i = 0; i < rays.n; ++i) {
    if (passes(i)) lanes[n++] = i;
  }
  if (n == 0) return passed;
  own_origins(rays, arena);
  uint8_t* short_steps = arena.alloc<uint8_t>(rays.n);
  std::fill_n(short_steps, rays.n, uint8_t{0});
  for (int pass = 1; n > 0; ++pass) {
    ArenaScope scope(arena);
    Rays from = gathered(rays, lanes, n, arena);
    from.n = n;
    const Hits met = gathered(hits, lanes, n, arena);
    const ShadingBatch surface = compute_surfaces(scene, {from, met}, arena);
    for (int i = 0; i < n; ++i) {
      const Vec3f o = offset_origin(surface.p[i], surface.p_error[i], surface.ng[i], from.d[i]);
      short_steps[lanes[i]] += is_short_step(from.o[i], o, from.d[i]);
      from.o.set(i, o);
      move_origin(rays, lanes[i], o);
    }
    scene.accel->intersect({n, from.o, from.d, nullptr, from.time}, met, false);
    passed.traced += n;
    int left = 0;
    for (int i = 0; i < n; ++i) {
      const int lane = lanes[i];
      hits.t[lane] = met.t[i], hits.shape[lane] = met.shape[i], hits.prim[lane] = met.prim[i];
      hits.instance[lane] = met.instance[i], hits.u[lane] = met.u[i], hits.v[lane] = met.v[i];
      if (!passes(lane)) continue;
      if (pass < kMostPasses && short_steps[lane] < kMostShortSteps) {
        lanes[left++] = lane;
        continue;
      }
      hits.t[lane] = std::numeric_limits<float>::quiet_NaN(), hits.shape[lane] = -1;  // a lost ray
      ++passed.stopped;
    }
    n = left;
  }
  return passed;
}

}  // namespace whit
