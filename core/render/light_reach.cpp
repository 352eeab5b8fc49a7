#include "core/render/light_reach.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/box.h"
#include "core/base/fastmath.h"
#include "core/lobe/table.h"

namespace whit {
namespace {

/// Sampling is off by some 1e-7 of the coordinates it starts from, and cosines by as much of 1. What is this much away
/// from being lit is dark in floats too.
constexpr double kMargin = 1e-5;

/// Coordinates whose squares and products are no concern.
constexpr float kFar = 1e12f;

/// The least and the most of an array; false when a number is beyond `limit`, or none at all.
bool range_of(int n, const float* x, float limit, float& low, float& high) {
  float least = limit, most = -limit;
  int sound = 1;
#pragma omp simd reduction(min : least) reduction(max : most) reduction(& : sound)
  for (int i = 0; i < n; ++i) {
    least = min_of(x[i], least), most = max_of(x[i], most);
    sound &= std::abs(x[i]) <= limit;
  }
  low = least, high = most;
  return sound != 0;
}

bool are_within(int n, const float* x, float limit) {
  int sound = 1;
#pragma omp simd reduction(& : sound)
  for (int i = 0; i < n; ++i) sound &= std::abs(x[i]) <= limit;
  return sound != 0;
}

bool are_within(int n, const Vec3Lanes& v, float limit) {
  return are_within(n, v.x, limit) && are_within(n, v.y, limit) && are_within(n, v.z, limit);
}

bool only_reflects(const MaterialRun& run) {
  if (!run.scatters) return true;
  return std::none_of(run.lobes.lobes, run.lobes.lobes + run.lobes.count,
                      [](const Lobe& l) { return !is_specular(l.type) && row_of(l.type).transmits; });
}

double largest(const Vec3f& low, const Vec3f& high) {
  const auto of = [](float a, float b) { return static_cast<double>(std::max(std::abs(a), std::abs(b))); };
  return std::max({of(low.x, high.x), of(low.y, high.y), of(low.z, high.z)});
}

/// True when the points, with room around them, are in the half-space a one-sided light does not shine into.
bool are_behind(const LightReach& light, const Vec3d& low, const Vec3d& high, double margin) {
  const Vec3d n(light.normal);
  const double front =
      std::max(n.x * low.x, n.x * high.x) + std::max(n.y * low.y, n.y * high.y) + std::max(n.z * low.z, n.z * high.z);
  return front < light.plane - margin;
}

/// Towards the points, the normal of a plane through the apex of a cone of at most 90 degrees, in light space; the cone
/// is behind it.
Vec3d away_from(const LightCone& cone, const Vec3d& to_points) {
  const double along = to_points.dot(cone.axis);
  const Vec3d off = to_points - cone.axis * along;
  const double across = off.length();
  // Where the apex is what is nearest of the cone.
  if (along * cone.cosine + across * cone.sine < 0) return to_points.normalized();
  return across > 0 ? off * (cone.cosine / across) - cone.axis * cone.sine : -cone.axis;
}

/// True when the box of the points is outside of the cone: beyond a plane if the cone is convex, and else with all
/// corners in the dark cone, which then is.
bool are_beside(const LightCone& cone, const Vec3d& low, const Vec3d& high, double margin) {
  const auto to_light = [&](const Vec3d& p) {
    const Vec3d d = p - Vec3d(cone.apex);
    return Vec3d(d.dot(Vec3d(cone.x)), d.dot(Vec3d(cone.y)), d.dot(Vec3d(cone.z)));
  };
  const bool convex = cone.cosine >= 0;
  const Vec3d plane = convex ? away_from(cone, to_light((low + high) * 0.5)) : Vec3d(0);
  const std::array<Vec3d, 8> corners = corners_of({low, high});
  return std::all_of(corners.begin(), corners.end(), [&](const Vec3d& corner) {
    const Vec3d c = to_light(corner);
    const double outside =
        convex ? plane.dot(c) : c.cross(cone.axis).length() * cone.cosine - c.dot(cone.axis) * cone.sine;
    return outside > margin * cone.stretch + kMargin * c.length();
  });
}

/// What is dark one by one: a point behind a one-sided light, or, if lobes only reflect, one with all of the light behind
/// its surface. Block by block, because of lights that do shine the first few points tell.
bool all_turned_away(const LightReach& light, const ShadingBatch& s, bool only_reflects, double margin) {
  constexpr int kBlock = 64;
  const bool from_box = light.from == LightReach::From::Box, one_sided = light.one_sided;
  const Vec3f front = light.normal, center = from_box ? (light.low + light.high) * 0.5f : light.normal;
  const Vec3f half = from_box ? (light.high - light.low) * 0.5f : Vec3f(0, 0, 0);
  const float near = from_box ? 1.0f : 0.0f, plane = static_cast<float>(light.plane);
  const float off = static_cast<float>(-margin);
  for (int first = 0; first < s.n; first += kBlock) {
    const int n = std::min(kBlock, s.n - first);
    const Vec3Lanes p_lanes = s.p.from(first), ng_lanes = s.ng.from(first), wo_lanes = s.wo.from(first);
    int dark = 1;
#pragma omp simd reduction(& : dark)
    for (int i = 0; i < n; ++i) {
      const Vec3f p = p_lanes[i], ng = ng_lanes[i], to = center - p * near;
      // The side that is seen is told by the product of make_pair().
      const float side = dot(wo_lanes[i], ng) < 0 ? -1.0f : 1.0f;
      const float facing = dot(ng, to) * side + dot({std::abs(ng.x), std::abs(ng.y), std::abs(ng.z)}, half);
      dark &= (only_reflects & (facing < off)) | (one_sided & (dot(front, p) - plane < off));
    }
    if (!dark) return false;
  }
  return true;
}

}  // namespace

PointBounds bounds_of(const ShadingBatch& points, std::span<const MaterialRun> runs) {
  PointBounds b;
  b.only_reflects = std::all_of(runs.begin(), runs.end(), only_reflects);
  b.bounded = range_of(points.n, points.p.x, kFar, b.low.x, b.high.x) &&
              range_of(points.n, points.p.y, kFar, b.low.y, b.high.y) &&
              range_of(points.n, points.p.z, kFar, b.low.z, b.high.z);
  return b;
}

bool cannot_reach(const LightReach& light, const PointBounds& bounds, const ShadingBatch& points) {
  if (!bounds.bounded || light.from == LightReach::From::Anywhere) return false;
  if (light.from == LightReach::From::Direction) {
    return bounds.only_reflects && all_turned_away(light, points, true, kMargin);
  }
  const Vec3d low(bounds.low), high(bounds.high);
  const double sizes = largest(bounds.low, bounds.high) + largest(light.low, light.high);
  const double margin = kMargin * sizes + LightReach::kNearestLight;
  if (light.cone && are_beside(*light.cone, low, high, margin)) return true;
  if (light.one_sided && are_behind(light, low, high, margin)) return true;
  return (light.one_sided || bounds.only_reflects) && all_turned_away(light, points, bounds.only_reflects, margin);
}

bool are_finite(const ShadingBatch& points, std::span<const MaterialRun> runs) {
  if (!are_within(points.n, points.ng, 2) || !are_within(points.n, points.wo, 2)) return false;
  // For parameters up to this size no formula of a lobe overflows.
  constexpr float kMost = 1e4f;
  const auto sound = [](int n, const Lobe& l) {
    for (const float* x : {l.a, l.b, l.c, l.d, l.eta}) {
      if (x && !are_within(n, x, kMost)) return false;
    }
    for (const RGBLanes& c : {l.weight, l.colour1, l.colour2}) {
      if (c && !are_within(n, Vec3Lanes{c.r, c.g, c.b}, kMost)) return false;
    }
    return true;
  };
  return std::all_of(runs.begin(), runs.end(), [&](const MaterialRun& run) {
    if (!run.scatters) return true;
    const int n = run.points.n;
    if (!are_within(n, run.points.ns, 2)) return false;
    if (run.frame.ss && !(are_within(n, run.frame.ss, 2) && are_within(n, run.frame.ts, 2))) return false;
    return std::all_of(run.lobes.lobes, run.lobes.lobes + run.lobes.count, [&](const Lobe& l) { return sound(n, l); });
  });
}

}  // namespace whit
