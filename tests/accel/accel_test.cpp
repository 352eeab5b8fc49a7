// The ray tracer on geometry whose hits can be written down: two triangles of a unit square, boxes as analytic shapes,
// instances, motion, occlusion, alpha tests.
#include "core/accel/accel.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "core/accel/embree.h"
#include "core/accel/replay.h"
#include "tests/accel/instruction_sets.h"

namespace whit {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Traversal that never ends is a failure in a minute, not after the test runner's patience.
[[maybe_unused]] const unsigned kGuard = alarm(60);

/// n rays, alike but for what a test changes, and their hits.
struct Rays {
  std::vector<float> o[3], d[3], t_max, time, t, u, v;
  std::vector<int32_t> shape, instance;
  std::vector<uint32_t> prim;
  std::vector<uint8_t> blocked;
  explicit Rays(size_t n)
      : t_max(n, kInfinity), time(n, 0.0f), t(n), u(n), v(n), shape(n), instance(n), prim(n), blocked(n) {
    for (int c = 0; c < 3; ++c) o[c].resize(n), d[c].resize(n);
  }
  Rays(std::initializer_list<std::pair<Vec3f, Vec3f>> list) : Rays(list.size()) {
    size_t i = 0;
    for (const auto& [from, to] : list) set(i++, from, to);
  }
  void set(size_t i, const Vec3f& from, const Vec3f& to) {
    for (int c = 0; c < 3; ++c) o[c][i] = from[c], d[c][i] = to[c];
  }
  RayLanes lanes() {
    return {static_cast<int>(t.size()),
            {o[0].data(), o[1].data(), o[2].data()},
            {d[0].data(), d[1].data(), d[2].data()},
            t_max.data(),
            time.data()};
  }
  Hits hits() { return {t.data(), shape.data(), prim.data(), instance.data(), u.data(), v.data()}; }
  void intersect(const Accel& accel, bool coherent = false) { accel.intersect(lanes(), hits(), coherent); }
  void occlude(const Accel& accel) { accel.occluded(lanes(), blocked.data()); }
};

/// The square [0,1]^2 in z = 0 as two triangles; the float of padding at the end is not a number.
struct Square {
  float positions[13] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, NAN};
  uint32_t indices[6] = {0, 1, 2, 0, 2, 3};
  MeshView view() const { return {positions, 4, indices, 2}; }
};

/// A plane z = height of infinite extent in x and y as far as its bounds go: the simplest analytic shape.
class Plate final : public AnalyticShape {
 public:
  explicit Plate(double extent) : half_(extent) {}
  Box3d object_bounds() const override { return {Vec3d(-half_, -half_, 0), Vec3d(half_, half_, 0)}; }
  void intersect(const ObjectRays& r) const override {
    for (int i = 0; i < r.n; ++i) {
      const double t = -r.oz[i] / r.dz[i], x = r.ox[i] + t * r.dx[i], y = r.oy[i] + t * r.dy[i];
      if (t > r.t_min[i] && t < r.t[i] && std::abs(x) <= half_ && std::abs(y) <= half_) r.t[i] = t;
    }
  }
  void surfaces(SurfacePointLanes&) const override {}
  ShapeSample sample_area(double, double) const override { return {}; }

 private:
  double half_;
};

Affine affine(float scale, const Vec3f& move) {
  return {{scale, 0, 0, 0, scale, 0, 0, 0, scale, move.x, move.y, move.z}};
}

constexpr float kDiagonal = 0.70710678f;

