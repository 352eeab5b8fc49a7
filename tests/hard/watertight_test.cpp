// Case 1: no ray leaves a closed mesh, whatever the mesh's place and size and whichever of Embree's ways traces it.
// Embree sees vertices relative to the camera and scaled to about 100, so the rounding of a mesh that stands far away or
// is tiny happens once, in double, and moves a vertex for all triangles that share it: the mesh stays closed.
#include <fmt/core.h>

#include "tests/hard/hard_case.h"
#include "tests/hard/noisy_sphere.h"
#include "tests/hard/render_text.h"

namespace whit {
namespace {

using namespace test;

enum class Aim { Anywhere, AtEdges, AtVertices };

/// How many rays of each kind of query escaped.
struct Escaped {
  double camera = 0, secondary = 0, shadow = 0;
};

/// Batches of rays from inside the mesh of a built scene.
class RaysFromInside {
 public:
  explicit RaysFromInside(const Scene& scene) : scene_(scene), mesh_(*scene.meshes.at(0)) {
    Box3d box;
    for (size_t i = 0; 3 * i + 3 < mesh_.positions.size(); ++i) {
      box.extendBy(Vec3d(mesh_.position(static_cast<uint32_t>(i))));
    }
    centre_ = box.center(), radius_ = box.size().x / 2;
  }

  /// Traces n rays with the hint of coherence and without, and as shadow rays.
  Escaped trace(Aim aim, int n) {
    Escaped escaped;
    for (int left = n; left > 0; left -= kBatch) {
      aim_rays(aim);
      const RayLanes rays{kBatch, {o_[0], o_[1], o_[2]}, {d_[0], d_[1], d_[2]}, nullptr, nullptr};
      for (const bool coherent : {true, false}) {
        scene_.accel->intersect(rays, {t_, shape_, prim_, instance_, u_, v_}, coherent);
        for (const int32_t shape : shape_) (coherent ? escaped.camera : escaped.secondary) += shape < 0;
      }
      scene_.accel->occluded(rays, blocked_);
      for (const uint8_t blocked : blocked_) escaped.shadow += blocked == 0;
    }
    return escaped;
  }

 private:
  static constexpr int kBatch = 1000;

  void aim_rays(Aim aim) {
    for (int i = 0; i < kBatch; ++i) {
      // From within half the radius, where everything is in sight.
      const Vec3f o(centre_ + numbers_.direction() * (0.5 * radius_ * numbers_()));
      const Vec3f d(aim == Aim::Anywhere ? numbers_.direction() : (target(aim) - Vec3d(o)).normalized());
      for (int c = 0; c < 3; ++c) o_[c][i] = o[c], d_[c][i] = d[c];
    }
  }

  /// A vertex, or a point of an edge, not so near to its ends that the ray, rounded, is one aimed at a vertex.
  Vec3d target(Aim aim) {
    const size_t triangle = static_cast<size_t>(numbers_() * static_cast<double>(mesh_.triangle_count()));
    const size_t corner = static_cast<size_t>(3 * numbers_());
    const auto at = [&](size_t k) { return Vec3d(mesh_.position(mesh_.indices[3 * triangle + k % 3])); };
    const Vec3d a = at(corner), b = at(corner + 1);
    if (aim == Aim::AtVertices) return a;
    return a + (b - a) * numbers_.between(0.01, 0.99);
  }

