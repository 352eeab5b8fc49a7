// Curves against what they are by definition: a width around a centre line, as a ray sees it.
#include "core/accel/curve.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "core/accel/accel.h"

namespace whit {
namespace {

/// One segment with its arrays.
struct Segment {
  std::vector<float> points, normals;
  CurveView view;
  Segment(std::vector<Vec3f> p, float width0, float width1, std::vector<Vec3f> n = {}, int depth = 3) {
    for (size_t i = 0; i < 4; ++i) {
      const float w = width0 + (width1 - width0) * static_cast<float>(i) / 3;
      points.insert(points.end(), {p[i].x, p[i].y, p[i].z, w / 2});
    }
    for (const Vec3f& v : n) normals.insert(normals.end(), {v.x, v.y, v.z});
    view.control_points = points.data();
    view.segment_count = 1;
    view.normals = n.empty() ? nullptr : normals.data();
    view.split_depth = depth;
  }
  void place(const Mat4d& m) { view.to_group = m, view.from_group = m.inverse(); }

  /// The nearest hit over all pieces, by one ray.
  bool hit(const Vec3d& o, const Vec3d& d, CurveHit& nearest, float t_min = 0, float t_max = 1e30f) const {
    const Vec3f of(o), df(d);
    const int valid = -1;
    bool any = false;
    for (size_t piece = 0; piece < view.piece_count(); ++piece) {
      CurveHit h{};
      const CurveRays rays{1, &valid, &of.x, &of.y, &of.z, &df.x, &df.y, &df.z, &t_min, &t_max};
      if (!intersect_curve(view, piece, rays, &h)) continue;
      if (!any || h.t < nearest.t) nearest = h;
      any = true;
    }
    return any;
  }
};

const std::vector<Vec3f> kStraight{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}};
const std::vector<Vec3f> kBent{{0, 0, 0}, {1, 2, 0}, {2, -2, 1}, {3, 1, 0}};

TEST(Curve, AStraightOneIsARectangleThatFacesTheRay) {
  const Segment s(kStraight, 0.4f, 0.4f);
  CurveHit h{};
  for (const Vec3d& from : {Vec3d(0, 0, 5), Vec3d(0, 3, 4), Vec3d(0, -5, 0)}) {
    const Vec3d d = -from / 5, side = d.cross(Vec3d(1, 0, 0));
    for (const double x : {0.01, 0.7, 1.5, 2.99}) {
      for (const double across : {-0.19, -0.05, 0.0, 0.1, 0.19}) {
        ASSERT_TRUE(s.hit(from + Vec3d(x, 0, 0) + side * across, d, h)) << x << " " << across;
        EXPECT_NEAR(h.t, 5, 1e-5);
        EXPECT_NEAR(h.u, x / 3, 1e-5);
        EXPECT_NEAR(h.v, 0.5 + across / 0.4, 1e-5);
      }
    }
    // Sides are sharp, and ends are cut off square.
    for (const double across : {-0.201, 0.201}) EXPECT_FALSE(s.hit(from + Vec3d(1, 0, 0) + side * across, d, h));
    for (const double x : {-0.001, 3.001}) EXPECT_FALSE(s.hit(from + Vec3d(x, 0, 0), d, h));
  }
}

TEST(Curve, WidthsChangeLinearly) {
  const Segment s(kStraight, 0.2f, 0.8f);
  CurveHit h{};
  for (const double u : {0.1, 0.4, 0.9}) {
    const double half = 0.1 + 0.3 * u;
    EXPECT_TRUE(s.hit({3 * u, half - 1e-4, 5}, {0, 0, -1}, h));
    EXPECT_FALSE(s.hit({3 * u, half + 1e-4, 5}, {0, 0, -1}, h));
  }
}

TEST(Curve, ABentOneIsHitWithinHalfItsWidth) {
  const Segment s(kBent, 0.1f, 0.1f);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto at = [&](double t) {
    const double a = 1 - t;
    return Vec3d(kBent[0]) * (a * a * a) + Vec3d(kBent[1]) * (3 * a * a * t) + Vec3d(kBent[2]) * (3 * a * t * t) +
           Vec3d(kBent[3]) * (t * t * t);
  };
  for (int n = 0; n < 2000; ++n) {
    const double u = 0.5 + 0.45 * uniform(random);
    const Vec3d d = Vec3d(uniform(random), uniform(random), uniform(random)).normalized();
    const Vec3d tangent = (at(u + 1e-4) - at(u - 1e-4)).normalized(), side = d.cross(tangent);
    if (side.length() < 0.3) continue;  // Seen along itself, it may cover itself.
    CurveHit h{};
    ASSERT_TRUE(s.hit(at(u) + side.normalized() * 0.04 - d * 9, d, h)) << u;
    // Nearest to the line, by search.
    double nearest = 1;
    for (int k = 0; k <= 2000; ++k) {
      const Vec3d q = at(k / 2000.0) - at(u) - side.normalized() * 0.052;
      nearest = std::min(nearest, (q - d * q.dot(d)).length());
    }
    if (nearest > 0.0515) { EXPECT_FALSE(s.hit(at(u) + side.normalized() * 0.052 - d * 9, d, h)) << u; }
  }
}

TEST(Curve, PlacementScalesWidthsAndBoundsHold) {
  Segment s(kBent, 0.1f, 0.3f);
  Mat4d m = Mat4d().scale(Vec3d(3, 0.5, -1)) * Mat4d().rotate(Vec3d(0.3, 1, 2)) * Mat4d().translate(Vec3d(5, -6, 7));
  s.place(m);
  const Segment plain(kBent, 0.1f, 0.3f);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform(-1, 1);
  int hits = 0;
  for (int n = 0; n < 20000; ++n) {
    const Vec3d o(8 * uniform(random), 8 * uniform(random), 8);
    const Vec3d d = Vec3d(3 * uniform(random) + 1.5, uniform(random), 0.5) - o;
    CurveHit a{}, b{};
    if (!plain.hit(o, d, a)) continue;
    hits += s.hit(transform_point(m, o), transform_vector(m, d), b) && std::abs(a.t - b.t) < 1e-4 &&
            std::abs(a.v - b.v) < 1e-2f;
    const Vec3d p = transform_point(m, o + a.t * d);
    bool inside = false;
    for (size_t piece = 0; piece < s.view.piece_count(); ++piece) inside |= curve_bounds(s.view, piece).intersects(p);
    EXPECT_TRUE(inside);
    --hits;
  }
  EXPECT_GE(hits, -2);  // All but a few at the very edge.
}

TEST(Curve, RibbonsNarrowAsTheyTurnAway) {
  // From facing +z to facing +y: half way they are seen at 45 degrees.
  const float k = 0.5523f;
  const Segment s(kStraight, 0.4f, 0.4f, {{0, 0, 1}, {0, k, 1}, {0, 1, k}, {0, 1, 0}});
  CurveHit h{};
  for (const double u : {0.1, 0.5, 0.8}) {
    const double half = 0.2 * std::cos(u * M_PI / 2);
    EXPECT_TRUE(s.hit({3 * u, half - 1e-4, 5}, {0, 0, -1}, h));
    EXPECT_FALSE(s.hit({3 * u, half + 1e-4, 5}, {0, 0, -1}, h));
    const Vec3d n = ribbon_normal(s.normals.data(), u);
    EXPECT_NEAR(n.y, std::sin(u * M_PI / 2), 1e-4);
    EXPECT_NEAR(n.length(), 1, 1e-6);
  }
  const float same[12] = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
  EXPECT_EQ(ribbon_normal(same, 0.3), Vec3d(0, 0, 1));
}

TEST(Curve, NothingIsHitOutsideTheInterval) {
  const Segment s(kStraight, 0.4f, 0.4f);
  CurveHit h{};
  EXPECT_FALSE(s.hit({1, 0, 5}, {0, 0, -1}, h, 0, 4.99f));
  EXPECT_TRUE(s.hit({1, 0, 5}, {0, 0, -1}, h, 4.99f, 5.01f));
  EXPECT_FALSE(s.hit({1, 0, 5}, {0, 0, -1}, h, 5.01f));
  // What starts within its width and close to it is stopped all the same.
  EXPECT_TRUE(s.hit({1, 0.1, 0.01}, {0, 0, -1}, h));
}

TEST(Curve, DegenerateOnesAreMissedNotNaN) {
  CurveHit h{};
  EXPECT_FALSE(Segment({4, Vec3f(1, 1, 1)}, 0.4f, 0.4f).hit({1, 1, 5}, {0, 0, -1}, h));
  EXPECT_FALSE(Segment(kStraight, 0, 0).hit({1, 0, 5}, {0, 0, -1}, h));
  const Segment along({{0, 0, 0}, {0, 0, 1}, {0, 0, 2}, {0, 0, 3}}, 0.4f, 0.4f);
  if (along.hit({0, 0, 5}, {0, 0, -1}, h)) { EXPECT_TRUE(std::isfinite(h.t) && h.u >= 0 && h.u <= 1); }
}

TEST(Curve, HitsThroughTheRayTracerNameTheirSegment) {
  std::vector<float> points;
  for (int s = 0; s < 3; ++s) {
    for (int i = 0; i < 4; ++i) points.insert(points.end(), {static_cast<float>(3 * s + i), 0, 0, 0.1f});
  }
  CurveView view;
  view.control_points = points.data(), view.segment_count = 3, view.split_depth = 2;
  Accel accel{AccelOptions{}};
  accel.add_curves(Accel::kWorld, view, 7, nullptr);
  ASSERT_EQ(accel.build(), "");
  constexpr int kRays = 40;
  float ox[kRays], zero[kRays] = {}, oz[kRays], dz[kRays], t[kRays], u[kRays], v[kRays];
  int32_t shape[kRays], instance[kRays];
  uint32_t prim[kRays];
  uint8_t blocked[kRays];
  for (int i = 0; i < kRays; ++i) ox[i] = 0.125f + 0.25f * static_cast<float>(i), oz[i] = 4, dz[i] = -1;
  const RayLanes rays{kRays, {ox, zero, oz}, {zero, zero, dz}};
  accel.intersect(rays, {t, shape, prim, instance, u, v}, true);
  accel.occluded(rays, blocked);
  for (int i = 0; i < kRays; ++i) {
    const bool on = ox[i] < 9;
    EXPECT_EQ(shape[i], on ? 7 : -1) << i;
    EXPECT_EQ(blocked[i], on) << i;
    if (!on) continue;
    EXPECT_EQ(prim[i], static_cast<uint32_t>(ox[i] / 3));
    EXPECT_NEAR(u[i], ox[i] / 3 - static_cast<float>(prim[i]), 1e-5);
    EXPECT_NEAR(v[i], 0.5, 1e-5);
    EXPECT_FLOAT_EQ(t[i], 4);
  }
}

TEST(Curve, AnInstanceIsTracedCoherentlyWithoutEnd) {
  const Segment s(kStraight, 0.4f, 0.4f);
  Accel accel{AccelOptions{}};
  const int group = accel.add_group();
  accel.add_curves(group, s.view, 0, nullptr);
  accel.add_instance(group, {{{2, 0, 0, 0, 2, 0, 0, 0, 2, 1, 0, 0}}});  // Twice as large, from x = 1 to 7.
  ASSERT_EQ(accel.build(), "");
  constexpr int kRays = 32;
  float ox[kRays], oy[kRays], zero[kRays] = {}, oz[kRays], dz[kRays], t[kRays], u[kRays], v[kRays];
  int32_t shape[kRays], instance[kRays];
  uint32_t prim[kRays];
  uint8_t blocked[kRays];
  for (int i = 0; i < kRays; ++i) {
    ox[i] = 0.125f + 0.25f * static_cast<float>(i), oy[i] = 0.3f, oz[i] = 4, dz[i] = -1;
  }
  const RayLanes rays{kRays, {ox, oy, oz}, {zero, zero, dz}};
  accel.occluded(rays, blocked);
  accel.intersect(rays, {t, shape, prim, instance, u, v}, true);
  for (int i = 0; i < kRays; ++i) {
    const bool on = ox[i] > 1 && ox[i] < 7;
    EXPECT_EQ(blocked[i], on) << i;
    EXPECT_EQ(instance[i], on ? 0 : -1) << i;
    if (on) { EXPECT_NEAR(std::abs(v[i] - 0.5f), 0.375, 1e-5); }
  }
}

}  // namespace
}  // namespace whit