TEST(Accel, TrianglesAreHitWhereTheyAre) {
  const Square square;
  for (const bool robust : {true, false}) {
    Accel accel({.robust = robust, .small_scene = 0});
    accel.add_mesh(Accel::kWorld, square.view(), 7, nullptr);
    ASSERT_EQ(accel.build(), "");
    for (const bool coherent : {true, false}) {
      // Right of the diagonal is triangle 0 (corners (0,0), (1,0), (1,1)): (0.75, 0.25) = 0.5 (1,0) + 0.25 (1,1) + 0.25 (0,0).
      // Left of it is triangle 1, (0,0), (1,1), (0,1): (0.25, 0.75) = 0.25 (1,1) + 0.5 (0,1) + 0.25 (0,0).
      Rays rays{{{0.75f, 0.25f, 2}, {0, 0, -1}},
                {{0.25f, 0.75f, -3}, {0, 0, 1}},
                {{1.5f, 0.5f, 1}, {0, 0, -1}},
                {{0.5f, 0.25f, 1}, {0, 0, 1}},
                {{0.75f, 0.25f + 1, 1}, {0, -kDiagonal, -kDiagonal}}};
      rays.intersect(accel, coherent);
      EXPECT_EQ(rays.shape, (std::vector<int32_t>{7, 7, -1, -1, 7}));
      EXPECT_FLOAT_EQ(rays.t[0], 2);
      EXPECT_FLOAT_EQ(rays.t[1], 3);
      EXPECT_NEAR(rays.t[4], std::sqrt(2.0f), 1e-6f);
      EXPECT_EQ(rays.prim[0], 0u);
      EXPECT_EQ(rays.prim[1], 1u);
      EXPECT_FLOAT_EQ(rays.u[0], 0.5f);
      EXPECT_FLOAT_EQ(rays.v[0], 0.25f);
      EXPECT_FLOAT_EQ(rays.u[1], 0.25f);
      EXPECT_FLOAT_EQ(rays.v[1], 0.5f);
      EXPECT_EQ(rays.instance[0], -1);
    }
  }
}

TEST(Accel, FewAndManyAnalyticShapesAreMetAmongTriangles) {
  // A square at z = 0 and plates above each other at z = 1, 2, ...: up to 8 are looked for one by one, more by the box
  // around all. Rays fall from above and meet the uppermost, rise from z = 0.5 and meet the lowest, and pass beside.
  const Square square;
  for (const int plates : {1, 8, 9, 30}) {
    Accel accel({.robust = true, .small_scene = 0});
    accel.add_mesh(Accel::kWorld, square.view(), 0, nullptr);
    std::vector<Plate> all(static_cast<size_t>(plates), Plate(0.5));
    for (int k = 0; k < plates; ++k) {
      Plate& plate = all[static_cast<size_t>(k)];
      plate.place(Mat4d().setTranslation(Vec3d(0.5, 0.5, k + 1)), false);
      accel.add_analytic(Accel::kWorld, plate, k + 1, nullptr);
    }
    ASSERT_EQ(accel.build(), "");
    for (const bool coherent : {true, false}) {
      Rays rays(100);
      const auto x = [](size_t i) { return (static_cast<float>(i) + 0.5f) / 100; };
      for (size_t i = 0; i < 100; ++i) {
        if (i % 3 == 0) rays.set(i, {x(i), 0.25f, 100}, {0, 0, -1});
        if (i % 3 == 1) rays.set(i, {x(i), 0.25f, 0.5f}, {0, 0, 1});
        if (i % 3 == 2) rays.set(i, {2 + x(i), 0.25f, 100}, {0, 0, -1});
        rays.t_max[i] = i % 2 ? kInfinity : 0.25f;  // too short to be blocked
      }
      rays.occlude(accel);
      for (size_t i = 0; i < 100; ++i) EXPECT_EQ(rays.blocked[i], i % 3 != 2 && i % 2 ? 1 : 0) << plates << " " << i;
      rays.t_max.assign(100, kInfinity);
      rays.intersect(accel, coherent);
      for (size_t i = 0; i < 100; ++i) {
        EXPECT_EQ(rays.shape[i], i % 3 == 0 ? plates : i % 3 == 1 ? 1 : -1) << plates << " " << i;
        EXPECT_EQ(rays.instance[i], -1);
        if (i % 3 == 0) { EXPECT_FLOAT_EQ(rays.t[i], static_cast<float>(100 - plates)); }
      }
    }
  }
}

