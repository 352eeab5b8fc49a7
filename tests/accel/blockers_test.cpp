// Groups of shadow rays that nothing blocks: what is found clear is clear, by brute force in double precision, and what
// anyone would call clear is found.
#include "core/accel/blockers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace whit {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr int kNoShape = -1;

/// Up to a group of rays.
struct Group {
  std::vector<float> o[3], d[3], t_far;
  int n() const { return static_cast<int>(t_far.size()); }
  void add(const Vec3f& from, const Vec3f& to, bool endless = false) {
    const Vec3f way = to - from, dir = way * (1 / std::sqrt(way.dot(way)));
    for (int c = 0; c < 3; ++c) o[c].push_back(from[c]), d[c].push_back(dir[c]);
    t_far.push_back(endless ? kInfinity : std::sqrt(way.dot(way)));
  }
  RayLanes lanes() {
    return {
        n(), {o[0].data(), o[1].data(), o[2].data()}, {d[0].data(), d[1].data(), d[2].data()}, t_far.data(), nullptr};
  }
  bool is_clear(const Blockers& blockers, int unshaded_by = kNoShape) {
    return blockers.are_clear(lanes(), 0, n(), t_far.data(), unshaded_by);
  }
};

/// Triangles one by one.
struct Triangles {
  std::vector<float> positions;
  std::vector<uint32_t> indices;
  void add(const Vec3f& a, const Vec3f& b, const Vec3f& c) {
    for (const Vec3f& p : {a, b, c}) {
      indices.push_back(static_cast<uint32_t>(positions.size() / 3));
      for (int k = 0; k < 3; ++k) positions.push_back(p[k]);
    }
  }
  void add_quad(const Vec3f& corner, const Vec3f& u, const Vec3f& v) {
    add(corner, corner + u, corner + u + v), add(corner, corner + u + v, corner + v);
  }
  MeshView view() const { return {positions.data(), positions.size() / 3, indices.data(), indices.size() / 3}; }
  Vec3d corner(size_t i) const {
    return {static_cast<double>(positions[3 * i]), static_cast<double>(positions[3 * i + 1]),
            static_cast<double>(positions[3 * i + 2])};
  }
  /// Whether the segment from o along d up to t meets a triangle (Moeller and Trumbore 1997).
  bool meet(const Vec3d& o, const Vec3d& d, double t_far) const {
    for (size_t i = 0; i < indices.size(); i += 3) {
      const Vec3d a = corner(i), e1 = corner(i + 1) - a, e2 = corner(i + 2) - a, p = d.cross(e2), to = o - a;
      const double det = e1.dot(p), u = to.dot(p) / det, v = d.dot(to.cross(e1)) / det, t = e2.dot(to.cross(e1)) / det;
      if (u >= 0 && v >= 0 && u + v <= 1 && t > 0 && t < t_far) return true;
    }
    return false;
  }
};

/// Rays from a patch of z = height, one unit wide around the origin, to a lamp one unit wide ten units above.
Group from_floor(float height, bool endless = false) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> u(-0.5f, 0.5f);
  Group rays;
  for (int i = 0; i < Blockers::kGroup; ++i)
    rays.add({u(random), u(random), height}, {u(random), u(random), 10}, endless);
  return rays;
}

constexpr float kAbove = 1e-6f;  ///< By so little rays leave the floor.

TEST(Blockers, AFloorDoesNotBlockTheRaysThatLeaveIt) {
  for (const int pieces : {1, 40}) {  // 2 triangles, each looked at, and 3200 in 50 boxes
    Triangles floor;
    for (int i = 0; i < pieces * pieces; ++i) {
      const float side = 8.0f / static_cast<float>(pieces);
      const auto at = [&](int k) { return static_cast<float>(k) * side - 4; };
      floor.add_quad({at(i % pieces), at(i / pieces), 0}, {side, 0, 0}, {0, side, 0});
    }
    Blockers blockers;
    blockers.add_mesh(floor.view());
    blockers.build();
    for (const bool endless : {false, true}) EXPECT_TRUE(from_floor(kAbove, endless).is_clear(blockers)) << pieces;
    // From below it does.
    EXPECT_FALSE(from_floor(-kAbove).is_clear(blockers)) << pieces;
  }
}

