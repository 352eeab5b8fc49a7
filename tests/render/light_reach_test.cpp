// Lights that cannot reach a batch of points are skipped, and no picture shows it.
#include "core/render/light_reach.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "core/render/render.h"
#include "tests/scene/scene_text.h"

namespace whit {
namespace {

// ---- Pictures ----

/// How often lights were skipped in a scene, whose picture and shadow rays must not depend on it.
int64_t skipped(const std::string& text) {
  const test::BuiltScene built(text, {}, test::Planned::Warnings::Allowed);
  const RenderResult with = render(*built.scene, {});
  built.scene->skip_lights = false;
  const RenderResult without = render(*built.scene, {});
  EXPECT_TRUE(with.picture.rgb == without.picture.rgb) << text;
  EXPECT_EQ(with.statistics.shadow_rays, without.statistics.shadow_rays) << text;
  EXPECT_EQ(with.statistics.invalid_samples, without.statistics.invalid_samples) << text;
  EXPECT_EQ(without.statistics.lights_skipped, 0);
  return with.statistics.lights_skipped;
}

/// 48 x 48 pixels from (0, 2, -8) at a room of 8 x 8 x 8 whose front is open, with a ball of radius 1 in its middle, all
/// of one material: 9 tiles, of which some see one wall and some several, or the ball.
std::string room(const std::string& lights, const std::string& material) {
  return "Film \"image\" \"integer xresolution\" 48 \"integer yresolution\" 48\n"
         "Sampler \"halton\" \"integer pixelsamples\" 2\n"
         "Integrator \"whitted\" \"integer maxdepth\" 3\n"
         "LookAt 0 2 -8  0 -1 0  0 1 0\nCamera \"perspective\" \"float fov\" 60\nWorldBegin\n" +
         lights + "\n" + material +
         "\nShape \"sphere\" \"float radius\" 1\n"
         "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3  4 5 6 4 6 7  1 2 6 1 6 5  3 2 6 3 6 7  0 3 7 0 7 "
         "4]\n"
         "  \"point P\" [-4 -4 -4  4 -4 -4  4 -4 4  -4 -4 4   -4 4 -4  4 4 -4  4 4 4  -4 4 4]\nWorldEnd\n";
}

const std::string kMatte = "Material \"matte\"";

/// 26 directions: the faces, edges and corners of a cube.
std::vector<Vec3d> directions() {
  std::vector<Vec3d> all;
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = -1; z <= 1; ++z) {
        if (x != 0 || y != 0 || z != 0) all.emplace_back(x, y, z);
      }
    }
  }
  return all;
}

std::string text_of(const Vec3d& v) { return fmt::format("{} {} {}", v.x, v.y, v.z); }

TEST(LightReachPictures, SpotsInAllDirections) {
  for (const char* placement : {"", "Scale 1 -2 0.3\nRotate 30 1 2 3", "Translate 0 3.9 0\nScale -1 1 1"}) {
    for (const double angle : {0.5, 20.0, 89.0, 120.0, 180.0}) {
      std::string lights = "AttributeBegin\n" + std::string(placement);
      for (const Vec3d& d : directions()) {
        lights += fmt::format(
            "\nLightSource \"spot\" \"rgb I\" [9 9 9] \"point from\" [0.1 1.2 -0.3] \"point to\" [{}] \"float "
            "coneangle\" {} \"float conedeltaangle\" {}",
            text_of(Vec3d(0.1, 1.2, -0.3) + d), angle, angle / 3);
      }
      const int64_t n = skipped(room(lights + "\nAttributeEnd", kMatte));
      // 9 tiles of 512 samples are 9 rounds, with 26 lights 234 occasions. A narrow cone ends on one wall, in the one to
      // four tiles that see that place, or where nobody looks: more than half of the occasions are skipped. Where the
      // light is stretched, boxes are long in its space, and less is certain.
      const bool stretched = std::string(placement).find("0.3") != std::string::npos;
      if (angle < 45) { EXPECT_GT(n, stretched ? 0 : 117) << placement << " " << angle; }
    }
  }
}

