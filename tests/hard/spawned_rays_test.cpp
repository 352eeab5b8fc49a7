// Case 3: a ray that leaves a surface does not meet the point that it leaves, and meets what stands next to it. Points
// of every shape at scales 1e-8 .. 1e8, sheared and mirrored, are found as the renderer finds them, and rays leave them
// by offset_origin() to the side that the surface curves away from. Beside the shape stands a copy of it that is larger
// or, for the disk and the triangle, moved by 4e-6 of its size: that is what they must meet.
#include <fmt/core.h>

#include "core/render/surface.h"
#include "tests/hard/hard_case.h"
#include "tests/plugins/shape_support.h"
#include "tests/scene/scene_text.h"

namespace whit {
namespace {

using namespace test;
using shape_test::Numbers;

struct Neighbours {
  const char* name;
  const char* shape;
  const char* to_copy;  ///< Where the copy stands, as a statement.
};

// Around a cone with its tip at z = 1 a cone of the same slope, 4e-6 higher, is nearer than that; the paraboloid's copy
// lies outside of it by being lower.
const Neighbours kShapes[] = {
    {"sphere", "Shape \"sphere\"", "Scale 1.000004 1.000004 1.000004"},
    {"cylinder", "Shape \"cylinder\"", "Scale 1.000004 1.000004 1"},
    {"cone", "Shape \"cone\"", "Translate 0 0 0.000006"},
    {"paraboloid", "Shape \"paraboloid\"", "Translate 0 0 -0.00001"},
    {"hyperboloid", "Shape \"hyperboloid\" \"point p1\" [1 0 -1] \"point p2\" [0 1 1]", "Scale 1.000004 1.000004 1"},
    {"disk", "Shape \"disk\"", "Translate 0 0 0.000004"},
    {"triangle", "Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point P\" [-1 -1 0  1 -1 0  0 1 0]",
     "Translate 0 0 0.000004"},
};

/// What rays see that come from the shape's inside and go on from where they meet it.
class Spawned {
 public:
  static constexpr int kRays = 2000;

  explicit Spawned(const Scene& scene) : scene_(scene) {
    h_.n = kRays;
    h_.o = arena_.vec3(kRays), h_.d = arena_.vec3(kRays);
    h_.t = arena_.floats(kRays), h_.u = arena_.floats(kRays), h_.v = arena_.floats(kRays);
    h_.shape = arena_.alloc<int32_t>(kRays), h_.instance = arena_.alloc<int32_t>(kRays);
    h_.prim = arena_.alloc<uint32_t>(kRays);
  }

  /// Rays from `from` to points near the origin's plane z = 0, world space; they meet shape 0 first.
  void trace(const Mat4d& object_to_world, const Vec3d& from, const Vec3d& spread) {
    const Mat4d m = object_to_world * scene_.space.from_world();
    for (int i = 0; i < kRays; ++i) {
      const Vec3d o = transform_point(m, from);
      const Vec3d to(spread.x * u_.between(-1, 1), spread.y * u_.between(-1, 1), spread.z * u_.between(-1, 1));
      h_.o.set(i, Vec3f(o)), h_.d.set(i, Vec3f((transform_point(m, to) - o).normalized()));
    }
    intersect();
  }
  void intersect() {
    scene_.accel->intersect({kRays, h_.o, h_.d, nullptr, nullptr}, {h_.t, h_.shape, h_.prim, h_.instance, h_.u, h_.v},
                            false);
  }
  SurfaceHits& hits() { return h_; }
  Arena& arena() { return arena_; }