/// What tracing every ray by itself says, without looking at groups.
std::vector<uint8_t> traced_one_by_one(const Accel& accel, Rays& rays) {
  std::vector<uint8_t> blocked(rays.t.size());
  EmbreeQuery query(false);
  for (size_t i = 0; i < blocked.size(); ++i) {
    for (void* scene : accel.embree_scenes()) {
      RTCRay r{};
      r.org_x = rays.o[0][i], r.org_y = rays.o[1][i], r.org_z = rays.o[2][i];
      r.dir_x = rays.d[0][i], r.dir_y = rays.d[1][i], r.dir_z = rays.d[2][i];
      r.tfar = rays.t_max[i], r.mask = ~0u;
      query.trace(nullptr, static_cast<RTCScene>(scene), r);
      blocked[i] |= r.tfar < 0;
    }
  }
  return blocked;
}

TEST(Accel, GroupsInTheClearAreFreeRayByRay) {
  // Floors of all slopes, whose rays leave by a few roundings, a cloud of triangles over them, and a plate: a picture must
  // not depend on whether its rays were traced or known to be in the clear.
  std::mt19937 random(3);
  std::uniform_real_distribution<float> u(-1, 1);
  int clear = 0, free_rays = 0, blocked_rays = 0;
  for (int round = 0; round < 200; ++round) {
    const float slope = u(random), far = 4 + 40 * std::abs(u(random));
    const auto height = [slope](float x) { return slope * x; };
    std::vector<float> floor;
    for (const auto& [x, y] : {std::pair(-8.0f, -8.0f), {8.0f, -8.0f}, {8.0f, 8.0f}, {-8.0f, 8.0f}})
      floor.insert(floor.end(), {x, y, height(x)});
    std::vector<uint32_t> quad{0, 1, 2, 0, 2, 3}, cloud_indices;
    std::vector<float> cloud;
    for (uint32_t i = 0; i < 300; ++i) {
      const Vec3f at(4 * u(random), 4 * u(random), 10 + 3 * u(random));
      for (int k = 0; k < 3; ++k) {
        for (int c = 0; c < 3; ++c) cloud.push_back(at[c] + 0.2f * u(random));
        cloud_indices.push_back(3 * i + static_cast<uint32_t>(k));
      }
    }
    floor.push_back(0), cloud.push_back(0);
    Plate plate(0.5);
    plate.place(Mat4d().setTranslation(Vec3d(3, 0, 9)), false);
    Accel accel({.robust = true, .small_scene = 0});
    accel.add_mesh(Accel::kWorld, {floor.data(), 4, quad.data(), 2}, 0, nullptr);
    accel.add_mesh(Accel::kWorld, {cloud.data(), 900, cloud_indices.data(), 300}, 1, nullptr);
    accel.add_analytic(Accel::kWorld, plate, 2, nullptr);
    ASSERT_EQ(accel.build(), "");
    const Vec3f lamp(6 * u(random), 6 * u(random), far);
    Rays rays(300);
    for (size_t i = 0; i < 300; ++i) {
      // Stretches of 64 leave from one patch.
      const float patch = static_cast<float>(i / 64) - 2, x = patch + 0.3f * u(random), y = 0.3f * u(random);
      const Vec3f from(x, y, height(x) + 2e-6f), to = lamp + Vec3f(u(random), u(random), u(random)) * 0.5f;
      const Vec3f way = to - from;
      const float distance = std::sqrt(way.dot(way));
      rays.set(i, from, way * (1 / distance));
      rays.t_max[i] = round % 4 ? distance : kInfinity;
    }
    clear += accel.occluded(rays.lanes(), rays.blocked.data());
    EXPECT_EQ(rays.blocked, traced_one_by_one(accel, rays)) << round;
    for (const uint8_t b : rays.blocked) ++(b ? blocked_rays : free_rays);
  }
  EXPECT_GT(clear, 1000);
  EXPECT_GT(free_rays - clear, 5000);
  EXPECT_GT(blocked_rays, 500);
}

