#include "core/scene/alpha.h"

#include <utility>

namespace whit {
namespace {

thread_local int64_t alpha_tests = 0;

/// Evaluates the two alpha textures at one point, without footprint: bilinear at full resolution, as pbrt.
class TexturedAlpha final : public AlphaTest {
 public:
  TexturedAlpha(const SceneShape& geometry, const Shape& shape, const Mat4d& group_to_render)
      : geometry_(geometry), shape_(shape), group_to_render_(group_to_render) {}

  bool cut(uint32_t prim, float u, float v, const Vec3f& p, bool shadow_ray) const override {
    ++alpha_tests;
    thread_local Arena arena;
    ArenaScope scope(arena);
    Vec2f uv(u, v);
    if (geometry_.mesh && geometry_.mesh->exact.empty()) uv = mesh_uv(prim, u, v);
    // Weights as floats are off by more than what is seen of a huge triangle.
    if (geometry_.mesh && !geometry_.mesh->exact.empty()) {
      const Vec2d weights = weights_at(geometry_.mesh->exact[prim], Vec3d(p));
      uv = mesh_uv(prim, weights.x, weights.y);
    }
    if (geometry_.analytic) {
      const SurfacePoint s =
          geometry_.analytic->surface(transform_point(geometry_.analytic->scene_to_object(), Vec3d(p)));
      uv = Vec2f(static_cast<float>(s.u), static_cast<float>(s.v));
    }
    ShadingBatch point;
    point.n = 1;
    point.arena = &arena;
    point.p = arena.vec3(1);
    point.p.set(0, Vec3f(transform_point(group_to_render_, Vec3d(p))));
    point.u = &uv.x, point.v = &uv.y;
    if (value(shape_.alpha, point) == 0) return true;
    return shadow_ray && value(shape_.shadow_alpha, point) == 0;
  }

 private:
  static float value(const Tex<float>& tex, const ShadingBatch& point) {
    return tex.is_constant() ? tex.value() : tex(point)[0];
  }
  template <class T>
  Vec2f mesh_uv(uint32_t prim, T u, T v) const {
    const Mesh& mesh = *geometry_.mesh;
    Vec2f a(0, 0), b(1, 0), c(1, 1);
    if (!mesh.uvs.empty()) {
      a = mesh.uv(mesh.indices[3 * prim]), b = mesh.uv(mesh.indices[3 * prim + 1]);
      c = mesh.uv(mesh.indices[3 * prim + 2]);
    }
    const T w = 1 - u - v;
    const auto mix = [&](T at_a, T at_b, T at_c) { return static_cast<float>(at_a * w + at_b * u + at_c * v); };
    return {mix(a.x, b.x, c.x), mix(a.y, b.y, c.y)};
  }

  SceneShape geometry_;
  const Shape& shape_;
  Mat4d group_to_render_;
};

}  // namespace

int64_t take_alpha_tests() { return std::exchange(alpha_tests, 0); }

std::unique_ptr<AlphaTest> make_alpha_test(const SceneShape& geometry, const Shape& shape,
                                           const Mat4d& group_to_render) {
  return std::make_unique<TexturedAlpha>(geometry, shape, group_to_render);
}

}  // namespace whit
