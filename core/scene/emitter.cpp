#include "core/scene/emitter.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/accel/ray_end.h"
#include "core/base/box.h"
#include "core/base/fastmath.h"
#include "core/scene/emission_map.h"
#include "core/scene/texture_points.h"

namespace whit {
namespace {

/// The box and, where the emitter is not too strong to be judged, leave to use it.
LightReach within(const Box3d& box, const RGB& radiance) {
  LightReach reach;
  reach.low = Vec3f(box.min), reach.high = Vec3f(box.max);
  // Radiance over density is that times at most area / distance^2, and no shape's area exceeds some boxes of its size.
  const double strongest = std::max({std::abs(radiance.x), std::abs(radiance.y), std::abs(radiance.z)});
  constexpr double nearest = LightReach::kNearestLight * LightReach::kNearestLight;
  const double most = strongest * (1 + 100 * box.size().length2() / nearest);
  if (most < LightReach::kStrongest) reach.from = LightReach::From::Box;
  return reach;
}

/// Adds the plane; `corners` span what is sampled.
template <class Corners>
void set_front(LightReach& reach, const Vec3d& normal, const Corners& corners) {
  reach.normal = Vec3f(normal);
  const Vec3d n(reach.normal);
  reach.plane = n.dot(corners[0]);
  for (const Vec3d& corner : corners) reach.plane = std::min(reach.plane, n.dot(corner));
  reach.one_sided = std::isfinite(reach.plane);
}

/// 1 or -1 where the normals of a triangle's corners leave its front on the side of n, or turn it, at every point; else
/// 0. See TriangleEmitter::sample().
int side_of_normals(const Mesh& mesh, const uint32_t* index, const Vec3d& n) {
  if (mesh.normals.empty()) return 1;
  double low = 1, high = -1, shortest = 1e30, longest = 0;
  for (int c = 0; c < 3; ++c) {
    const Vec3d given(mesh.normal(index[c]));
    const double length = given.length(), cosine = n.dot(given) / length;
    if (!std::isfinite(cosine)) return 0;
    low = std::min(low, cosine), high = std::max(high, cosine);
    shortest = std::min(shortest, length), longest = std::max(longest, length);
  }
  // Interpolated cosines lie between. Floats get 1e-7 of the longest normal wrong.
  constexpr double kClear = 1e-3, kVisible = 1e-20;
  if (!(shortest > kClear * longest && shortest > kVisible)) return 0;
  return low > kClear ? 1 : high < -kClear ? -1 : 0;
}

/// How far off rounding may have put a triangle's corners.
Vec3d rounding_of_corners(const Mesh& mesh, uint32_t prim) {
  return rounding_of(farthest_of(triangle_box(mesh.corner(prim, 0), mesh.corner(prim, 1), mesh.corner(prim, 2))));
}

/// Of lengths and distances, how far the ray tracer's planes may be off (core/accel/ray_end.h).
constexpr float kPlaneOff = 6e-7f;

/// Where a shadow ray stops in front of an emitting triangle and of what else lies in its plane, when the ray tracer's
/// planes are off by `error` at most.
inline float in_front(float distance, float error, float cosine) {
  return max_of(0.0f, distance - error / max_of(std::abs(cosine), 1e-3f));
}

/// What all emitters know, and all there is to know of one that is seen and never sampled.
class Emitter : public Light {
 public:
  Emitter(const SceneShape& shape, const Emission& emission) : shape_(shape), emission_(emission) {}

  void sample(const LightSamples& samples) const override {
    for_lanes(samples.n, [&](int i) { samples.radiance.set(i, RGB(0.0f)); });
  }
  RGB emitted(const LightHit& hit) const override {
    return emission_.two_sided || dot(hit.ng, -hit.d) > 0 ? emission_.radiance : RGB(0.0f);
  }
  const Tex<RGB>* emission_map() const override { return emission_.map; }
  float pdf(const LightHit&) const override { return 0; }
  bool is_two_sided() const override { return emission_.two_sided; }
  int sample_count() const override { return emission_.samples; }
  double power(double) const override { return 0; }
  const std::string& light_group() const override { return *emission_.group; }

