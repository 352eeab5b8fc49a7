#include "core/plugin/camera.h"

#include <algorithm>

namespace whit {

void Camera::generate_neighbours(const CameraRays& rays, int axis, const Vec3Lanes& o, const Vec3Lanes& d) const {
  constexpr int kBlock = 256;
  alignas(64) float shifted[kBlock], weight[kBlock];
  const float* const positions = axis == 0 ? rays.film_x : rays.film_y;
  for (int first = 0; first < rays.n; first += kBlock) {
    CameraRays next;
    next.n = std::min(kBlock, rays.n - first);
    for_lanes(next.n, [&](int i) { shifted[i] = positions[first + i] + 1; });
    next.film_x = axis == 0 ? shifted : rays.film_x + first;
    next.film_y = axis == 0 ? rays.film_y + first : shifted;
    if (rays.lens_u) next.lens_u = rays.lens_u + first, next.lens_v = rays.lens_v + first;
    next.o = o.from(first), next.d = d.from(first), next.weight = weight;
    generate(next);
  }
}

}  // namespace whit