TEST(LightReachPictures, Projectors) {
  for (const char* turn : {"", "Rotate 90 1 0 0", "Rotate -90 1 0 0\nScale 1 3 1", "Rotate 180 0 1 0\nScale -1 1 1"}) {
    for (const double fov : {10.0, 90.0, 175.0}) {
      const int64_t n =
          skipped(room(fmt::format("AttributeBegin\nTranslate 0 2 -2\n{}\nLightSource \"projection\" \"rgb I\" "
                                   "[9 9 9] \"float fov\" {}\nAttributeEnd",
                                   turn, fov),
                       kMatte));
      // 10 degrees from the middle of the room are a square of 1 on a wall of 8, which is in 4 of the 9 tiles at most.
      if (fov == 10) { EXPECT_GE(n, 5) << turn; }
    }
  }
}

TEST(LightReachPictures, DistantLights) {
  std::string lights;
  for (const Vec3d& d : directions())
    lights += "LightSource \"distant\" \"point from\" [" + text_of(d) + "] \"point to\" [0 0 0]\n";
  skipped(room(lights, kMatte));
}

/// Every emitter: turned 7 ways, placed 4 ways, reversed or not, one- and two-sided.
TEST(LightReachPictures, EmittersTurnedMirroredAndReversed) {
  const std::string square =
      "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point P\" [-1 -1 0  1 -1 0  1 1 0  -1 1 0]";
  const std::vector<std::string> shapes = {
      square,
      square + " \"normal N\" [0 0 1 0.3 0 0.9 0 0 2 0 0 1]",
      square + " \"normal N\" [0 0 -1 0.3 0 -0.9 0 0 -2 0 0 -1]",
      square + " \"normal N\" [0 0 1 0.3 0 0.9 0 0 -1 0 0 -1]",  // the front turns within the triangles
      "Shape \"disk\" \"float radius\" 1 \"float height\" 0.5",
      "Shape \"sphere\" \"float radius\" 0.7",
      "Shape \"cylinder\" \"float radius\" 0.5",
      "Shape \"cone\" \"float radius\" 0.5",
      "Shape \"hyperboloid\" \"point p1\" [0.5 0 0] \"point p2\" [1 0 0]",
  };
  for (const std::string& shape : shapes) {
    int64_t total[3] = {0, 0, 0};
    for (const char* placement : {"", "Scale -1 1 1", "Scale 1 1 -1", "Rotate 20 1 1 0\nScale 0.5 2 -1"}) {
      for (const int flags : {0, 1, 2}) {
        std::string lights;
        for (const char* turn : {"", "Rotate 90 1 0 0", "Rotate -90 1 0 0", "Rotate 90 0 1 0", "Rotate -90 0 1 0",
                                 "Rotate 180 1 0 0", "Rotate 40 1 2 3"}) {
          lights += fmt::format(
              "AttributeBegin\nTranslate 0 2.5 0\n{}\n{}\n{}AreaLightSource \"diffuse\" {}\n{}\nAttributeEnd\n", turn,
              placement, flags == 1 ? "ReverseOrientation\n" : "", flags == 2 ? "\"bool twosided\" \"true\"" : "",
              shape);
        }
        total[flags] += skipped(room(lights, kMatte));
      }
    }
    // What is skipped of a two-sided light, because all of a tile faces away from it, is skipped of a one-sided one too,
    // and so is one that faces up, above a tile that sees nothing but floor.
    if (shape.find("disk") != std::string::npos || shape == square) { EXPECT_GT(total[0], total[2]) << shape; }
  }
}

TEST(LightReachPictures, Materials) {
  std::string lights;
  for (const Vec3d& d : directions()) {
    lights += "LightSource \"spot\" \"rgb I\" [9 9 9] \"point from\" [0.1 -4.5 0] \"point to\" [" +
              text_of(Vec3d(0.1, -4.5, 0) + d) + "]\n";
    lights += "LightSource \"distant\" \"point from\" [" + text_of(d) + "] \"point to\" [0 0 0]\n";
    lights += "LightSource \"point\" \"point from\" [" + text_of(d * 5) + "]\n";
  }
  for (const char* material :
       {"\"matte\" \"float sigma\" 30", "\"plastic\" \"float roughness\" 0.001 \"bool remaproughness\" \"false\"",
        "\"metal\"", "\"substrate\"", "\"uber\" \"rgb opacity\" [0.5 0.5 0.5]", "\"translucent\"", "\"hair\"",
        "\"glass\" \"float uroughness\" 0.3 \"float vroughness\" 0.1",
        "\"disney\" \"float clearcoat\" 1 \"float sheen\" 1 \"float metallic\" 0.5",
        "\"disney\" \"float spectrans\" 0.5 \"float roughness\" 0.4"}) {
    EXPECT_GT(skipped(room(lights, "Material " + std::string(material))), 0) << material;
  }
  // These have no lobe that a light could meet, so none is tried, let alone skipped.
  for (const char* material : {"\"mirror\"", "\"glass\""}) {
    EXPECT_EQ(skipped(room(lights, "Material " + std::string(material))), 0) << material;
  }
}

