// The lit side of an area light is the side that shines at the camera: under every combination of mirroring,
// ReverseOrientation and kind of shape.
#include <gtest/gtest.h>

#include "core/render/render.h"
#include "tests/scene/scene_text.h"

namespace whit {
namespace {

/// The light around the origin in the plane z = 0, and matte walls at z = -2 and z = 2. `camera` is at (0.1, 0.2, z) and
/// looks along z: at the light from outside of the walls' reach, or, from between light and wall, at the wall.
float seen(const std::string& light, double camera_z, bool looks_up) {
  const std::string text =
      "Film \"image\" \"integer xresolution\" 1 \"integer yresolution\" 1\n"
      "Sampler \"halton\" \"integer pixelsamples\" 4\n"
      "LookAt 0.1 0.2 " +
      std::to_string(camera_z) + "  0.1 0.2 " + std::to_string(camera_z + (looks_up ? 1 : -1)) +
      "  0 1 0\n"
      "Camera \"perspective\" \"float fov\" 1\nWorldBegin\n"
      "AttributeBegin\n" +
      light +
      "\nAttributeEnd\n"
      "Shape \"disk\" \"float radius\" 9 \"float height\" -2\n"
      "Shape \"disk\" \"float radius\" 9 \"float height\" 2\nWorldEnd\n";
  const test::BuiltScene built(text);
  const RenderResult result = render(*built.scene, {});
  EXPECT_EQ(result.statistics.invalid_samples, 0);
  return result.picture.rgb[0];
}

struct Sides {
  bool up, down;
  bool operator==(const Sides&) const = default;
};
std::ostream& operator<<(std::ostream& o, const Sides& s) { return o << (s.up ? "up " : "") << (s.down ? "down" : ""); }

/// The sides on which the light shows to a camera at z = +1 and z = -1.
Sides visible(const std::string& light) { return {seen(light, 1, false) > 0, seen(light, -1, true) > 0}; }
/// The sides on which it lights the wall.
Sides lit(const std::string& light) { return {seen(light, 1, true) > 0, seen(light, -1, false) > 0}; }

constexpr Sides kUp{true, false}, kDown{false, true}, kBoth{true, true}, kNone{false, false};

/// Mirrorings in front of a shape: whether they swap handedness, and whether they turn z around.
struct Placement {
  const char* text;
  bool mirrored;  ///< Swaps handedness.
  bool z_turned;
};
constexpr Placement kPlacements[] = {{"", false, false},
                                     {"Scale -1 1 1\n", true, false},
                                     {"Scale 1 1 -1\n", true, true},
                                     {"Scale -1 1 -1\n", false, true}};

std::string light_of(const Placement& p, bool reverse, const std::string& shape, bool two_sided = false) {
  return "Material \"matte\" \"rgb Kd\" [0 0 0]\n" + std::string(p.text) + (reverse ? "ReverseOrientation\n" : "") +
         "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1]" + (two_sided ? " \"bool twosided\" \"true\"" : "") + "\n" +
         shape;
}

const std::string kSquare =
    "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point P\" [-1 -1 0  1 -1 0  1 1 0  -1 1 0]";

TEST(AreaLightSide, AMeshShinesAlongTheNormalOfItsCornersOrder) {
  // The object-space normal is +z. The rule: the front is the normal made from the corners in their order, as they lie in
  // the world, turned around when ReverseOrientation XOR the transform swaps handedness. Mirroring x alone turns the order
  // of the corners (-z) and swaps handedness (+z again); mirroring z alone leaves corners in z = 0 where they are (+z) and
  // swaps handedness (-z); mirroring both turns the order (-z) and swaps nothing. So the front is up unless z is turned,
  // XOR ReverseOrientation.
  for (const Placement& p : kPlacements) {
    for (const bool reverse : {false, true}) {
      const std::string light = light_of(p, reverse, kSquare);
      const Sides expected = p.z_turned != reverse ? kDown : kUp;
      EXPECT_EQ(visible(light), expected) << light;
      EXPECT_EQ(lit(light), expected) << light;
    }
  }
}

TEST(AreaLightSide, ADiskShinesOnOneSideAndLightsIt) {
  // Its normal is +z, turned around by ReverseOrientation, and carried to -z where z and x are mirrored. Which side a
  // mirroring that swaps handedness makes the front is not this test's business (pbrt-v3's own front there is not the one
  // of a mesh); that the side that glows is the side that lights is.
  for (const Placement& p : kPlacements) {
    for (const bool reverse : {false, true}) {
      const std::string light = light_of(p, reverse, "Shape \"disk\" \"float radius\" 1");
      const Sides side = visible(light);
      EXPECT_NE(side.up, side.down) << light;
      EXPECT_EQ(lit(light), side) << light;
      if (!p.mirrored) { EXPECT_EQ(side, p.z_turned != reverse ? kDown : kUp) << light; }
    }
  }
}

TEST(AreaLightSide, MeshesWithNormalsShineWhereTheyAreSeenToShine) {
  // Normals along the triangle's own, against it, and slanting; whichever side it is, it is one, and the same for both.
  for (const char* n : {"0 0 1", "0 0 -1", "0.6 0 0.8"}) {
    std::string shape = kSquare + " \"normal N\" [";
    for (int i = 0; i < 4; ++i) shape += std::string(n) + "  ";
    shape += "]";
    for (const Placement& p : kPlacements) {
      for (const bool reverse : {false, true}) {
        const std::string light = light_of(p, reverse, shape);
        const Sides side = visible(light);
        EXPECT_NE(side.up, side.down) << light;
        EXPECT_EQ(lit(light), side) << light;
        // ReverseOrientation turns it around.
        EXPECT_NE(visible(light_of(p, !reverse, shape)), side) << light;
      }
    }
  }
}

TEST(AreaLightSide, ASphereShinesOutwardsOrInwards) {
  // A small sphere is seen from outside and lights the walls outside, or neither; one of radius 3 with camera and walls
  // inside is seen from z = 2.5, beyond the wall at 2, and lights the walls, or neither; exactly one of the two shines.
  const std::string large = "Shape \"sphere\" \"float radius\" 3";
  const std::string small = "Shape \"sphere\" \"float radius\" 0.5";
  for (const Placement& p : kPlacements) {
    for (const bool reverse : {false, true}) {
      const std::string outside = light_of(p, reverse, small), inside = light_of(p, reverse, large);
      const bool outwards = visible(outside) == kBoth;
      EXPECT_EQ(visible(outside), outwards ? kBoth : kNone) << outside;
      EXPECT_EQ(lit(outside), outwards ? kBoth : kNone) << outside;
      EXPECT_EQ(seen(inside, 2.5, true), outwards ? 0 : 1) << inside;
      EXPECT_EQ(lit(inside), outwards ? kNone : kBoth) << inside;
      if (!p.mirrored) { EXPECT_EQ(outwards, !reverse) << outside; }
    }
  }
}

TEST(AreaLightSide, AnEmitterWithAlphaZeroLightsUnseen) {
  for (const bool reverse : {false, true}) {
    const std::string light = light_of(kPlacements[0], reverse, kSquare + " \"float alpha\" 0");
    EXPECT_EQ(lit(light), lit(light_of(kPlacements[0], reverse, kSquare)));
    // What a camera behind it sees is the wall in front, and from farther away a little more of it.
    EXPECT_NEAR(seen(light, 1, false), seen(light, -1, false), 0.002);
    EXPECT_NEAR(seen(light, -1, true), seen(light, 1, true), 0.002);
  }
}

TEST(AreaLightSide, TwoSidedMeansBoth) {
  for (const Placement& p : kPlacements) {
    for (const std::string& shape : {kSquare, std::string("Shape \"disk\" \"float radius\" 1")}) {
      EXPECT_EQ(visible(light_of(p, true, shape, true)), kBoth);
      EXPECT_EQ(lit(light_of(p, true, shape, true)), kBoth);
    }
  }
}

}  // namespace
}  // namespace whit