TEST(Blockers, ATiltedFloorIsToldByItsPlane) {
  // The plane z = x / 2, whose box holds all the origins.
  Triangles floor;
  floor.add_quad({-4, -4, -2}, {8, 0, 4}, {0, 8, 0});
  Blockers blockers;
  blockers.add_mesh(floor.view());
  blockers.build();
  Group rays;
  for (int i = 0; i < 60; ++i) {
    const float x = static_cast<float>(i) / 60 - 0.5f;
    rays.add({x, -x, x / 2 + kAbove}, {0.1f * x, 0, 10});
  }
  EXPECT_TRUE(rays.is_clear(blockers));
  rays.add({0, 0, -0.1f}, {0, 0, 10});  // one ray from beneath is enough
  EXPECT_FALSE(rays.is_clear(blockers));
}

TEST(Blockers, WhatIsBetweenBlocksAndWhatIsBesideOrBehindDoesNot) {
  struct Case {
    Vec3f at;
    bool clear;
  };
  // The rays fill a square prism of half width 0.5; the leaf is 0.2 wide. Boxes are exact to roundings.
  const Case cases[] = {{{0.3f, 0, 5}, false},  {{0.49f, 0, 9}, false}, {{0.75f, 0, 5}, true},
                        {{0, -0.75f, 3}, true}, {{0, 0, 10.2f}, true},  {{0, 0, -0.3f}, true}};
  for (const Case& c : cases) {
    for (const bool as_box : {false, true}) {
      Triangles leaf;
      leaf.add(c.at + Vec3f(-0.1f, -0.1f, 0), c.at + Vec3f(0.1f, 0, 0.05f), c.at + Vec3f(0, 0.1f, 0.1f));
      Blockers blockers;
      if (as_box) {
        const Vec3d half(0.1, 0.1, 0.1);
        blockers.add_box(Box3d(Vec3d(c.at) - half, Vec3d(c.at) + half));
      } else {
        blockers.add_mesh(leaf.view());
      }
      blockers.build();
      EXPECT_EQ(from_floor(0).is_clear(blockers), c.clear) << c.at.x << " " << c.at.y << " " << c.at.z;
    }
  }
}

TEST(Blockers, AShapeDoesNotBlockTheRaysThatEndOnIt) {
  Blockers blockers;
  blockers.add_box(Box3d(Vec3d(-0.6, -0.6, 9), Vec3d(0.6, 0.6, 11)), 7);
  blockers.build();
  EXPECT_TRUE(from_floor(0).is_clear(blockers, 7));
  EXPECT_FALSE(from_floor(0).is_clear(blockers, 6));
  EXPECT_FALSE(from_floor(0).is_clear(blockers, kNoShape));
}

TEST(Blockers, NothingBlocksNothing) {
  Blockers blockers;
  blockers.build();
  EXPECT_TRUE(from_floor(0).is_clear(blockers));
}

TEST(Blockers, WhatIsClearMeetsNoTriangle) {
  // Meshes of few large and of many small triangles, and rays between random boxes: no clear group has a ray that meets one.
  std::mt19937 random(7);
  std::uniform_real_distribution<float> u(-1, 1);
  const auto point = [&](const Vec3f& center, float size) {
    return center + Vec3f(u(random), u(random), u(random)) * size;
  };
  int clear = 0, blocked = 0;
  for (int round = 0; round < 400; ++round) {
    Triangles soup;
    const int triangles = round % 2 ? 20 : 400;
    const float size = round % 2 ? 0.5f : 0.05f;
    for (int i = 0; i < triangles; ++i) {
      const Vec3f at = point({0, 0, 0}, 3);
      soup.add(point(at, size), point(at, size), point(at, size));
    }
    Blockers blockers;
    blockers.add_mesh(soup.view());
    blockers.build();
    const Vec3f from = point({0, 0, 0}, 4), to = point({0, 0, 0}, 4);
    const float spread = 0.5f * std::abs(u(random));
    Group rays;
    for (int i = 0; i < Blockers::kGroup - round % 7; ++i) rays.add(point(from, spread), point(to, spread));
    if (!rays.is_clear(blockers)) {
      ++blocked;
      continue;
    }
    ++clear;
    for (size_t i = 0; i < rays.t_far.size(); ++i) {
      const auto wide = [i](const std::vector<float>(&v)[3]) {
        return Vec3d(static_cast<double>(v[0][i]), static_cast<double>(v[1][i]), static_cast<double>(v[2][i]));
      };
      EXPECT_FALSE(soup.meet(wide(rays.o), wide(rays.d), static_cast<double>(rays.t_far[i]))) << round << " ray " << i;
    }
  }
  EXPECT_GT(clear, 40);
  EXPECT_GT(blocked, 40);
}

}  // namespace
}  // namespace whit