TEST(Accel, NothingAtAllIsHitByNothing) {
  Accel accel({.robust = true, .small_scene = 0});
  ASSERT_EQ(accel.build(), "");
  Rays rays{{{0, 0, 1}, {0, 0, -1}}};
  rays.intersect(accel);
  rays.occlude(accel);
  EXPECT_EQ(rays.shape[0], -1);
  EXPECT_EQ(rays.blocked[0], 0);
}

TEST(Accel, EveryLaneOfAnyNumberOfRaysIsItsOwn) {
  // Ray i meets the square at x = (i + 0.5) / n when i is even, and passes beside it when odd; t is 1 + i.
  const Square square;
  Accel accel({.robust = true, .small_scene = 0});
  accel.add_mesh(Accel::kWorld, square.view(), 3, nullptr);
  ASSERT_EQ(accel.build(), "");
  for (const size_t n : {1, 2, 7, 15, 16, 17, 33, 100}) {
    for (const bool coherent : {true, false}) {
      Rays rays(n);
      for (size_t i = 0; i < n; ++i) {
        const float x = (static_cast<float>(i) + 0.5f) / static_cast<float>(n), y = i % 2 ? 1.5f : 0.9f * x;
        rays.set(i, {x, y, 1 + static_cast<float>(i)}, {0, 0, -1});
      }
      rays.intersect(accel, coherent);
      rays.occlude(accel);
      for (size_t i = 0; i < n; ++i) {
        EXPECT_EQ(rays.shape[i], i % 2 ? -1 : 3) << i << " of " << n;
        EXPECT_EQ(rays.blocked[i], i % 2 ? 0 : 1) << i << " of " << n;
        EXPECT_FLOAT_EQ(rays.t[i], i % 2 ? kInfinity : 1 + static_cast<float>(i));
      }
    }
  }
}

TEST(Accel, TheNearestOfMeshAndAnalyticShapeWins) {
  const Square square;  // at z = 0
  Plate above(5), below(5);
  above.place(Mat4d().setTranslation(Vec3d(0, 0, 1)), false);
  below.place(Mat4d().setTranslation(Vec3d(0, 0, -1)), false);
  Accel accel({.robust = true, .small_scene = 0});
  accel.add_mesh(Accel::kWorld, square.view(), 0, nullptr);
  accel.add_analytic(Accel::kWorld, above, 1, nullptr);
  accel.add_analytic(Accel::kWorld, below, 2, nullptr);
  ASSERT_EQ(accel.build(), "");
  Rays rays{{{0.5f, 0.25f, 3}, {0, 0, -1}},
            {{0.5f, 0.25f, 0.5f}, {0, 0, -1}},
            {{2, 2, 0.5f}, {0, 0, -1}},
            {{0.5f, 0.25f, -3}, {0, 0, 1}},
            {{9, 9, 3}, {0, 0, -1}}};
  rays.intersect(accel);
  EXPECT_EQ(rays.shape, (std::vector<int32_t>{1, 0, 2, 2, -1}));
  EXPECT_FLOAT_EQ(rays.t[0], 2);
  EXPECT_FLOAT_EQ(rays.t[1], 0.5f);
  EXPECT_FLOAT_EQ(rays.t[2], 1.5f);
  EXPECT_FLOAT_EQ(rays.t[3], 2);
}

/// 37 rays, no multiple of any packet's width, down from z = 3 onto the square and a plate above a part of it. Some are
/// of the kinds that rounding makes of honest ones; those hit nothing.
struct OddRays {
  Rays rays{37};
  std::vector<size_t> bad{0, 5, 9, 11, 15, 16, 20, 23, 31, 36};

  OddRays() {
    for (size_t i = 0; i < 37; ++i) rays.set(i, {x(i), 0.45f, 3}, {0, 0, -1});
    rays.t_max[0] = -1, rays.t_max[9] = -kInfinity, rays.t_max[36] = NAN;
    rays.o[0][5] = NAN, rays.o[1][11] = kInfinity, rays.o[2][15] = 1e19f;
    rays.d[2][16] = 0, rays.d[2][20] = INFINITY, rays.d[0][23] = NAN, rays.d[1][31] = -3e38f;
  }
  static float x(size_t i) { return (static_cast<float>(i) + 0.5f) / 37; }
  bool is_good(size_t i) const { return std::find(bad.begin(), bad.end(), i) == bad.end(); }
};