 protected:
  double power_of_area(double area) const {
    return detail::kPiD * (emission_.two_sided ? 2 : 1) * area * strength_of(emission_.radiance * emission_.mean);
  }

  /// What is sampled, times the map at the points that have been sampled.
  void apply_map(const LightSamples& samples, const ShadingBatch& points) const {
    const RGBLanes values = emission_values(*emission_.map, points);
    times(samples.n, samples.radiance, values);
    if (!samples.pdf) return;
    for_lanes(samples.n, [&](int i) { samples.pdf[i] = whit::is_black(values[i]) ? 0.0f : samples.pdf[i]; });
  }

  /// The most that there may be: more than a map of halves can make of it.
  RGB strongest_radiance() const { return emission_.map ? emission_.radiance * 1e6f : emission_.radiance; }

  const SceneShape shape_;
  const Emission emission_;
};

class TriangleEmitter final : public Emitter {
 public:
  TriangleEmitter(const SceneShape& shape, uint32_t prim, const Emission& emission)
      : Emitter(shape, emission), prim_(prim) {}
  void sample(const LightSamples& samples) const override;
  float pdf(const LightHit& hit) const override;
  LightReach reach() const override;
  double power(double scene_radius) const override;

 private:
  using Emitter::apply_map;
  void apply_map(const LightSamples& samples) const;
  const uint32_t* indices() const { return shape_.mesh->corners(prim_); }
  uint32_t prim_;
};

class AnalyticEmitter final : public Emitter {
 public:
  using Emitter::Emitter;
  void sample(const LightSamples& samples) const override;
  float pdf(const LightHit& hit) const override;
  LightReach reach() const override;
  double power(double scene_radius) const override;
};

Vec3d area_vector(const Mesh& mesh, const uint32_t* index) {
  const Vec3d a(mesh.position(index[0])), b(mesh.position(index[1])), c(mesh.position(index[2]));
  return (b - a).cross(c - a) * 0.5;
}

/// Uniform by area (PBR 3e, section 13.6.5), the density turned into one over solid angle.
void TriangleEmitter::sample(const LightSamples& samples) const {
  const Mesh& mesh = *shape_.mesh;
  const uint32_t* index = indices();
  const Vec3f a = mesh.position(index[0]), b = mesh.position(index[1]), c = mesh.position(index[2]);
  const Vec3d spanned = area_vector(mesh, index);
  const float area = static_cast<float>(spanned.length());
  Vec3f n(spanned.normalized());
  bool has_normals = false;
  Vec3f na(0, 0, 0), nb(0, 0, 0), nc(0, 0, 0);
  if (!mesh.normals.empty()) {
    na = mesh.normal(index[0]), nb = mesh.normal(index[1]), nc = mesh.normal(index[2]);
    has_normals = true;
  }
  const float flip = shape_.flips ? -1.0f : 1.0f;
  const RGB radiance = emission_.radiance;
  const bool two_sided = emission_.two_sided;
  const Vec3f error =
      (Vec3f(std::abs(a.x), std::abs(a.y), std::abs(a.z)) + Vec3f(std::abs(b.x), std::abs(b.y), std::abs(b.z)) +
       Vec3f(std::abs(c.x), std::abs(c.y), std::abs(c.z))) *
      kPlaneOff;
  // Where more than its own plane is near, rays end on the triangle, and the ray tracer decides what is before them.
  const bool touched = static_cast<bool>(samples.q);
  const float back = touched ? 0.0f : std::abs(n.x) * error.x + std::abs(n.y) * error.y + std::abs(n.z) * error.z;
  // Points in the plane of the triangle are on neither side of it; of what else is there, too, none can tell.
  const Vec3f rounding(rounding_of_corners(mesh, prim_) * 2.0);  // the triangle's and the point's
  const float off = std::abs(n.x) * rounding.x + std::abs(n.y) * rounding.y + std::abs(n.z) * rounding.z;
  const float unsure = touched ? off : 0.0f;
  // The ray tracer takes the corners relative to where the ray begins: what is far away is off by more.
  const float across = std::sqrt(max_of(max_of(dot(b - a, b - a), dot(c - b, c - b)), dot(a - c, a - c)));
  const float of_distance = touched ? 0.0f : kPlaneOff;
  const LightSamples out = samples;
  const auto sample = [=]<bool kDensity>(std::bool_constant<kDensity>, int i) {
    const float root = safe_sqrt(out.u[i]);
    const float b0 = 1 - root, b1 = out.v[i] * root, b2 = 1 - b0 - b1;
    const Vec3f q = a * b0 + b * b1 + c * b2;
    // The front is where a ray that hits sees it (mesh_surfaces): flipped, then turned to the flipped shading normal.
    const Vec3f interpolated = (na * b0 + nb * b1 + nc * b2) * flip;
    Vec3f front = n * flip;
    const bool turned = has_normals & (dot(front, interpolated) < 0);
    const float side = turned ? -1.0f : 1.0f;
    front = front * side;
    const Vec3f to = q - out.p[i];
    const float squared = dot(to, to);
    const float distance = std::sqrt(squared);
    const float inverse = squared > 0 ? 1 / distance : 0.0f;
    const Vec3f wi = to * inverse;
    const float cosine = -dot(front, wi);
    const bool lit =
        ((cosine > 0) | (two_sided & (cosine < 0))) & (squared > 0) & !(std::abs(cosine) * distance < unsure);
    const float geometry = lit ? std::abs(cosine) * area / squared : 0.0f;
    out.wi.set(i, wi);
    out.distance[i] = in_front(distance, back + of_distance * (distance + across), cosine);
    out.radiance.set(i, {radiance.x * geometry, radiance.y * geometry, radiance.z * geometry});
    if constexpr (kDensity) out.pdf[i] = lit ? 1 / geometry : 0.0f;
  };
  if (out.pdf) for_lanes(out.n, [=](int i) { sample(std::true_type(), i); });
  else for_lanes(out.n, [=](int i) { sample(std::false_type(), i); });
  if (emission_.map) apply_map(samples);
  if (!out.q) return;
  for_lanes(samples.n, [=](int i) {
    const float root = safe_sqrt(out.u[i]);
    const float b0 = 1 - root, b1 = out.v[i] * root;
    out.q.set(i, a * b0 + b * b1 + c * (1 - b0 - b1));
  });
}

/// Where sample() has put its points.
void TriangleEmitter::apply_map(const LightSamples& samples) const {
  const ArenaScope scratch(*samples.arena);
  const Mesh& mesh = *shape_.mesh;
  const uint32_t* index = indices();
  const Vec3f a = mesh.position(index[0]), b = mesh.position(index[1]), c = mesh.position(index[2]);
  const ShadingBatch points = texture_points(&mesh, samples.n, *samples.arena);
  for (int i = 0; i < samples.n; ++i) {
    const float root = safe_sqrt(samples.u[i]), b0 = 1 - root, b1 = samples.v[i] * root, b2 = 1 - b0 - b1;
    points.p.set(i, a * b0 + b * b1 + c * b2);
    set_triangle_point(mesh, prim_, b1, b2, points, i);
  }
  apply_map(samples, points);
}

void AnalyticEmitter::sample(const LightSamples& samples) const {
  const ArenaScope scratch(*samples.arena);
  float* cosines = samples.arena->floats(samples.n);
  float* pdfs = samples.pdf ? samples.pdf : samples.arena->floats(samples.n);
  shape_.analytic->sample_lanes(
      {samples.n, samples.p, samples.u, samples.v, samples.wi, samples.distance, cosines, pdfs});
  const RGB radiance = emission_.radiance;
  const bool two_sided = emission_.two_sided;
  for_lanes(samples.n, [&](int i) {
    const float cosine = cosines[i];
    const bool lit = (pdfs[i] > 0) & ((cosine > 0) | (two_sided & (cosine < 0)));
    const float weight = lit ? 1 / pdfs[i] : 0.0f;
    samples.radiance.set(i, {radiance.x * weight, radiance.y * weight, radiance.z * weight});
  });
  if (!emission_.map) return;
  const ShadingBatch points = texture_points(nullptr, samples.n, *samples.arena);
  for (int i = 0; i < samples.n; ++i) {
    const bool lit = pdfs[i] > 0;
    const Vec3f p = samples.p[i] + samples.wi[i] * (lit ? samples.distance[i] : 0.0f);
    points.p.set(i, p);
    if (lit) set_analytic_point(*shape_.analytic, Vec3d(p), points, i);
    else points.u[i] = points.v[i] = 0;
  }
  apply_map(samples, points);
}

/// The density of sample() at what a ray has met: per area, seen from where the ray began.
float TriangleEmitter::pdf(const LightHit& hit) const {
  const double area = area_vector(*shape_.mesh, indices()).length();
  const double cosine = std::abs(Vec3d(hit.ng).dot(Vec3d(hit.d))), t = static_cast<double>(hit.t);
  return cosine > 0 && area > 0 ? static_cast<float>(t * t / (cosine * area)) : 0.0f;
}

float AnalyticEmitter::pdf(const LightHit& hit) const {
  return static_cast<float>(shape_.analytic->density_from(Vec3d(hit.o), Vec3d(hit.p)));
}

double TriangleEmitter::power(double) const { return power_of_area(area_vector(*shape_.mesh, indices()).length()); }

double AnalyticEmitter::power(double) const { return power_of_area(shape_.analytic->placed_area()); }

LightReach TriangleEmitter::reach() const {
  const Mesh& mesh = *shape_.mesh;
  const uint32_t* index = indices();
  const std::array<Vec3d, 3> corners{Vec3d(mesh.position(index[0])), Vec3d(mesh.position(index[1])),
                                     Vec3d(mesh.position(index[2]))};
  LightReach reach = within(triangle_box(corners[0], corners[1], corners[2]), strongest_radiance());
  const Vec3d n = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
  reach.normal = Vec3f(n);
  if (emission_.two_sided) return reach;
  const int side = side_of_normals(mesh, index, n);
  if (side != 0) set_front(reach, n * (shape_.flips ? -side : side), corners);
  return reach;
}

LightReach AnalyticEmitter::reach() const {
  const AnalyticShape& shape = *shape_.analytic;
  const Box3d box = shape.object_bounds();
  const Box3d placed = transform_box(shape.object_to_scene(), box);
  LightReach reach = within(placed, strongest_radiance());
  if (!shape.is_planar()) return reach;
  // Of a plane, any sample has the normal, seen from anywhere.
  const Vec3d n = shape.sample_from(placed.max + Vec3d(1, 2, 3), 0.5, 0.5).n;
  reach.normal = Vec3f(n);
  if (emission_.two_sided) return reach;
  std::array<Vec3d, 8> corners = corners_of(box);
  for (Vec3d& corner : corners) corner = transform_point(shape.object_to_scene(), corner);
  set_front(reach, n, corners);
  return reach;
}

}  // namespace

std::unique_ptr<const Light> make_seen_emitter(const SceneShape& shape, const Emission& emission) {
  return std::make_unique<Emitter>(shape, emission);
}

std::unique_ptr<const Light> make_emitter(const SceneShape& shape, uint32_t prim, const Emission& emission) {
  if (shape.mesh) return std::make_unique<TriangleEmitter>(shape, prim, emission);
  if (shape.analytic) return std::make_unique<AnalyticEmitter>(shape, emission);
  return make_seen_emitter(shape, emission);
}

}  // namespace whit
