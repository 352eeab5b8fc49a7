#include "plugins/shared/environment.h"

#include <algorithm>
#include <cmath>

#include "core/base/fastmath.h"
#include "core/base/radical_inverse.h"
#include "core/base/sampling.h"

namespace whit {

void UniformRadiance::evaluate(int n, const Vec3Lanes&, const RGBLanes& radiance, float* pdf) const {
  const RGB value = radiance_;
  for_lanes(n, [=](int i) { radiance.set(i, value); });
  if (pdf) for_lanes(n, [=](int i) { pdf[i] = 0.25f * kInvPi; });
}

void UniformRadiance::sample(int n, const float* u, const float* v, const Vec3Lanes& d) const {
  for_lanes(n, [=](int i) { d.set(i, uniform_sphere(u[i], v[i])); });
}

/// Lanes of one run: where rays meet the sky, what they see there, and with which density sample() takes that way.
struct EnvironmentLight::Block {
  static constexpr int kSize = 128;
  alignas(64) float storage[10][kSize];
  Vec3Lanes sky{storage[0], storage[1], storage[2]};      ///< Unit direction from the centre, sky space.
  RGBLanes radiance{storage[3], storage[4], storage[5]};  ///< Seen there.
  float* pdf = storage[6];                                ///< Density of `sky` over the directions from the centre.
  /// The density over directions from p is pdf * jacobian + even; both are 0 where nothing is seen.
  float *jacobian = storage[7], *even = storage[8];
  float* distance = storage[9];  ///< Render space; infinity at infinity, 0 where nothing is seen.
};

namespace {

/// The determinant of the linear part: the volume of the box that the images of the axes span.
double linear_determinant(const Mat4d& m) {
  const auto row = [&](int i) { return Vec3d(m[i][0], m[i][1], m[i][2]); };
  return row(0).dot(row(1).cross(row(2)));
}

}  // namespace

/// The linear part of m times `scale`.
EnvironmentLight::Linear EnvironmentLight::linear(const Mat4d& m, double scale) {
  const auto row = [&](int i) { return Vec3f(Vec3d(m[i][0], m[i][1], m[i][2]) * scale); };
  return {row(0), row(1), row(2)};
}

bool EnvironmentLight::set_frame(const PrepareContext& ctx, const Vec3d& center, double radius, bool finite) {
  const Mat4d to_render =
      Mat4d().setScale(radius) * Mat4d().setTranslation(center) * light_to_world * ctx.space.from_world();
  const double det = linear_determinant(to_render);
  const double size = std::cbrt(std::abs(det));
  if (!(std::isfinite(size) && size > 0 && std::isfinite(1 / det))) {
    ctx.diagnostics->error(ctx.statement, "the transform of this light cannot be inverted");
    return false;
  }
  const Mat4d to_sky = to_render.inverse();
  point_to_sky_ = linear(to_sky, 1), direction_to_sky_ = linear(to_sky, size);
  direction_to_render_ = linear(to_render, 1 / size);
  sky_origin_ = Vec3f(transform_point(to_sky, {0, 0, 0}));
  size_ = static_cast<float>(size);
  finite_ = finite;
  return true;
}

namespace {

/// Where a line through o (sky space) in unit direction d leaves the unit sphere, and how far away that is.
struct SkyPoint {
  Vec3f p;         ///< Unit; meaningless, and NaN from very far away, where distance is 0.
  float distance;  ///< 0 where the line misses the sphere or the sphere lies behind.
  float cosine;    ///< Between the line and the sphere's normal there, >= 0.
};

/// The share of directions drawn evenly around a point of the sphere, instead of by what the centre sees: by itself
/// that leaves the wall next to the point too rarely chosen for how large it looks. Nothing at the centre.
inline float even_share(const Vec3f& o) {
  const float r2 = dot(o, o);
  return r2 < 1 ? 0.5f * r2 : 0.0f;
}

inline SkyPoint far_intersection(const Vec3f& o, const Vec3f& d) {
  const float along = dot(o, d);
  const Vec3f foot = o - d * along;  // the line's nearest point to the centre
  const float cosine = safe_sqrt(1 - dot(foot, foot));
  // The two roots are -along +- cosine and their product is o.o - 1: of the two forms the one that does not cancel.
  const float distance = along > 0 ? (1 - dot(o, o)) / (along + cosine) : cosine - along;
  const float ahead = cosine > 0 ? distance : 0.0f;
  return {normalize(foot + d * cosine), max_of(ahead, 0.0f), cosine};
}

}  // namespace

/// For n rays (render space) the points of the sky they see, and the factors of their densities.
void EnvironmentLight::find_sky(int n, const Vec3Lanes& p, const Vec3Lanes& d, const Block& b) const {
  const Linear direction_to_sky = direction_to_sky_, point_to_sky = point_to_sky_;
  const Vec3Lanes sky = b.sky;
  float *jacobian = b.jacobian, *even = b.even, *distance = b.distance;
  // A linear map A takes the solid angle dw around d to dw |det A| / |A d|^3, and this one has determinant 1.
  if (!finite_) {
    for_lanes(n, [=](int i) {
      const Vec3f v = direction_to_sky(d[i]);
      const float inverse = 1 / length(v);
      sky.set(i, v * inverse);
      jacobian[i] = inverse * inverse * inverse;
      even[i] = 0;
      distance[i] = std::numeric_limits<float>::infinity();
    });
    return;
  }
  const Vec3f origin = sky_origin_;
  const float size = size_;
  // Too large for GCC to inline by itself, and a call would keep the loop from vectorising.
  const auto find = [=](int i) __attribute__((always_inline)) {
    const Vec3f v = direction_to_sky(d[i]), o = origin + point_to_sky(p[i]);
    const float inverse = 1 / length(v);
    const SkyPoint s = far_intersection(o, v * inverse);
    sky.set(i, s.p);
    // From area on the unit sphere to solid angle at p: distance^2 / cosine.
    const float area = s.distance * s.distance / (s.cosine > 0 ? s.cosine : 1.0f);
    const float share = even_share(o), stretch = inverse * inverse * inverse;
    jacobian[i] = (1 - share) * stretch * area;
    even[i] = s.distance > 0 ? share * stretch * (0.25f * kInvPi) : 0.0f;
    distance[i] = s.distance * size * inverse;
  };
  for_lanes(n, find);
}

/// Draws directions from points p: of the sky as seen from its centre, and on a sphere an even share from p itself.
/// `aimed` is 0 where a point of the sphere shows its outside, positive elsewhere.
void EnvironmentLight::aim(int n, const Vec3Lanes& p, const float* u, const float* v, const Vec3Lanes& wi, float* aimed,
                           Block& b) const {
  const Linear direction_to_render = direction_to_render_, point_to_sky = point_to_sky_;
  const Vec3Lanes sky = b.sky;
  if (!finite_) {
    radiance_->sample(n, u, v, sky);
    for_lanes(n, [=](int i) { wi.set(i, normalize(direction_to_render(sky[i]))), aimed[i] = 1; });
    return;
  }
  const Vec3f origin = sky_origin_;
  float *rest = b.pdf, *share = b.even;
  for_lanes(n, [=](int i) {
    share[i] = even_share(origin + point_to_sky(p[i]));
    const float r = v[i] < share[i] ? v[i] / share[i] : (v[i] - share[i]) / (1 - share[i]);
    rest[i] = min_of(r, kBelowOne);
  });
  radiance_->sample(n, u, rest, sky);
  for_lanes(n, [=](int i) {
    const Vec3f target = sky[i], across = target - (origin + point_to_sky(p[i])), any = uniform_sphere(u[i], rest[i]);
    const bool evenly = v[i] < share[i];
    const Vec3f d(evenly ? any.x : across.x, evenly ? any.y : across.y, evenly ? any.z : across.z);
    wi.set(i, normalize(direction_to_render(d)));
    aimed[i] = evenly ? 1.0f : max_of(dot(across, target), 0.0f);
  });
}

void EnvironmentLight::sample(const LightSamples& s) const {
  Block b;
  for (int first = 0; first < s.n; first += Block::kSize) {
    const int n = std::min(Block::kSize, s.n - first);
    const Vec3Lanes p = s.p.from(first), wi = s.wi.from(first);
    float* distance = s.distance + first;
    aim(n, p, s.u + first, s.v + first, wi, distance, b);
    find_sky(n, p, wi, b);
    radiance_->evaluate(n, b.sky, b.radiance, b.pdf);
    const RGBLanes out = s.radiance.from(first), seen = b.radiance;
    const float *pdf = b.pdf, *jacobian = b.jacobian, *even = b.even, *far = b.distance;
    for_lanes(n, [=](int i) {
      const float density = pdf[i] * jacobian[i] + even[i];
      const float weight = distance[i] > 0 ? 1 / density : 0.0f;
      const bool lit = density > 0;  // false where the density is NaN, too
      out.set(i, {lit ? seen.r[i] * weight : 0.0f, lit ? seen.g[i] * weight : 0.0f, lit ? seen.b[i] * weight : 0.0f});
      distance[i] = far[i];
    });
    if (!s.pdf) continue;
    float* density = s.pdf + first;
    for_lanes(n, [=](int i) { density[i] = pdf[i] * jacobian[i] + even[i]; });
  }
}

void EnvironmentLight::add_escaped(int n, const Vec3Lanes& o, const Vec3Lanes& d, const RGBLanes& out,
                                   float* pdf) const {
  Block b;
  for (int first = 0; first < n; first += Block::kSize) {
    const int count = std::min(Block::kSize, n - first);
    find_sky(count, o.from(first), d.from(first), b);
    radiance_->evaluate(count, b.sky, b.radiance, pdf ? b.pdf : nullptr);
    const RGBLanes sum = out.from(first), seen = b.radiance;
    const float* distance = b.distance;
    for_lanes(count, [=](int i) {
      const bool visible = distance[i] > 0;
      sum.r[i] += visible ? seen.r[i] : 0.0f, sum.g[i] += visible ? seen.g[i] : 0.0f;
      sum.b[i] += visible ? seen.b[i] : 0.0f;
    });
    if (!pdf) continue;
    float* density = pdf + first;
    for_lanes(count, [=, &b](int i) { density[i] = b.pdf[i] * b.jacobian[i] + b.even[i]; });
  }
}

/// As pbrt has it, which leaves out a factor of pi. On a sphere what arrives at the centre counts.
double EnvironmentLight::power(double scene_radius) const {
  return detail::kPiD * scene_radius * scene_radius * radiance_->mean();
}

float EnvironmentLight::pdf(const Vec3f& p, const Vec3f& d) const {
  Vec3f point = p, direction = d;
  Block b;
  find_sky(1, {&point.x, &point.y, &point.z}, {&direction.x, &direction.y, &direction.z}, b);
  radiance_->evaluate(1, b.sky, b.radiance, b.pdf);
  return b.pdf[0] * b.jacobian[0] + b.even[0];
}

}  // namespace whit
