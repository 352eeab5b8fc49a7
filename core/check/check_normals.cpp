// Meshes whose normals and winding say different things of which side is the front.

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "core/base/fastmath.h"
#include "core/check/findings.h"

namespace whit {
namespace {

double determinant(const Mat4d& m) {
  return Vec3d(m[0][0], m[0][1], m[0][2]).cross(Vec3d(m[1][0], m[1][1], m[1][2])).dot(Vec3d(m[2][0], m[2][1], m[2][2]));
}

/// The mean cosine between the normals of a mesh and those by winding.
double agreement(const Mesh& mesh) {
  double sum = 0, count = 0;
  for (size_t t = 0; t < mesh.triangle_count(); ++t) {
    const uint32_t* c = mesh.corners(static_cast<uint32_t>(t));
    const Vec3f a = mesh.position(c[0]);
    const Vec3d face(cross(mesh.position(c[1]) - a, mesh.position(c[2]) - a));
    const Vec3d normal(mesh.normal(c[0]) + mesh.normal(c[1]) + mesh.normal(c[2]));
    const double size = face.length() * normal.length();
    if (!(size > 0)) continue;
    sum += face.dot(normal) / size, count += 1;
  }
  return count > 0 ? sum / count : 0;
}

}  // namespace

void check_normals(const Scene& scene, Findings& found) {
  const auto has_normals = [](const SceneShape& shape) { return shape.mesh && !shape.mesh->normals.empty(); };
  if (std::none_of(scene.shapes.begin(), scene.shapes.end(), has_normals)) return;
  const SceneDescription& d = *scene.bound.description;
  std::map<std::pair<uint32_t, uint64_t>, double> handedness;
  for (const ShapeDescription& s : d.shapes) {
    if (s.plugin == "trianglemesh" || s.plugin == "plymesh")
      handedness[{s.where.file, s.where.offset}] = determinant(d.transforms[static_cast<size_t>(s.transform)].start);
  }
  size_t count = 0;
  for (const SceneShape& shape : scene.shapes) {
    if (!has_normals(shape)) continue;
    const auto statement = handedness.find({shape.where.file, shape.where.offset});
    if (statement == handedness.end()) continue;
    // A transform that mirrors turns the order of corners around, and leaves normals on their side.
    const double mean = agreement(*shape.mesh) * (statement->second < 0 ? -1 : 1);
    if (mean >= 0 || count++ >= kMostAlike) continue;
    found.add("normals-against-winding", shape.where, "the normals of this mesh point against the order of its corners",
              "its front is where the normals point; corners should be counter-clockwise seen from there");
    handedness.erase(statement);  // Once, where a statement makes several meshes.
  }
}

}  // namespace whit
