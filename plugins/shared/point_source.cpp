#include "plugins/shared/point_source.h"

#include <algorithm>
#include <cmath>

#include "core/base/fastmath.h"

namespace whit {

bool PointSource::place(const PrepareContext& ctx, const Vec3d& at) {
  const auto row = [&](int i) { return Vec3d(light_to_world[i][0], light_to_world[i][1], light_to_world[i][2]); };
  const double size = std::max({row(0).length(), row(1).length(), row(2).length()});
  // Directions need no length: scaled like this they neither overflow nor vanish.
  const Mat4d unit = light_to_world * Mat4d().setScale(size > 0 ? 1 / size : 1.0);
  const double volume = (row(0) / size).cross(row(1) / size).dot(row(2) / size);
  if (!(std::isfinite(size) && size > 0 && std::isfinite(1 / volume))) {
    ctx.diagnostics->error(ctx.statement, "the transform of this light cannot be inverted");
    return false;
  }
  direction_to_light_ = AffineMap(unit.inverse());
  exact_position_ = transform_point(ctx.space.from_world(), transform_point(light_to_world, at));
  position_ = Vec3f(exact_position_);
  to_render_ = static_cast<float>(ctx.space.scale);
  intensity_ = I * scale;
  return true;
}

void PointSource::limit_to_cone(const Vec3d& axis, double cosine, double sine) {
  const AffineMap& m = direction_to_light_;
  cone_ = {position_, m.x, m.y, m.z, 1, axis, cosine, sine};
  // Gershgorin's circles bound the eigenvalues of M M^T, the squared stretches.
  const Vec3d x(m.x), y(m.y), z(m.z);
  const double xy = std::abs(x.dot(y)), yz = std::abs(y.dot(z)), zx = std::abs(z.dot(x));
  cone_->stretch = std::sqrt(std::max({x.length2() + xy + zx, y.length2() + xy + yz, z.length2() + yz + zx}));
}

LightReach PointSource::reach() const {
  // The factors come from pictures that nobody has read yet.
  constexpr float kBrightestPicture = 1e6f;
  LightReach reach = reach_of_point(position_, intensity_ * kBrightestPicture, to_render_);
  if (cone_) reach.cone = &*cone_;
  return reach;
}

double PointSource::power(double) const {
  const auto to_render = static_cast<double>(to_render_);
  return strength_of(intensity_ * total_factor()) * to_render * to_render;
}

void PointSource::sample(const LightSamples& s) const {
  alignas(64) float storage[6][kBlock];
  const Vec3Lanes d{storage[0], storage[1], storage[2]};
  const RGBLanes share{storage[3], storage[4], storage[5]};
  const Vec3f position = position_;
  const AffineMap to_light = direction_to_light_;
  const RGB intensity = intensity_;
  const float to_render = to_render_;
  for (int first = 0; first < s.n; first += kBlock) {
    const int n = std::min(kBlock, s.n - first);
    const Vec3Lanes p = s.p.from(first), wi = s.wi.from(first);
    const RGBLanes radiance = s.radiance.from(first);
    float* const distance = s.distance + first;
    for_lanes(n, [=](int i) {
      const Vec3f towards = position - p[i];
      distance[i] = length(towards);
      // At the light itself there is no direction, and no light.
      const float inverse = distance[i] > 0 ? 1 / distance[i] : 0.0f;
      wi.set(i, towards * inverse);
      d.set(i, to_light.vector(wi[i] * -1.0f));
    });
    factor(n, d, share);
    for_lanes(n, [=](int i) {
      // Intensity is per world length squared. One factor at a time, because the square alone could overflow.
      const float falloff = distance[i] > 0 ? to_render / distance[i] : 0.0f;
      radiance.set(i, {intensity.x * share.r[i] * falloff * falloff, intensity.y * share.g[i] * falloff * falloff,
                       intensity.z * share.b[i] * falloff * falloff});
    });
  }
}

}  // namespace whit
