// What the camera sees: nothing, or only the inside of something; and what stands outside of its view.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/box.h"
#include "core/base/fastmath.h"
#include "core/check/findings.h"
#include "core/check/view_rays.h"

namespace whit {
namespace {

constexpr int kCoarse = 4096, kDense = 1 << 20;

SourcePos camera_place(const Scene& scene) {
  const Entity& camera = scene.bound.description->camera;
  return camera.where.known() ? camera.where : scene.bound.description->world_begin;
}

/// How many of the rays meet something, and how many of these from behind.
struct Met {
  int64_t rays = 0, hits = 0, backs = 0;
};
Met look_around(const Scene& scene, int most, bool until_hit) {
  Met met;
  met.rays = for_view_rays(scene, most, [&](Worker&, const Rays&, const Points& points) {
    met.hits += points.n;
    for (int i = 0; i < points.n; ++i) met.backs += dot(points.at.wo[i], points.at.ng[i]) < 0;
    return !until_hit || met.hits == 0;
  });
  return met;
}

/// Whether there is something in all directions from where the camera is, and not in those of its view alone.
bool is_enclosed(const Scene& scene) {
  if (scene.camera_keys.size() != 1) return false;
  const Vec3f eye(transform_point(scene.camera_keys.front(), Vec3d(0, 0, 0)));
  constexpr int kDirections = 512;
  for (int i = 0; i < kDirections; ++i) {
    // The points of a spiral from pole to pole.
    const double z = 1 - (2 * i + 1.0) / kDirections, r = std::sqrt(1 - z * z), angle = 2.399963229728653 * i;
    const Vec3f d(static_cast<float>(r * std::cos(angle)), static_cast<float>(r * std::sin(angle)),
                  static_cast<float>(z));
    if (first_met(scene, eye, d, std::numeric_limits<float>::infinity()).shape < 0) return false;
  }
  return true;
}

/// Whether all corners of a box are beyond one and the same side of the view.
bool is_outside(const Box3d& box, const Mat4d& to_clip) {
  if (box.isEmpty()) return false;
  std::array<int, 5> beyond{};
  for (const Vec3d& p : corners_of(box)) {
    double c[4];
    for (int k = 0; k < 4; ++k) c[k] = p.x * to_clip[0][k] + p.y * to_clip[1][k] + p.z * to_clip[2][k] + to_clip[3][k];
    beyond[0] += c[0]<0, beyond[1] += c[0]> c[3], beyond[2] += c[1]<0, beyond[3] += c[1]> c[3];
    beyond[4] += c[3] <= 0;
  }
  return std::find(beyond.begin(), beyond.end(), 8) != beyond.end();
}

/// The placed instances of each object, or nothing where it is not plain which is which: something moves or is left out.
std::optional<std::map<int, std::vector<Mat4d>>> placements(const Scene& scene) {
  const SceneDescription& d = *scene.bound.description;
  std::map<int, std::vector<Mat4d>> all;
  size_t k = 0;
  for (const InstanceDescription& instance : d.instances) {
    if (d.is_singular(instance.transform)) continue;
    if (k == scene.instances.size() || scene.instances[k].key_count != 1) return std::nullopt;
    all[instance.object].push_back(scene.keys_of(scene.instances[k++]).front());
  }
  if (k != scene.instances.size()) return std::nullopt;
  return all;
}

void check_outside(const Scene& scene, Findings& found) {
  const SceneDescription& d = *scene.bound.description;
  const std::optional<Mat4d> to_ndc = scene.camera().to_ndc();
  if (!to_ndc || scene.camera_keys.size() != 1 || scene.camera().needs_lens()) return;
  const auto placed = placements(scene);
  if (!placed) return;
  const Mat4d to_clip = scene.camera_keys.front().inverse() * *to_ndc;
  std::map<std::pair<uint32_t, uint64_t>, const ShapeDescription*> statements;
  for (const ShapeDescription& s : d.shapes) statements[{s.where.file, s.where.offset}] = &s;
  std::map<std::pair<uint32_t, uint64_t>, bool> outside;  // A statement may make several shapes.
  for (const SceneShape& shape : scene.shapes) {
    const std::pair<uint32_t, uint64_t> key{shape.where.file, shape.where.offset};
    const auto statement = statements.find(key);
    if (statement == statements.end()) continue;
    const Box3d box = box_of(shape);
    bool out = true;
    if (statement->second->object < 0) {
      out = is_outside(box, to_clip);
    } else if (const auto at = placed->find(statement->second->object); at != placed->end()) {
      for (const Mat4d& m : at->second) out = out && is_outside(box, m * to_clip);
    }
    const auto [slot, fresh] = outside.try_emplace(key, out);
    if (!fresh) slot->second = slot->second && out;
  }
  size_t count = 0;
  for (const auto& [key, out] : outside) {
    if (!out || count++ >= kMostAlike) continue;
    const ShapeDescription& s = *statements[key];
    found.add("outside-view", s.where, s.plugin + " is outside of the view",
              "it can be seen in mirrors and cast shadows, no more");
  }
}

}  // namespace

void check_view(const Scene& scene, Findings& found) {
  const SourcePos camera = camera_place(scene);
  const Met coarse = look_around(scene, kCoarse, false);
  if (coarse.hits == 0) {
    // Thin things may stand between the rays.
    const Met dense = look_around(scene, kDense, true);
    if (dense.hits == 0 && scene.environments.empty()) {
      found.add("empty-view", camera,
                "the camera sees nothing: none of " + std::to_string(dense.rays) + " rays meets a surface",
                "it looks along +z of the space that LookAt and the transforms before Camera make");
    }
  } else if (coarse.hits == coarse.rays && coarse.backs == coarse.hits && is_enclosed(scene) &&
             !view_has_light(scene, kCoarse)) {
    found.add("camera-inside", camera,
              "the camera is inside of something: all it sees are back sides, where no light comes");
  }
  if (found.wants("outside-view")) check_outside(scene, found);
}

}  // namespace whit
