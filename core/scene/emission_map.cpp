#include "core/scene/emission_map.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <array>
#include <cmath>

#include "core/scene/texture_points.h"

namespace whit {
namespace {

constexpr int kSide = 4, kPoints = kSide * kSide;

/// The middles of the kPoints triangles that a triangle is cut into along lines parallel to its sides: weights of its
/// second and third corner.
std::array<Vec2f, kPoints> parts_of_triangle() {
  std::array<Vec2f, kPoints> middles;
  size_t n = 0;
  for (int i = 0; i < kSide; ++i) {
    for (int j = 0; i + j < kSide; ++j) {
      const auto middle = [&](float third) {
        return Vec2f((static_cast<float>(i) + third) / kSide, (static_cast<float>(j) + third) / kSide);
      };
      middles[n++] = middle(1 / 3.0f);
      if (i + j < kSide - 1) middles[n++] = middle(2 / 3.0f);
    }
  }
  return middles;
}

/// Footprints for points of a triangle: its sides, as long as those of a part.
void add_footprints(const Mesh& mesh, uint32_t prim, ShadingBatch& s) {
  Arena& arena = *s.arena;
  const ShadingBatch corners = texture_points(&mesh, 3, arena);
  for (int k = 0; k < 3; ++k) {
    corners.p.set(k, Vec3f(mesh.corner(prim, static_cast<size_t>(k))));
    set_triangle_point(mesh, prim, k == 1 ? 1.0f : 0.0f, k == 2 ? 1.0f : 0.0f, corners, k);
  }
  const auto side = [&](const float* of_corner, int k) {
    float* const step = arena.floats(s.n);
    for (int i = 0; i < s.n; ++i) step[i] = (of_corner[k] - of_corner[0]) / kSide;
    return step;
  };
  s.dudx = side(corners.u, 1), s.dvdx = side(corners.v, 1), s.dudy = side(corners.u, 2), s.dvdy = side(corners.v, 2);
  s.dpdx = {side(corners.p.x, 1), side(corners.p.y, 1), side(corners.p.z, 1)};
  s.dpdy = {side(corners.p.x, 2), side(corners.p.y, 2), side(corners.p.z, 2)};
  if (!s.u1) return;
  s.du1dx = side(corners.u1, 1), s.dv1dx = side(corners.v1, 1);
  s.du1dy = side(corners.u1, 2), s.dv1dy = side(corners.v1, 2);
}

RGB mean_of(const Tex<RGB>& map, const ShadingBatch& s) {
  const RGBLanes values = emission_values(map, s);
  RGB sum(0.0f);
  for (int i = 0; i < s.n; ++i) sum += values[i];
  return sum / static_cast<float>(s.n);
}

RGB mean_over_triangle(const Mesh& mesh, uint32_t prim, const Tex<RGB>& map, Arena& arena) {
  static const std::array<Vec2f, kPoints> parts = parts_of_triangle();
  const ArenaScope scratch(arena);
  ShadingBatch s = texture_points(&mesh, kPoints, arena);
  const Vec3d a = mesh.corner(prim, 0), ab = mesh.corner(prim, 1) - a, ac = mesh.corner(prim, 2) - a;
  for (int i = 0; i < kPoints; ++i) {
    const Vec2f b = parts[static_cast<size_t>(i)];
    s.p.set(i, Vec3f(a + ab * static_cast<double>(b.x) + ac * static_cast<double>(b.y)));
    set_triangle_point(mesh, prim, b.x, b.y, s, i);
  }
  if (kKnowsDifferentials) add_footprints(mesh, prim, s);
  return mean_of(map, s);
}

RGB mean_over_shape(const AnalyticShape& shape, const Tex<RGB>& map) {
  Arena arena;
  const ShadingBatch s = texture_points(nullptr, kPoints, arena);
  for (int i = 0; i < kPoints; ++i) {
    const ShapeSample at = shape.sample_area((i % kSide + 0.5) / kSide, (i / kSide + 0.5) / kSide);
    const Vec3d p = transform_point(shape.object_to_scene(), at.p);
    s.p.set(i, Vec3f(p));
    set_analytic_point(shape, p, s, i);
  }
  return mean_of(map, s);
}

}  // namespace

RGBLanes emission_values(const Tex<RGB>& map, const ShadingBatch& s) {
  const RGBLanes values = map(s);
  constexpr float kMost = std::numeric_limits<float>::max();
  const auto sound = [](float v) { return std::abs(v) <= kMost ? v : 0.0f; };
  for_lanes(s.n, [&](int i) { values.set(i, {sound(values.r[i]), sound(values.g[i]), sound(values.b[i])}); });
  return values;
}

std::vector<RGB> emission_means(const SceneShape& shape, const Tex<RGB>& map) {
  if (shape.analytic) return {mean_over_shape(*shape.analytic, map)};
  if (!shape.mesh) return {};
  std::vector<RGB> means(shape.mesh->triangle_count());
  tbb::parallel_for(tbb::blocked_range<size_t>(0, means.size(), 64), [&](const tbb::blocked_range<size_t>& range) {
    Arena arena;
    for (size_t t = range.begin(); t < range.end(); ++t)
      means[t] = mean_over_triangle(*shape.mesh, static_cast<uint32_t>(t), map, arena);
  });
  return means;
}

}  // namespace whit
