// Emitters whose lit side is covered, and lights that shine into nothing: rays from the light tell.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/base/box.h"
#include "core/base/fastmath.h"
#include "core/check/findings.h"
#include "core/check/view_rays.h"
#include "core/plugin/light.h"

namespace whit {
namespace {

/// What is nearer to an emitter than these shares of the scene's size and of its own lies on it.
constexpr float kNear = 0.02f, kNearOfItself = 0.5f;

Vec3f unit(const Vec3f& v) { return v * (1 / std::max(length(v), 1e-30f)); }

/// A point of an emitting shape with the unit normal of its lit side.
struct Place {
  Vec3f p, n;
};

/// Some points of the lit side of a shape, spread over its triangles; none of shapes that are not flat.
std::vector<Place> places_on(const SceneShape& shape) {
  std::vector<Place> out;
  if (shape.mesh && shape.mesh->exact.empty()) {
    const Mesh& mesh = *shape.mesh;
    const size_t count = mesh.triangle_count(), step = std::max<size_t>(1, count / 16);
    for (size_t t = 0; t < count; t += step) {
      const uint32_t* c = mesh.corners(static_cast<uint32_t>(t));
      const Vec3f a = mesh.position(c[0]), b = mesh.position(c[1]), d = mesh.position(c[2]);
      Vec3f n = cross(b - a, d - a);
      if (!mesh.normals.empty()) {
        const Vec3f s = mesh.normal(c[0]) + mesh.normal(c[1]) + mesh.normal(c[2]);
        n = n * (dot(n, s) < 0 ? -1.0f : 1.0f);
      }
      n = unit(n) * (shape.flips ? -1.0f : 1.0f);
      for (const auto& [u, v] : {std::pair{0.33f, 0.33f}, {0.1f, 0.1f}, {0.8f, 0.1f}, {0.1f, 0.8f}})
        out.push_back({a + (b - a) * u + (d - a) * v, n});
    }
  } else if (shape.analytic && shape.analytic->is_planar()) {
    for (int i = 0; i < 16; ++i) {
      const ShapeSample s = shape.analytic->sample_area((i % 4 + 0.5) / 4, (i / 4 + 0.5) / 4);
      const Mat4d& m = shape.analytic->object_to_scene();
      const Vec3f n(transform_vector(shape.analytic->scene_to_object().transposed(), s.n));
      out.push_back({Vec3f(transform_point(m, s.p)), unit(n) * (shape.analytic->flips_normals() ? -1.0f : 1.0f)});
    }
  }
  return out;
}

/// How wide the box around some places is.
float extent_of(const std::vector<Place>& places) {
  Box3d box;
  for (const Place& place : places) box.extendBy(Vec3d(place.p));
  return box.isEmpty() ? 0.0f : static_cast<float>((box.max - box.min).length());
}

/// Whether light goes on where a ray meets a shape: it is seen through, or passed.
bool lets_through(const Scene& scene, int shape) {
  const SceneShape& met = scene.shapes[static_cast<size_t>(shape)];
  return met.passes_through || scene.materials[static_cast<size_t>(met.material)]->effects().has(Effect::Refraction);
}

/// Whether something lies on the lit side at a place: what lies there for all of some directions, else -1.
int cover_of(const Scene& scene, const Place& place, float near) {
  const Vec3f side =
      unit(std::abs(place.n.x) > 0.5f ? Vec3f(-place.n.y, place.n.x, 0) : Vec3f(0, -place.n.z, place.n.y));
  const Vec3f other = cross(place.n, side);
  int cover = -1;
  for (int i = 0; i < 5; ++i) {
    const float angle = 1.5707963f * static_cast<float>(i), tilt = i == 4 ? 0.0f : 0.7f;
    const Vec3f d = unit(place.n + side * (tilt * std::cos(angle)) + other * (tilt * std::sin(angle)));
    const Meeting met = first_met(scene, place.p + place.n * (1e-4f * near), d, near);
    if (met.shape < 0 || lets_through(scene, met.shape)) return -1;
    cover = met.shape;
  }
  return cover;
}

/// The shapes whose lit side some ray of the camera meets.
std::set<int> seen_to_emit(const Scene& scene) {
  std::set<int> seen;
  for_view_rays(scene, 4096, [&](Worker&, const Rays&, const Points& points) {
    for (int i = 0; i < points.n; ++i) {
      const int shape = points.hits.shape[i];
      const bool front = dot(points.at.wo[i], points.at.ng[i]) > 0;
      if (front && scene.shapes[static_cast<size_t>(shape)].emitter >= 0) seen.insert(shape);
    }
    return true;
  });
  return seen;
}

double size_of_scene(const Scene& scene) {
  Box3d box;
  for_view_rays(scene, 1024, [&](Worker&, const Rays&, const Points& points) {
    for (int i = 0; i < points.n; ++i) box.extendBy(Vec3d(points.at.p[i]));
    return true;
  });
  return box.isEmpty() ? 0.0 : (box.max - box.min).length();
}

void check_covered(const Scene& scene, Findings& found) {
  std::set<int> shapes;
  for (const SceneLight& light : scene.lights)
    if (light.shape >= 0 && !light.light->is_two_sided()) shapes.insert(light.shape);
  // Each costs some hundred rays; a world of that many is no room with a lamp turned around.
  constexpr size_t kMost = 1000;
  if (shapes.empty() || shapes.size() > kMost) return;
  const float near_in_scene = kNear * static_cast<float>(size_of_scene(scene));
  const std::set<int> seen = seen_to_emit(scene);
  for (const int index : shapes) {
    const SceneShape& shape = scene.shapes[static_cast<size_t>(index)];
    if (seen.count(index) > 0) continue;
    const std::vector<Place> places = places_on(shape);
    int cover = -1;
    const float near = std::min(near_in_scene, kNearOfItself * extent_of(places));
    const bool covered = near > 0 && !places.empty() && std::all_of(places.begin(), places.end(), [&](const Place& p) {
                           cover = cover_of(scene, p, near);
                           return cover >= 0;
                         });
    if (!covered) continue;
    const SceneShape& wall = scene.shapes[static_cast<size_t>(cover)];
    found.add("covered-emitter", shape.where, "the lit side of this emitter faces a surface close in front of it",
              "a surface emits on the side that its normal points to: ReverseOrientation turns it around, and \"bool "
              "twosided\" lights both",
              wall.where);
  }
}

/// Directions in a cone of light.
std::vector<Vec3f> directions_of(const LightCone& cone, int count) {
  std::vector<Vec3f> out;
  for (int i = 0; i < count; ++i) {
    const double u = (i + 0.5) / count, v = std::fmod(i * 0.6180339887498949, 1.0) * 2 * detail::kPiD;
    const Frame frame = coordinate_system(Vec3f(cone.axis));
    const double c = 1 - u * (1 - cone.cosine), s = std::sqrt(std::max(0.0, 1 - c * c));
    const Vec3f local = frame.s * static_cast<float>(s * std::cos(v)) + frame.t * static_cast<float>(s * std::sin(v)) +
                        Vec3f(cone.axis) * static_cast<float>(c);
    // Back from light space: the rows of the map are not orthogonal where the light is stretched.
    Mat4d to_light;
    for (int k = 0; k < 3; ++k) {
      const Vec3f& row = k == 0 ? cone.x : k == 1 ? cone.y : cone.z;
      to_light[0][k] = row.x, to_light[1][k] = row.y, to_light[2][k] = row.z;
    }
    out.push_back(unit(Vec3f(transform_vector(to_light.gjInverse(), Vec3d(local)))));
  }
  return out;
}

/// Whether a light at a point gives light to any surface that the camera sees, shadows apart.
bool reaches_view(const Scene& scene, const Light& light) {
  bool reached = false;
  for_view_rays(scene, 4096, [&](Worker& worker, const Rays&, const Points& points) {
    if (points.n == 0) return true;
    LightSamples s;
    s.n = points.n, s.arena = &worker.arena, s.p = points.at.p;
    s.wi = worker.arena.vec3(points.n), s.distance = worker.arena.floats(points.n);
    s.radiance = worker.arena.rgb(points.n);
    light.sample(s);
    for (int i = 0; i < points.n && !reached; ++i) {
      const RGB l = s.radiance[i];
      reached = l.x != 0 || l.y != 0 || l.z != 0;
    }
    return !reached;
  });
  return reached;
}

/// Whether it gives light to any of the corners and the middle of a shape's box, where the shape stands in the world.
bool reaches_boxes(const Scene& scene, const Light& light) {
  Arena arena;
  for (const SceneShape& shape : scene.shapes) {
    const Box3d box = box_of(shape);
    if (box.isEmpty()) continue;
    const ArenaScope scope(arena);
    constexpr int kPoints = 9;
    LightSamples s;
    s.n = kPoints, s.arena = &arena, s.p = arena.vec3(kPoints);
    s.wi = arena.vec3(kPoints), s.distance = arena.floats(kPoints), s.radiance = arena.rgb(kPoints);
    const std::array<Vec3d, 8> corners = corners_of(box);
    for (int i = 0; i < kPoints; ++i) s.p.set(i, Vec3f(i < 8 ? corners[static_cast<size_t>(i)] : box.center()));
    light.sample(s);
    for (int i = 0; i < kPoints; ++i) {
      const RGB l = s.radiance[i];
      if (l.x != 0 || l.y != 0 || l.z != 0) return true;
    }
  }
  return false;
}

void check_unreached(const Scene& scene, Findings& found) {
  size_t number = 0;
  std::map<const Light*, SourcePos> statements;
  for (const auto& bound : scene.bound.lights) statements[bound.plugin.get()] = bound.where;
  for (const SceneLight& light : scene.lights) {
    // One without a cone shines everywhere, and small things may stand between the rays.
    if (light.shape >= 0 || !light.light->position() || !light.light->reach().cone) continue;
    if (++number > kMostAlike) return;
    const Vec3f at(*light.light->position());
    const std::vector<Vec3f> directions = directions_of(*light.light->reach().cone, 4096);
    const bool meets = std::any_of(directions.begin(), directions.end(), [&](const Vec3f& d) {
      return first_met(scene, at, d, std::numeric_limits<float>::infinity()).shape >= 0;
    });
    if (meets || reaches_view(scene, *light.light) || reaches_boxes(scene, *light.light)) continue;
    found.add("unreached-light", statements[light.light], "this light shines where nothing is",
              "none of 4096 rays from it meets a surface");
  }
}

}  // namespace

void check_emitters(const Scene& scene, Findings& found) {
  check_covered(scene, found);
  check_unreached(scene, found);
}

}  // namespace whit
