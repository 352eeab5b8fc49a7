#include "core/check/view_rays.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/box.h"
#include "core/render/flush_denormals.h"
#include "core/render/render.h"
#include "core/render/trace.h"

namespace whit {
namespace {

/// Calls f(n, x, y, index) for at most kBatch samples of pixels at a time: some pixels, or all with several samples each.
/// Returns how many there were.
template <class F>
int for_pixels(const Scene& scene, int most, const F& f) {
  double crop[4];
  scene.film().crop_window(crop);
  const Box2i window = crop_pixels(scene.film().resolution(), crop);
  const Vec2i size = window.max - window.min;
  const double pixels = std::max(1.0, static_cast<double>(size.x) * size.y),
               every = std::max(1.0, std::sqrt(pixels / most));
  const auto samples = static_cast<uint32_t>(std::clamp(most / pixels, 1.0, 256.0));
  std::vector<int32_t> x, y;
  std::vector<uint32_t> index;
  int count = 0;
  const auto flush = [&] {
    const int n = static_cast<int>(x.size());
    count += n;
    const bool on = n == 0 || f(n, x.data(), y.data(), index.data());
    x.clear(), y.clear(), index.clear();
    return on;
  };
  for (double row = 0.5 * every; row < size.y; row += every) {
    for (double column = 0.5 * every; column < size.x; column += every) {
      for (uint32_t k = 0; k < samples; ++k) {
        x.push_back(window.min.x + static_cast<int32_t>(column)), y.push_back(window.min.y + static_cast<int32_t>(row));
        index.push_back(k);
        if (x.size() == static_cast<size_t>(kBatch) && !flush()) return count;
      }
    }
  }
  flush();
  return count;
}

}  // namespace

int for_view_rays(const Scene& scene, int most, const std::function<bool(Worker&, const Rays&, const Points&)>& look) {
  const FlushDenormals flush;
  Worker worker(scene, false);
  return for_pixels(scene, most, [&](int n, const int32_t* x, const int32_t* y, const uint32_t* index) {
    const ArenaScope scope(worker.arena);
    generate_camera_rays(worker, n, x, y, index);
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
  bool lit = false;
  for_pixels(scene, most, [&](int n, const int32_t* x, const int32_t* y, const uint32_t* index) {
    const ArenaScope scope(worker.arena);
    generate_camera_rays(worker, n, x, y, index);
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

Box3d box_of(const SceneShape& shape) {
  Box3d box;
  if (shape.mesh) {
    for (size_t i = 0; i + 2 < shape.mesh->positions.size(); i += 3)
      box.extendBy(Vec3d(shape.mesh->positions[i], shape.mesh->positions[i + 1], shape.mesh->positions[i + 2]));
    for (const ExactTriangle& t : shape.mesh->exact) box.extendBy(t.a), box.extendBy(t.b), box.extendBy(t.c);
  } else if (shape.analytic) {
    return transform_box(shape.analytic->object_to_scene(), shape.analytic->object_bounds());
  } else if (shape.curves) {
    Box3d local;
    const auto& p = shape.curves->control_points;
    for (size_t i = 0; i + 3 < p.size(); i += 4) {
      const Vec3d middle(p[i], p[i + 1], p[i + 2]), half(static_cast<double>(p[i + 3]));
      local.extendBy(middle - half), local.extendBy(middle + half);
    }
    return transform_box(shape.curves->to_group, local);
  }
  return box;
}

}  // namespace whit
