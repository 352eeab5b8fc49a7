#include "core/check/view_rays.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/render/flush_denormals.h"
#include "core/render/trace.h"

namespace whit {
namespace {

/// Calls f(n, x, y) for at most kBatch pixels at a time. Returns how many there were.
template <class F>
int for_pixels(const Vec2i& size, int most, const F& f) {
  const double every = std::max(1.0, std::sqrt(static_cast<double>(size.x) * size.y / most));
  std::vector<int32_t> x, y;
  int count = 0;
  const auto flush = [&] {
    const int n = static_cast<int>(x.size());
    count += n;
    const bool on = n == 0 || f(n, x.data(), y.data());
    x.clear(), y.clear();
    return on;
  };
  for (double row = 0.5 * every; row < size.y; row += every) {
    for (double column = 0.5 * every; column < size.x; column += every) {
      x.push_back(static_cast<int32_t>(column)), y.push_back(static_cast<int32_t>(row));
      if (x.size() == static_cast<size_t>(kBatch) && !flush()) return count;
    }
  }
  flush();
  return count;
}

}  // namespace

int for_view_rays(const Scene& scene, int most, const std::function<bool(Worker&, const Rays&, const Points&)>& look) {
  const FlushDenormals flush;
  Worker worker(scene, false);
  const std::vector<uint32_t> first(kBatch, 0);
  return for_pixels(scene.film().resolution(), most, [&](int n, const int32_t* x, const int32_t* y) {
    const ArenaScope scope(worker.arena);
    generate_camera_rays(worker, n, x, y, first.data());
    Rays rays = worker.level(0).rays();
    Tracer tracer(worker);
    const Hits hits = tracer.intersect(rays);
    const Points points = tracer.surfaces(rays, hits, Transport::Which::All);
    const bool on = look(worker, rays, points);
    tracer.finish();
    worker.leave(0);
    return on;
  });
}

bool view_has_light(const Scene& scene, int most) {
  const FlushDenormals flush;
  Worker worker(scene, false);
  const std::vector<uint32_t> first(kBatch, 0);
  bool lit = false;
  for_pixels(scene.film().resolution(), most, [&](int n, const int32_t* x, const int32_t* y) {
    const ArenaScope scope(worker.arena);
    generate_camera_rays(worker, n, x, y, first.data());
    trace_chunk(worker);
    for (int i = 0; i < n && !lit; ++i) {
      const RGB l = worker.chunk.radiance[i];
      lit = !(l.x == 0 && l.y == 0 && l.z == 0);
    }
    return !lit;
  });
  return lit;
}

Meeting first_met(const Scene& scene, const Vec3f& o, const Vec3f& d, float t_max) {
  Vec3f origin = o, direction = d;
  const auto lanes = [](Vec3f& v) { return Vec3Lanes{&v.x, &v.y, &v.z}; };
  float t = 0, u = 0, v = 0;
  int32_t shape = -1, instance = -1;
  uint32_t prim = 0;
  scene.accel->intersect({1, lanes(origin), lanes(direction), &t_max, nullptr}, {&t, &shape, &prim, &instance, &u, &v},
                         false);
  return {shape, t};
}

}  // namespace whit
