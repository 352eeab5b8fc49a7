// A sky all around: a lat-long map, or without one a gradient in which each colour channel is the direction's
// component mapped from [-1, 1] to [0, 1]. Infinitely far away, or with a radius a sphere around `center` seen from
// inside, with parallax; points outside the sphere see its far side through it and black past it.

#include "core/base/fastmath.h"
#include "core/plugin/registry.h"
#include "plugins/shared/environment.h"
#include "plugins/shared/latlong_map.h"

namespace whit {
namespace {

/// factor * (d + 1)/2. Its importance is linear in the direction, (|a| + a.d) up to a factor, and is sampled exactly by
/// inverting the cumulative distribution of the cosine to a, a quadratic.
class GradientRadiance final : public DirectionalRadiance {
 public:
  explicit GradientRadiance(const RGB& factor) : factor_(factor) {
    const Vec3d weight(0.212671 * std::abs(factor.x), 0.715160 * std::abs(factor.y), 0.072169 * std::abs(factor.z));
    const double sum = weight.x + weight.y + weight.z;
    axis_ = sum > 0 ? Vec3f(weight.normalized()) : Vec3f(0, 0, 1);
    slope_ = sum > 0 ? static_cast<float>(weight.length() / sum) : 0.0f;
  }

  void evaluate(int n, const Vec3Lanes& d, const RGBLanes& radiance, float* pdf) const override {
    const RGB half = factor_ * 0.5f;
    for_lanes(n, [=](int i) {
      radiance.set(i, {half.x * (d.x[i] + 1), half.y * (d.y[i] + 1), half.z * (d.z[i] + 1)});
    });
    if (!pdf) return;
    const Vec3f a = axis_ * slope_;
    for_lanes(n, [=](int i) { pdf[i] = 0.25f * kInvPi * max_of(1 + dot(a, d[i]), 0.0f); });
  }

  double mean() const override { return 0.5 * strength_of(factor_); }

  void sample(int n, const float* u, const float* v, const Vec3Lanes& d) const override {
    const Frame frame = coordinate_system(axis_);
    const Vec3f axis = axis_;
    const float slope = slope_;
    for_lanes(n, [=](int i) {
      // The root of slope t^2 + 2 t + 2 - slope - 4 v = 0 in [-1, 1], in the form that stands slope = 0.
      const float t = (4 * v[i] - 2 + slope) / (1 + safe_sqrt((1 - slope) * (1 - slope) + 4 * slope * v[i]));
      const float s = safe_sqrt((1 - t) * (1 + t));
      const SinCos phi = sin_cos_2pi(u[i]);
      d.set(i, normalize(frame.s * (s * phi.cos) + frame.t * (s * phi.sin) + axis * t));
    });
  }

 private:
  RGB factor_;
  Vec3f axis_;   ///< Unit; where importance is greatest.
  float slope_;  ///< In [0, 1]: density is (1 + slope cos) / (4 pi).
};

class Skybox final : public EnvironmentLight, public NeedsMemory {
 public:
  FileName map;
  RGB L{1.0f}, scale{1.0f};
  Point center;
  float radius = 0;

  bool is_black() const override { return whit::is_black(L * scale); }

  std::vector<Ineffective> ineffective() const override {
    if (radius > 0) return {};
    return {{"center", "without a \"radius\" the sky is infinitely far away", "radius"}};
  }

  MemoryNeed memory_need(const MeshAttributes&) const override { return latlong_need(map.path, LatLongRule::Exact); }

  bool prepare(const PrepareContext& ctx) override {
    std::unique_ptr<const DirectionalRadiance> radiance;
    if (map.empty()) {
      radiance = std::make_unique<GradientRadiance>(L * scale);
    } else {
      radiance = read_latlong_map(map.path, L * scale, LatLongRule::Exact, ctx);
    }
    if (!radiance) return false;
    set_radiance(std::move(radiance));
    return radius > 0 ? set_sphere(ctx, center.value, static_cast<double>(radius)) : set_infinite(ctx);
  }
};

const Register<Skybox> skybox{"skybox",
                              "A sky all around, from a map or a gradient, far away or on a sphere.",
                              param(&Skybox::map, "mapname", Unit::None,
                                    "Lat-long map; +z of light space is at its top. Without one: the gradient."),
                              param(&Skybox::L, "L", RGB{1.0f}, Unit::Radiance, "Factor of the map or gradient."),
                              param(&Skybox::scale, "scale", RGB{1.0f}, Unit::None, "Factor of L."),
                              param(&Skybox::center, "center", Point{}, Unit::Length, "Centre of the sphere."),
                              param(&Skybox::radius, "radius", 0.0f, Unit::Length,
                                    "Radius of the sphere; 0 is infinitely far away.", kNonNegative),
                              lightgroup_param()};

}  // namespace
}  // namespace whit