/// The square, and a plate 1 above the middle of it.
struct SquareAndPlate {
  Square square;
  Plate plate{0.2};
  Accel accel;
  explicit SquareAndPlate(const std::string& set) : accel({.robust = true, .small_scene = 0, .embree = set}) {
    plate.place(Mat4d().setTranslation(Vec3d(0.5, 0.5, 1)), false);
    accel.add_mesh(Accel::kWorld, square.view(), 0, nullptr);
    accel.add_analytic(Accel::kWorld, plate, 1, nullptr);
    EXPECT_EQ(accel.build(), "") << set;
  }
};

TEST(Accel, EveryInstructionSetFindsTheSame) {
  // Embree takes packets apart that are wider than the processor's vectors, and then looks at lanes that are switched off.
  for (const std::string& set : test::instruction_sets()) {
    const SquareAndPlate scene(set);
    for (const bool coherent : {false, true}) {
      OddRays odd;
      Rays& rays = odd.rays;
      rays.intersect(scene.accel, coherent);
      rays.occlude(scene.accel);
      for (size_t i = 0; i < 37; ++i) {
        const bool on_plate = std::abs(OddRays::x(i) - 0.5f) < 0.2f;
        EXPECT_EQ(rays.shape[i], !odd.is_good(i) ? -1 : on_plate ? 1 : 0) << set << " ray " << i;
        EXPECT_EQ(rays.blocked[i], odd.is_good(i) ? 1 : 0) << set << " ray " << i;
        if (odd.is_good(i)) { EXPECT_FLOAT_EQ(rays.t[i], on_plate ? 2 : 3) << set << " ray " << i; }
      }
    }
  }
}

/// Leaves NaNs where the next functions will have their variables.
[[gnu::noinline]] void spoil_stack() {
  volatile float numbers[16384];
  for (volatile float& n : numbers) n = NAN;
}

TEST(Accel, EveryInstructionSetReplaysARecord) {
  // What a lane beyond a batch's end holds must not matter: Embree ends the program for rays that are not finite.
  for (const std::string& set : test::instruction_sets()) {
    SquareAndPlate scene(set);
    RayRecord record;
    scene.accel.record(&record);
    for (const int n : {37, 1, 16, 8, 5, 24}) {
      OddRays odd;
      RayLanes lanes = odd.rays.lanes();
      lanes.n = n;
      scene.accel.intersect(lanes, odd.rays.hits(), true);
      scene.accel.intersect(lanes, odd.rays.hits(), false);
      scene.accel.occluded(lanes, odd.rays.blocked.data());
    }
    scene.accel.record(nullptr);
    for (const RayKind kind : {RayKind::Camera, RayKind::Secondary, RayKind::Shadow}) {
      // Of the first 37, 1, 16, 8, 5 and 24 rays 9, 1, 5, 2, 1 and 7 are left out: the odd ones but number 16, which has no
      // direction, and goes nowhere.
      EXPECT_EQ(record.count(kind), 91 - 25) << set;
      for (const RayCall call : kRayCalls) {
        if (!is_usable(scene.accel, kind, call)) continue;
        spoil_stack();
        EXPECT_GE(replay_seconds(scene.accel, record, kind, call), 0) << set;
      }
    }
  }
}