  const Scene& scene_;
  const Mesh& mesh_;
  Vec3d centre_;
  double radius_ = 0;
  Numbers numbers_;
  float o_[3][kBatch], d_[3][kBatch], t_[kBatch], u_[kBatch], v_[kBatch];
  int32_t shape_[kBatch], instance_[kBatch];
  uint32_t prim_[kBatch];
  uint8_t blocked_[kBatch];
};

struct Place {
  const char* name;
  Vec3d centre;
  double radius;
};
const Place kPlaces[] = {
    {"at the origin", Vec3d(0), 1}, {"at 1e6", Vec3d(1e6, -2e6, 1e6), 1}, {"tiny", Vec3d(0), 1e-12}};

std::string sphere_scene(const Place& at) {
  const Vec3d& c = at.centre;
  return fmt::format(
             "Sampler \"stratified\" \"bool jitter\" \"false\"\n"
             "Translate {:.17g} {:.17g} {:.17g}\nCamera \"perspective\"\nWorldBegin\n",
             -c.x, -c.y, -c.z) +
         NoisySphere(70, c, at.radius).text() + "WorldEnd\n";
}

TEST(Hard, ClosedMeshes) {
  HardCase random({1, "closed noisy sphere, rays from inside", "1e7 rays: at the origin, moved to 1e6, of size 1e-12",
                   "rays that escape", 0, ""});
  HardCase edges({1, "the same, aimed at edges", "1e7 rays: as above", "rays that escape", 0, ""});
  // The camera's rays get a second look (core/accel/second_look.h), because samples without jitter can be aimed at
  // vertices; the rest are as Embree traces them.
  HardCase vertices({1, "the same, aimed at vertices", "1e6 camera rays", "rays that escape", 0, ""});
  HardCase others(
      {1, "the same, mirrored or shadow rays aimed at vertices", "2e6 rays", "share that escapes", 0.02, ""});
  for (const Place& place : kPlaces) {
    const BuiltScene built(sphere_scene(place));
    RaysFromInside rays(*built.scene);
    for (const Aim aim : {Aim::Anywhere, Aim::AtEdges}) {
      const Escaped e = rays.trace(aim, 1112000);  // 3 places, 3 kinds of queries
      (aim == Aim::Anywhere ? random : edges).see(e.camera + e.secondary + e.shadow, place.name);
    }
    const int n = 334000;
    const Escaped e = rays.trace(Aim::AtVertices, n);
    vertices.see(e.camera, place.name);
    others.see(std::max(e.secondary, e.shadow) / n, place.name);
  }
}

/// A wall whose vertices all lie exactly in the middle of pixels, at depths that differ by up to six times the distance
/// of vertices: each pixel of the picture sees a vertex, and what is behind is seen through none of them.
std::string wall_of_vertices(int pixels) {
  // The perspective camera with a field of view of 90 degrees sees x / z and y / z in [-1, 1]. Beyond the picture's rim
  // the grid goes on by one.
  Numbers u(3);
  std::string points, indices;
  const int side = pixels + 2;
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const double z = u.between(4, 4.1), at = 2.0 / pixels;
      points += fmt::format("{:.17g} {:.17g} {:.17g} ", (at * (x - 0.5) - 1) * z, (at * (y - 0.5) - 1) * z, z);
      if (x == 0 || y == 0) continue;
      const int d = y * side + x, c = d - 1, b = d - side, a = b - 1;
      indices += fmt::format("{} {} {} {} {} {} ", a, b, d, a, d, c);
    }
  }
  return "Shape \"trianglemesh\" \"integer indices\" [" + indices + "] \"point P\" [" + points + "]\n";
}

TEST(Hard, PixelsAtVertices) {
  // The wall is black, and all light is behind it: every pixel is exactly 0.
  HardCase worst({1, "picture of a black wall whose vertices are its pixels' centres",
                  "251001 pixels, before a sky and before a shape that glows", "brightest pixel", 0, ""});
  const std::string head =
      "Film \"image\" \"integer xresolution\" 501 \"integer yresolution\" 501\n"
      "Sampler \"stratified\" \"integer xsamples\" 1 \"integer ysamples\" 1 \"bool jitter\" \"false\"\n"
      "PixelFilter \"box\"\nCamera \"perspective\" \"float fov\" 90\nWorldBegin\n"
      "Material \"matte\" \"rgb Kd\" [0 0 0]\n" +
      wall_of_vertices(501);
  const std::string sky = "LightSource \"infinite\" \"rgb L\" [1 1 1]\n";
  const std::string glow =
      "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] Translate 0 0 9\n"
      "ReverseOrientation Shape \"disk\" \"float radius\" 99\n";
  for (const std::string& behind : {sky, glow}) {
    const Rendered picture(head + behind + "WorldEnd\n");
    for (const float v : picture.rgb()) worst.see(static_cast<double>(v), behind);
  }
}

}  // namespace
}  // namespace whit
