// Which triangles are huge, and how they are parted from their mesh.
#include "core/scene/huge.h"

#include <gtest/gtest.h>

namespace whit {
namespace {

/// A triangle in z = 0 of about the size e, around the origin.
bool is_huge(const CloseUps& around, double e, double x = 0) {
  return around.makes_huge({x - e / 2, -e / 2, 0}, {x + e / 2, -e / 2, 0}, {x, e / 2, 0});
}

CloseUps around(const std::vector<Box3d>& content, const std::vector<Vec3d>& eyes) {
  CloseUps c;
  for (const Box3d& box : content) c.add(box);
  for (const Vec3d& eye : eyes) c.look_from(eye);
  c.sort();
  return c;
}

Box3d box_at(const Vec3d& p, double size) { return {p - Vec3d(size / 2), p + Vec3d(size / 2)}; }

TEST(Huge, BesideTheCamera) {
  // The size is the box's diagonal, sqrt 2 e; 2048 times the distance of 5 is 10240.
  const CloseUps c = around({}, {{0, 0, 5}});
  EXPECT_FALSE(is_huge(c, 7000));
  EXPECT_TRUE(is_huge(c, 8000));
  EXPECT_FALSE(is_huge(c, 8000, 1e6));  // far away from it
}

TEST(Huge, BesideAllTheRestTogether) {
  const CloseUps c = around({box_at({0, 0, 0.5}, 1), box_at({3, 0, 0.5}, 1), box_at({0, 0, 0}, 1e5)}, {{0, 0, 1e4}});
  EXPECT_FALSE(is_huge(c, 5000));
  EXPECT_TRUE(is_huge(c, 7000));  // the two are 4.24 wide together: 2048 times that is 8689
  EXPECT_FALSE(is_huge(c, 7000, 1e5));
}

TEST(Huge, BesideOneTinyThingAmongOthers) {
  const CloseUps c = around({box_at({0, 0, 0}, 0.1), box_at({500, 0, 0}, 1000)}, {{0, 0, 1000}});
  EXPECT_FALSE(is_huge(c, 200));  // a floor in whose scene there is a screw
  EXPECT_TRUE(is_huge(c, 2500));  // more than 16384 of its diagonal of 0.17
}

TEST(Huge, TakenFromItsMesh) {
  const std::vector<double> points = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1e6, 0, 0, 0, 1e6, 0};
  MeshData mesh;
  mesh.positions = points;
  mesh.indices = {0, 1, 2, 1, 3, 4, 2, 1, 0};
  mesh.uvs = {0, 0, 1, 0, 0, 1, 9, 0, 0, 9};
  const std::vector<uint32_t> huge =
      find_huge(mesh, Mat4d(), {Vec3d(0), Vec3d(1e6, 1e6, 0)}, around({}, {{0, 0, 1e4}}));
  ASSERT_EQ(huge, (std::vector<uint32_t>{1}));
  const MeshData taken = take_huge(mesh, huge);
  EXPECT_EQ(mesh.indices, (std::vector<uint32_t>{0, 1, 2, 2, 1, 0}));
  EXPECT_EQ(taken.indices, (std::vector<uint32_t>{0, 1, 2}));
  EXPECT_EQ(std::vector<double>(taken.positions.begin(), taken.positions.end()),
            (std::vector<double>{1, 0, 0, 1e6, 0, 0, 0, 1e6, 0}));
  EXPECT_EQ(taken.uvs, (std::vector<float>{1, 0, 9, 0, 0, 9}));
}

}  // namespace
}  // namespace whit