TEST(Accel, OcclusionEndsAtTMax) {
  const Square square;
  Plate plate(1);
  plate.place(Mat4d().setTranslation(Vec3d(10, 0, 0)), false);
  Accel accel({.robust = true, .small_scene = 0});
  accel.add_mesh(Accel::kWorld, square.view(), 0, nullptr);
  accel.add_analytic(Accel::kWorld, plate, 1, nullptr);
  ASSERT_EQ(accel.build(), "");
  Rays rays{{{0.5f, 0.25f, 2}, {0, 0, -1}},
            {{0.5f, 0.25f, 2}, {0, 0, -1}},
            {{10, 0, 2}, {0, 0, -1}},
            {{10, 0, 2}, {0, 0, -1}},
            {{0.5f, 0.25f, 2}, {0, 0, 1}}};
  rays.t_max = {2.01f, 1.99f, 2.01f, 1.99f, kInfinity};
  rays.occlude(accel);
  EXPECT_EQ(rays.blocked, (std::vector<uint8_t>{1, 0, 1, 0, 0}));
}

TEST(Accel, InstancesPlaceTheirGroup) {
  const Square square;
  Plate plate(0.5);
  plate.place(Mat4d().setTranslation(Vec3d(0.5, 0.5, -1)), false);
  Accel accel({.robust = true, .small_scene = 0});
  const int group = accel.add_group();
  accel.add_mesh(group, square.view(), 4, nullptr);
  accel.add_analytic(group, plate, 5, nullptr);
  EXPECT_EQ(accel.add_instance(group, {affine(1, {10, 0, 0})}), 0);
  EXPECT_EQ(accel.add_instance(group, {affine(3, {20, 0, 1})}), 1);
  ASSERT_EQ(accel.build(), "");
  // Nothing at the group's own place; the first instance's mesh at z = 0; the second's at z = 1, three times as large, with
  // the plate at 1 - 3 = -2, seen from below.
  Rays rays{{{0.5f, 0.25f, 9}, {0, 0, -1}},
            {{10.75f, 0.25f, 9}, {0, 0, -1}},
            {{22.25f, 0.75f, 9}, {0, 0, -1}},
            {{22.25f, 0.75f, -9}, {0, 0, 1}}};
  rays.intersect(accel);
  EXPECT_EQ(rays.shape, (std::vector<int32_t>{-1, 4, 4, 5}));
  EXPECT_EQ(rays.instance[1], 0);
  EXPECT_EQ(rays.instance[2], 1);
  EXPECT_EQ(rays.instance[3], 1);
  EXPECT_FLOAT_EQ(rays.t[1], 9);
  EXPECT_FLOAT_EQ(rays.t[2], 8);
  EXPECT_FLOAT_EQ(rays.t[3], 7);
  // (0.75, 0.25) of the square again, whatever the instance's scale.
  EXPECT_NEAR(rays.u[2], 0.5f, 1e-6f);
  EXPECT_NEAR(rays.v[2], 0.25f, 1e-6f);
  for (const bool coherent : {false, true}) {
    rays.intersect(accel, coherent);
    EXPECT_EQ(rays.shape, (std::vector<int32_t>{-1, 4, 4, 5}));
  }
  rays.occlude(accel);
  EXPECT_EQ(rays.blocked, (std::vector<uint8_t>{0, 1, 1, 1}));
}

TEST(Accel, ManyRaysMeetOverlappingInstances) {
  // Five instances beside each other whose boxes overlap, and 1, 5 or 16 rays each from a point above to a point below:
  // two plates a unit apart stand in every one of them, so nothing gets through. It must come to an end.
  Plate low(0.5), high(0.5);
  low.place(Mat4d(), false);
  high.place(Mat4d().setTranslation(Vec3d(0, 0, 1)), false);
  Accel accel({.robust = true, .small_scene = 0});
  const int group = accel.add_group();
  accel.add_analytic(group, low, 1, nullptr);
  accel.add_analytic(group, high, 2, nullptr);
  for (int i = 0; i < 5; ++i) accel.add_instance(group, {affine(1.2f, {static_cast<float>(i), 0, 0})});
  ASSERT_EQ(accel.build(), "");
  for (const size_t n : {1, 5, 16}) {
    Rays rays(n);
    for (size_t i = 0; i < n; ++i) {
      const float x = 4 * (static_cast<float>(i) + 0.5f) / static_cast<float>(n);
      rays.set(i, {x, 0.1f, 9}, Vec3f(0.01f, -0.01f, -1).normalized());
    }
    rays.occlude(accel);
    EXPECT_EQ(rays.blocked, std::vector<uint8_t>(n, 1));
    for (const bool coherent : {false, true}) {
      rays.intersect(accel, coherent);
      for (const int32_t shape : rays.shape) EXPECT_EQ(shape, 2);  // the higher one
    }
  }
}

