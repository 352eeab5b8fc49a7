// Ambient occlusion: how much of the hemisphere over a point is free, weighted by the cosine.
// Source: Zhukov, Iones and Kronin, An Ambient Light Illumination Model, 1998; pbrt-v3's "ambientocclusion".

#include "core/base/sampling.h"
#include "core/plugin/integrator.h"
#include "core/plugin/registry.h"
#include "core/plugin/transport.h"

namespace whit {
namespace {

struct AmbientOcclusion final : Integrator {
  bool cossample = true;
  int nsamples = 64;

  int max_depth() const override { return 1; }
  int dimensions(int lights) const override { return lights + 2; }
  EffectSet simulates() const override {
    using enum Effect;
    return {Shadows, Textures, Alpha, MotionBlur, DepthOfField, Instancing, Interfaces};
  }
  EffectSet effects() const override { return {Effect::Shadows}; }

  void shade(Rays& rays, Transport& t) const override {
    const Hits hits = t.intersect(rays);
    const Points points = t.surfaces(rays, hits);
    const Uniform2 first = t.draw_2d(points, 0);
    for (int k = 0; k < nsamples; ++k) {
      const ArenaScope scratch(t.arena());
      const DirectSamples over = directions(points, t.arena().vec3(points.n), t.arena());
      const RGBLanes weight = aim(points, first, k, over.wi, t.arena());
      t.add(points, over, t.visible(points, over, weight));
    }
  }

  /// The k-th direction over each point, on the side that its ray came from, and its share of pi.
  RGBLanes aim(const Points& points, const Uniform2& first, int k, const Vec3Lanes& wi, Arena& arena) const {
    const RGBLanes weight = arena.rgb(points.n);
    const float share = 1 / static_cast<float>(nsamples);
    for_lanes(points.n, [&](int i) {
      const Vec2f u = lattice_point({first.u[i], first.v[i]}, k);
      const Vec3f w = cossample ? cosine_hemisphere(u.x, u.y) : uniform_hemisphere(u.x, u.y);
      const Vec3f ng = points.at.ng[i], n = ng * (dot(ng, points.at.wo[i]) < 0 ? -1.0f : 1.0f);
      const Frame frame = coordinate_system(n);
      wi.set(i, normalize(frame.s * w.x + frame.t * w.y + n * w.z));
      weight.set(i, RGB(share * (cossample ? kPi : 2 * kPi * w.z)));
    });
    return weight;
  }
};

const Register<AmbientOcclusion> ambient_occlusion{
    "ambientocclusion", "How free the hemisphere over each point is, without materials or lights.",
    param(&AmbientOcclusion::cossample, "cossample", true, Unit::None,
          "Draws directions in proportion to the cosine, which is less noisy than evenly."),
    param(&AmbientOcclusion::nsamples, "nsamples", 64, Unit::None, "Directions for each camera sample.", {1, 1e6}),
    pixelbounds_param()};

}  // namespace
}  // namespace whit