TEST(LightReachPictures, HairsAndPointsOfMovingShapes) {
  const std::string below =
      "LightSource \"point\" \"point from\" [0 -5 0]\nLightSource \"distant\" \"point from\" [0 -1 0]\n";
  const std::string hair =
      "AttributeBegin\nMaterial \"hair\"\nShape \"curve\" \"point P\" [-3 0 -3  -1 1 -3  1 0 -3  3 1 -3] \"float "
      "width\" "
      "0.8\nAttributeEnd\n";
  const std::string moving =
      "AttributeBegin\nActiveTransform EndTime\nTranslate 0 3 0\nActiveTransform All\nShape \"sphere\"\nAttributeEnd\n";
  EXPECT_GT(skipped(room(below + hair + moving, kMatte)), 0);
}

// ---- Counts ----

/// 16 x 16 pixels of 4 samples: one tile, one chunk and one batch of 1024, all on the disk in the plane y = 0, seen from
/// above. So a light is skipped once, or not at all.
int64_t skipped_above_floor(const std::string& light, const std::string& material = kMatte) {
  return skipped(
      "Film \"image\" \"integer xresolution\" 16 \"integer yresolution\" 16\n"
      "Sampler \"halton\" \"integer pixelsamples\" 4\n"
      "LookAt 0 5 0  0 0 0  0 0 1\nCamera \"perspective\" \"float fov\" 40\nWorldBegin\nAttributeBegin\n" +
      light + "\nAttributeEnd\n" + material + "\nRotate -90 1 0 0\nShape \"disk\" \"float radius\" 20\nWorldEnd\n");
}

TEST(LightReachCounts, ALightBelowTheFloorIsSkippedUnlessTheFloorLetsLightThrough) {
  const std::string mix =
      "MakeNamedMaterial \"a\" \"string type\" \"matte\"\nMakeNamedMaterial \"b\" \"string type\" \"translucent\"\n"
      "Material \"mix\" \"string namedmaterial1\" \"a\" \"string namedmaterial2\" \"b\"";
  for (const char* light :
       {"LightSource \"point\" \"point from\" [0 -1 0]", "LightSource \"distant\" \"point from\" [1 -1 0]",
        "LightSource \"goniometric\"", "AreaLightSource \"diffuse\"\nShape \"sphere\" \"float radius\" 0.5"}) {
    const std::string lowered = "Translate 0 -2 0\n" + std::string(light);
    EXPECT_EQ(skipped_above_floor(lowered), 1) << light;
    EXPECT_EQ(skipped_above_floor(lowered, "Material \"plastic\""), 1) << light;
    EXPECT_EQ(skipped_above_floor(lowered, "Material \"translucent\""), 0) << light;
    EXPECT_EQ(skipped_above_floor(lowered, "Material \"hair\""), 0) << light;
    EXPECT_EQ(skipped_above_floor(lowered, mix), 0) << light;
  }
}

TEST(LightReachCounts, DistantLightsAreSkippedFromBelowTheHorizon) {
  for (const Vec3d& d : directions()) {
    EXPECT_EQ(skipped_above_floor("LightSource \"distant\" \"point from\" [" + text_of(d) + "] \"point to\" [0 0 0]"),
              d.y < 0);
  }
}

TEST(LightReachCounts, ASpotIsSkippedWhereItsConeIsNot) {
  // Above the floor, over its middle: facing up, any material is dark, and facing down, none is.
  const auto spot = [](double up) {
    return fmt::format("LightSource \"spot\" \"point from\" [0 3 0] \"point to\" [0 {} 0]", 3 + up);
  };
  for (const char* material : {"Material \"matte\"", "Material \"translucent\"", "Material \"hair\""}) {
    EXPECT_EQ(skipped_above_floor(spot(1), material), 1);
    EXPECT_EQ(skipped_above_floor(spot(-1), material), 0);
  }
}