TEST(Accel, MovingInstancesAreWhereTheyAreAtTheRaysTime) {
  const Square square;
  Accel accel({.robust = true, .small_scene = 0});
  const int group = accel.add_group();
  accel.add_mesh(group, square.view(), 0, nullptr);
  // Three keys: x goes 0, 4, 4 at times 0, 0.5, 1.
  accel.add_instance(group, {affine(1, {0, 0, 0}), affine(1, {4, 0, 0}), affine(1, {4, 0, 0})});
  ASSERT_EQ(accel.build(), "");
  Rays rays(5);
  for (size_t i = 0; i < 5; ++i) rays.set(i, {i < 3 ? 2.5f : 4.5f, 0.25f, 1}, {0, 0, -1});
  rays.time = {0, 0.25f, 0.5f, 0.25f, 0.75f};  // at 0.25 it spans [2,3]
  rays.intersect(accel);
  EXPECT_EQ(rays.shape, (std::vector<int32_t>{-1, 0, -1, -1, 0}));
  rays.occlude(accel);
  EXPECT_EQ(rays.blocked, (std::vector<uint8_t>{0, 1, 0, 0, 1}));
}

/// Cuts the half u < 0.4 away; shadow rays meet nothing at all.
class Cut final : public AlphaTest {
 public:
  bool cut(uint32_t, float u, float, const Vec3f&, bool shadow_ray) const override { return shadow_ray || u < 0.4f; }
};

TEST(Accel, AlphaTestsLetRaysThrough) {
  const Square square;
  Plate plate(5);
  plate.place(Mat4d().setTranslation(Vec3d(0, 0, -1)), false);
  const Cut cut;
  Accel accel({.robust = true, .small_scene = 0});
  accel.add_mesh(Accel::kWorld, square.view(), 0, &cut);
  accel.add_analytic(Accel::kWorld, plate, 1, nullptr);
  ASSERT_EQ(accel.build(), "");
  // u is 0.5 at (0.75, 0.25) and 0.25 at (0.5, 0.25) (0.25 (1,0) + 0.25 (1,1) + 0.5 (0,0)), where the plate shows.
  Rays rays{{{0.75f, 0.25f, 1}, {0, 0, -1}}, {{0.5f, 0.25f, 1}, {0, 0, -1}}};
  rays.intersect(accel);
  EXPECT_EQ(rays.shape, (std::vector<int32_t>{0, 1}));
  rays.t_max = {1.5f, 2.5f};
  rays.occlude(accel);
  EXPECT_EQ(rays.blocked, (std::vector<uint8_t>{0, 1}));
}

TEST(Accel, ACrackedEdgeLetsNothingThrough) {
  // Along the diagonal that both triangles share, robust traversal misses nothing.
  const Square square;
  Accel accel({.robust = true, .small_scene = 0});
  accel.add_mesh(Accel::kWorld, square.view(), 0, nullptr);
  ASSERT_EQ(accel.build(), "");
  constexpr size_t kRays = 10000;
  Rays rays(kRays);
  for (size_t i = 0; i < kRays; ++i) {
    const float x = (static_cast<float>(i) + 0.5f) / kRays;
    const Vec3f from(0.3f, 0.9f, 1.7f);
    rays.set(i, from, (Vec3f(x, x, 0) - from).normalized());
  }
  rays.intersect(accel, true);
  size_t missed = 0;
  for (int32_t s : rays.shape) missed += s < 0;
  EXPECT_EQ(missed, 0u);
}

}  // namespace
}  // namespace whit
