#include "core/scene/alpha.h"

#include <utility>

#include "core/scene/texture_points.h"

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
    const Mesh* const mesh = geometry_.mesh;
    const ShadingBatch point = texture_points(mesh, 1, arena);
    point.p.set(0, Vec3f(transform_point(group_to_render_, Vec3d(p))));
    point.u[0] = u, point.v[0] = v;
    if (mesh && mesh->exact.empty()) set_triangle_point(*mesh, prim, u, v, point, 0);
    // Weights as floats are off by more than what is seen of a huge triangle.
    if (mesh && !mesh->exact.empty()) {
      const Vec2d weights = weights_at(mesh->exact[prim], Vec3d(p));
      set_triangle_point(*mesh, prim, weights.x, weights.y, point, 0);
    }
    if (geometry_.analytic) set_analytic_point(*geometry_.analytic, Vec3d(p), point, 0);
    if (value(shape_.alpha, point) == 0) return true;
    return shadow_ray && value(shape_.shadow_alpha, point) == 0;
  }

 private:
  static float value(const Tex<float>& tex, const ShadingBatch& point) {
    return tex.is_constant() ? tex.value() : tex(point)[0];
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