TEST(LightReachCounts, AOneSidedEmitterIsSkippedBehind) {
  // A square of two triangles and a disk, above the floor but out of sight, whose fronts are at first up (Rotate -90 takes
  // +z to +y).
  const std::string square =
      "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point P\" [-1 -1 0  1 -1 0  1 1 0  -1 1 0]";
  const std::string disk = "Shape \"disk\"";
  for (const auto& [shape, count] : {std::pair(square, 2), std::pair(disk, 1)}) {
    const std::string emitter = "Translate 0 6 0\nRotate -90 1 0 0\n";
    const std::string glow = "AreaLightSource \"diffuse\"\n" + shape;
    EXPECT_EQ(skipped_above_floor(emitter + glow), count);
    EXPECT_EQ(skipped_above_floor(emitter + glow, "Material \"translucent\""), count);
    EXPECT_EQ(skipped_above_floor(emitter + "ReverseOrientation\n" + glow), 0);
    EXPECT_EQ(skipped_above_floor(emitter + "AreaLightSource \"diffuse\" \"bool twosided\" \"true\"\n" + shape), 0);
  }
}

TEST(LightReachCounts, AnEnvironmentIsNeverSkipped) { EXPECT_EQ(skipped_above_floor("LightSource \"infinite\""), 0); }

// ---- Bounds ----

/// Random points and normals, against samples of a light there.
class Drawn {
 public:
  explicit Drawn(const std::string& light)
      : built_("LookAt 0 0 0  0 0 1  0 1 0\nCamera \"perspective\"\nWorldBegin\nAttributeBegin\n" + light +
               "\nAttributeEnd\nShape \"sphere\" \"float radius\" 60\nWorldEnd\n") {
    points_.n = kPoints, points_.p = arena_.vec3(kPoints);
    points_.ng = arena_.vec3(kPoints), points_.wo = arena_.vec3(kPoints);
  }

  struct Outcome {
    int skipped = 0, lit = 0, wrong = 0;
  };

  Outcome run(int batches) {
    Outcome out;
    for (int b = 0; b < batches; ++b) {
      draw_points();
      PointBounds bounds = bounds_of(points_, {});
      bounds.only_reflects = uniform(0, 1) < 0.5f;
      bool any_skipped = false, any_lit = false;
      for (const SceneLight& light : built_.scene->lights) {
        const bool skip = cannot_reach(light.reach, bounds, points_), lit = is_lit(light, bounds.only_reflects);
        out.wrong += skip && lit;
        any_skipped |= skip, any_lit |= lit;
      }
      out.skipped += any_skipped, out.lit += any_lit;
    }
    return out;
  }

 private:
  static constexpr int kPoints = 8;

  float uniform(float low, float high) { return low + (high - low) * std::uniform_real_distribution<float>()(random_); }
  Vec3f vector(float r) { return {uniform(-r, r), uniform(-r, r), uniform(-r, r)}; }

  /// Around a place near the light or far from it, with normals that are nearly alike or not. The viewer is in front of
  /// half of them.
  void draw_points() {
    const Vec3f place = Vec3f(3, 2, 1) - Vec3f(built_.scene->space.origin) + vector(std::pow(10.0f, uniform(-1, 1.5f)));
    const Vec3f normal = vector(1).normalized();
    const float size = std::pow(10.0f, uniform(-6, 1)), width = std::pow(10.0f, uniform(-4, 0));
    for (int i = 0; i < kPoints; ++i) {
      const Vec3f n = (normal + vector(width)).normalized();
      const float side = uniform(-1, 1) < 0 ? -1.0f : 1.0f;
      points_.p.set(i, (place + vector(size)) * static_cast<float>(built_.scene->space.scale));
      points_.ng.set(i, n * side), points_.wo.set(i, (n + vector(0.5f)).normalized());
    }
  }

  /// Radiance from a light at a point, and not from behind the side that is seen unless that counts too.
  bool is_lit(const SceneLight& light, bool only_reflects) {
    for (int k = 0; k < 100; ++k) {
      const int i = k % kPoints;
      Vec3f wi;
      const bool radiance = sample(light, points_.p[i], wi);
      if (radiance && (!only_reflects || wi.dot(points_.ng[i]) * points_.wo[i].dot(points_.ng[i]) > 0)) return true;
    }
    return false;
  }

  /// Whether one sample of the light has radiance at p, and its direction.
  bool sample(const SceneLight& light, Vec3f p, Vec3f& wi) {
    float u = uniform(0, 0.9999f), v = uniform(0, 0.9999f), distance = 0;
    const Vec3Lanes at{&p.x, &p.y, &p.z}, direction{&wi.x, &wi.y, &wi.z};
    RGB radiance(0.0f);
    const ArenaScope scratch(arena_);
    LightSamples s;
    s.n = 1, s.arena = &arena_, s.p = at, s.u = &u, s.v = &v;
    s.wi = direction, s.distance = &distance, s.radiance = {&radiance.x, &radiance.y, &radiance.z};
    light.light->sample(s);
    return !is_black(radiance);
  }

