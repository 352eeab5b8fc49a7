#include "core/render/look.h"

#include <cmath>
#include <limits>

#include "core/scene/motion.h"

namespace whit {
namespace {

/// Surfaces without a material that a ray passes at most: enough for any scene, few enough for a ray that is caught.
constexpr int kMostPassed = 64;

struct OneRay {
  Vec3f o{0, 0, 0}, d{0, 0, 1};
  float weight = 0;
};

Vec3Lanes lanes(Vec3f& v) { return {&v.x, &v.y, &v.z}; }

/// In camera space.
OneRay camera_ray(const Camera& camera, Vec2d film) {
  const float x = static_cast<float>(film.x), y = static_cast<float>(film.y), middle = 0.5f;
  OneRay ray;
  CameraRays rays;
  rays.n = 1;
  rays.film_x = &x, rays.film_y = &y;
  if (camera.needs_lens()) rays.lens_u = &middle, rays.lens_v = &middle;
  rays.o = lanes(ray.o), rays.d = lanes(ray.d);
  rays.weight = &ray.weight;
  camera.generate(rays);
  return ray;
}

}  // namespace

LookedAt look_at_film(const Scene& scene, Vec2d film) {
  const OneRay ray = camera_ray(scene.camera(), film);
  const Mat4d camera_to_render = interpolate_keys(scene.camera_keys, 0);
  const Vec3d start = transform_point(camera_to_render, Vec3d(ray.o));
  const Vec3d d = transform_vector(camera_to_render, Vec3d(ray.d)).normalized();
  LookedAt seen;
  if (!(ray.weight > 0)) return seen;
  double gone = 0;
  for (int passed = 0; passed < kMostPassed; ++passed) {
    Vec3f o(start + d * gone), direction(d);
    float t = std::numeric_limits<float>::infinity(), u = 0, v = 0, time = 0;
    int32_t shape = -1, instance = -1;
    uint32_t primitive = 0;
    RayLanes rays;
    rays.n = 1;
    rays.o = lanes(o), rays.d = lanes(direction), rays.time = &time;
    scene.accel->intersect(rays, {&t, &shape, &primitive, &instance, &u, &v}, true);
    if (shape < 0) return seen;
    gone += static_cast<double>(t);
    if (scene.shapes[static_cast<size_t>(shape)].passes_through) {
      gone += 1e-5 * (1 + gone);
      continue;
    }
    seen.shape = shape, seen.primitive = primitive, seen.instance = instance;
    const Vec3d hit = start + d * gone;
    seen.point = transform_point(scene.space.to_world(), hit);
    seen.distance = gone / scene.space.scale;
    seen.depth = transform_point(camera_to_render.gjInverse(), hit).z;
    return seen;
  }
  return seen;
}

}  // namespace whit