 private:
  const Scene& scene_;
  Arena arena_;
  SurfaceHits h_;
  Numbers u_;
};

/// Object to world: scaled, sheared and perhaps mirrored, and the statement that says so.
Mat4d placement(double scale, bool sheared, bool mirrored) {
  Mat4d m;
  if (sheared) m[1][0] = 0.7, m[2][1] = -0.4;
  return m * Mat4d().setScale(Vec3d(mirrored ? -scale : scale, scale, scale));
}
std::string text_of(const Mat4d& m) {
  std::string s = "ConcatTransform [";
  for (int r = 0; r < 4; ++r) {
    for (int c = 0; c < 4; ++c) s += fmt::format("{:.17g} ", m[r][c]);
  }
  return s + "]\n";
}

/// The share of rays that meet the shape they leave, and of those that miss the copy.
void check(const Neighbours& n, const Mat4d& m, HardCase& self, HardCase& neighbour, const std::string& at) {
  // The camera stands at the shape, as far away as it is large.
  const Vec3d eye = transform_point(m, {0.3, -2, 0.4});
  const BuiltScene built(
      fmt::format("Translate {:.17g} {:.17g} {:.17g} Camera \"perspective\" WorldBegin\n", -eye.x, -eye.y, -eye.z) +
      text_of(m) + n.shape + "\nAttributeBegin " + n.to_copy + "\n" + n.shape + "\nAttributeEnd WorldEnd\n");
  Spawned rays(*built.scene);
  const bool flat = std::string(n.name) == "disk" || std::string(n.name) == "triangle";
  // From below a flat shape, or from the inside of a round one.
  rays.trace(m, flat ? Vec3d(0.1, 0.2, -1) : Vec3d(0.02, 0.01, 0.45), flat ? Vec3d(0.3, 0.3, 0) : Vec3d(1, 1, 0.3));
  SurfaceHits& h = rays.hits();
  int first = 0;
  std::vector<bool> met(Spawned::kRays);
  for (int i = 0; i < Spawned::kRays; ++i) met[static_cast<size_t>(i)] = h.shape[i] == 0, first += h.shape[i] == 0;
  ASSERT_GT(first, Spawned::kRays / 4) << n.name << at;
  for (int i = 0; i < Spawned::kRays; ++i) {
    if (!met[static_cast<size_t>(i)]) h.shape[i] = 0, h.prim[i] = 0, h.t[i] = 1, h.u[i] = h.v[i] = 0;  // not looked at
  }
  const ShadingBatch s = compute_surfaces(*built.scene, h, rays.arena());
  for (int i = 0; i < Spawned::kRays; ++i) { h.o.set(i, offset_origin(s.p[i], s.p_error[i], s.ng[i], h.d[i])); }
  rays.intersect();
  for (int i = 0; i < Spawned::kRays; ++i) {
    if (!met[static_cast<size_t>(i)]) continue;
    self.see(h.shape[i] == 0, n.name + at);
    neighbour.see(h.shape[i] != 1, n.name + at);
  }
  // To the same side in any direction, down to a cosine of 1e-3: nothing of a shape that is not hollow there is in sight.
  if (std::string(n.name) == "hyperboloid") return;
  Numbers u(5);
  for (int i = 0; i < Spawned::kRays; ++i) {
    const Vec3d ng(s.ng[i]), side = ng * (ng.dot(-Vec3d(s.wo[i])) < 0 ? -1 : 1), any = u.direction();
    const Vec3f w(((any - ng * ng.dot(any)).normalized() + side * std::pow(10, u.between(-3, 1))).normalized());
    h.d.set(i, w);
    h.o.set(i, offset_origin(s.p[i], s.p_error[i], s.ng[i], w));
  }
  rays.intersect();
  for (int i = 0; i < Spawned::kRays; ++i) {
    if (met[static_cast<size_t>(i)]) self.see(h.shape[i] == 0, n.name + at + ", any direction");
  }
}

TEST(Hard, SpawnedRays) {
  HardCase self({3, "rays spawned from seven shapes meet the shape they leave", "scales 1e-8 to 1e8, sheared, mirrored",
                 "rays that do", 0, ""});
  HardCase neighbour({3, "rays spawned from seven shapes miss a neighbour", "the same; a gap of 4e-6 of the size",
                      "rays that do", 0, ""});
  for (const Neighbours& n : kShapes) {
    for (int power = -8; power <= 8; power += 2) {
      for (const bool sheared : {false, true}) {
        for (const bool mirrored : {false, true}) {
          check(n, placement(std::pow(10, power), sheared, mirrored), self, neighbour,
                fmt::format(" at 1e{}{}{}", power, sheared ? " sheared" : "", mirrored ? " mirrored" : ""));
        }
      }
    }
  }
}

}  // namespace
}  // namespace whit