  test::BuiltScene built_;
  Arena arena_;
  ShadingBatch points_;
  std::mt19937 random_{7};
};

TEST(LightReachBounds, NoPointIsSkippedAtWhichASampleIsLit) {
  const std::string square = "Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point P\" [-1 -1 0  1 -1 0  1 1 0]";
  const std::string placed = "Translate 3 2 1\nRotate 50 1 2 3\n", skewed = placed + "Scale 1 -3 0.4\n";
  const std::string glow = "AreaLightSource \"diffuse\"\n";
  for (const std::string& light : {
           std::string("LightSource \"point\" \"point from\" [3 2 1]"),
           std::string("LightSource \"distant\" \"point from\" [3 2 1]"),
           placed + "LightSource \"spot\" \"float coneangle\" 10",
           skewed + "LightSource \"spot\" \"float coneangle\" 30",
           skewed + "LightSource \"spot\" \"float coneangle\" 90",
           placed + "LightSource \"spot\" \"float coneangle\" 140",
           placed + "LightSource \"projection\" \"float fov\" 40",
           skewed + "LightSource \"projection\" \"float fov\" 120",
           placed + glow + square,
           skewed + glow + square,
           skewed + "ReverseOrientation\n" + glow + square,
           placed + "AreaLightSource \"diffuse\" \"bool twosided\" \"true\"\n" + square,
           skewed + glow + "Shape \"disk\" \"float height\" 2",
           skewed + glow + "Shape \"sphere\"",
           placed + glow + "Shape \"sphere\" \"float radius\" 4",
       }) {
    const Drawn::Outcome o = Drawn(light).run(20000);
    EXPECT_EQ(o.wrong, 0) << light;
    // Half of the batches only reflect; 5/7 are smaller than 0.1 and 3/4 have normals within 0.1, and of those that are
    // more than 8 away from the light (some 15 %, the range being 0.1 to 30 and cubes having corners) almost half face
    // away from all of it. So some 2 % of all are skipped even where there is neither cone nor plane. A cone of 10 degrees
    // has 0.8 % of the sphere, of which half is faced: 70 batches are lit, and 5 standard deviations fewer are 30.
    EXPECT_GT(o.skipped, 20000 / 100) << light;
    EXPECT_GT(o.lit, 30) << light;
  }
}

TEST(LightReachBounds, NumbersThatAreNotFiniteAreNotJudged) {
  // One triangle's plane, a point behind it; then one coordinate, or a normal, is not a number.
  LightReach light;
  light.from = LightReach::From::Box, light.one_sided = true;
  light.low = {-1, -1, 0}, light.high = {1, 1, 0}, light.normal = {0, 0, 1};
  Arena arena;
  ShadingBatch s;
  s.n = 3, s.p = arena.vec3(3), s.ng = arena.vec3(3), s.wo = arena.vec3(3);
  const auto reset = [&] {
    for (int i = 0; i < 3; ++i) s.p.set(i, {0, 0, -1}), s.ng.set(i, {0, 0, 1}), s.wo.set(i, {0, 0, 1});
  };
  const auto may_be_skipped = [&] { return cannot_reach(light, bounds_of(s, {}), s) && are_finite(s, {}); };
  reset();
  EXPECT_TRUE(may_be_skipped());
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    for (float* number : {&s.p.x[1], &s.p.z[2], &s.ng.y[0], &s.wo.x[1]}) {
      reset();
      *number = bad;
      EXPECT_FALSE(may_be_skipped());
    }
  }
}

TEST(LightReachBounds, LobesThatAreNotFiniteKeepTheirLights) {
  // The square of the square of such an index is infinite, and the reflectance no number, which no light does not help:
  // the film counts those samples.
  const std::string dark = "LightSource \"spot\" \"point from\" [0 3 0] \"point to\" [0 4 0]";
  EXPECT_EQ(skipped_above_floor(dark, "Material \"metal\" \"rgb k\" [10 10 10]"), 1);
  EXPECT_EQ(skipped_above_floor(dark, "Material \"metal\" \"rgb k\" [1e12 1e12 1e12]"), 0);
}

}  // namespace
}  // namespace whit
