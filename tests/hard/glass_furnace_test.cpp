// Case 7: balls of glass under a constant sky, and around an emitter, of any index, size and orientation.
#include <vector>

#include "tests/hard/glass.h"
#include "tests/hard/hard_case.h"

namespace whit {
namespace {

using namespace test;

/// How far from the axis the lines of sight are, in radii: from the middle to a grazing ray of cosine 0.014.
constexpr double kOffsets[] = {0, 1e-8, 1e-4, 0.1, 0.3, 0.5, 0.65, 0.7, 0.8, 0.9, 0.95, 0.98, 0.99, 0.999, 0.9999};

/// How far `seen` is from what a ball of index n shows at offset x under a sky of radiance 1: 1 - T R^10, with T taken at
/// offsets 4e-7 to both sides (offset, hit and normal are floats, a rounding is 6e-8) and R between there and 1e-5
/// farther in. That is because a ray leaves a point by its error bound of some 5 roundings of coordinates up to 5 (the
/// camera is 4 away), 1.5e-6 along the normal, which makes its line pass the centre so much closer: 10 times until the
/// last boundary, 5 times for the mean of the ten.
double error_of_furnace(double seen, double x, double n) {
  const auto r = [&](double at) {
    const double b = std::min(1.0, std::abs(at));
    return reflectance(std::sqrt((1 - b) * (1 + b)), n);
  };
  double low = 2, high = 0;
  for (int i = -1; i <= 1; ++i) {
    for (int k = -25; k <= 1; ++k) {
      const double at = 1 - (1 - r(x + i * 4e-7)) * std::pow(r(x + k * 4e-7), 10);
      low = std::min(low, at), high = std::max(high, at);
    }
  }
  return std::max({0.0, low - seen, seen - high});
}

TEST(Hard, GlassFurnace) {
  // At each boundary a ray splits into R and T = 1 - R; radiance scales by 1 / n^2 on the way in and by n^2 on the way
  // out. All leaves in the end, so the ball cannot be seen, but for what the depth cuts off: every inner boundary is met
  // at the angle of the first one, an inner ray of depth k carries T R^(k - 1), and the last one, of depth 11, T R^10.
  // ReverseOrientation swaps inside and outside: the index is 1 / n.
  //
  // R has an endless slope at the critical angle and a steep one at the rim, hence error_of_furnace(). What is left are the
  // roundings of 12 products.
  HardCase furnace(
      {7, "a ball of glass under a constant sky, depth 12",
       "index 0.5 to 3, both glasses, ReverseOrientation, offsets from the axis 0 to 0.9999, sizes 1e-4 to "
       "1e4",
       "error of a pixel (1 but for what the depth cuts off), offsets being known to 1e-5", 2e-6, ""});
  for (const double index : {0.5, 0.6666, 0.9, 0.999999, 1.0, 1.000001, 1.1, 1.333, 1.5, 1.8, 2.0, 2.4, 3.0}) {
    for (const double x : kOffsets) {
      for (const bool reverse : {false, true}) {
        for (const double size : {1.0, reverse ? 1e-4 : 1e4}) {
          const std::string world = fmt::format(
              "LightSource \"infinite\" \"rgb L\" [1 1 1] {} Material \"{}\" \"float index\" {} Shape \"sphere\"",
              reverse ? "ReverseOrientation" : "", size < 1 ? "perfectglass" : "glass", index);
          const float seen = look_along(x, world, 12, size).pixel(0, 0).x;
          furnace.see(error_of_furnace(static_cast<double>(seen), x, reverse ? 1 / index : index),
                      fmt::format("index {} offset {} reverse {} size {}", index, x, reverse, size));
        }
      }
    }
  }
}

TEST(Hard, GlassFurnaceAddsNothing) {
  // All that is left of one ray, whatever its angles, is at most 1: more would be light from nowhere. Each of the 12
  // depths rounds a weight twice: 24 x 6e-8.
  HardCase brighter({7, "glass balls, ellipsoids, cubes and tetrahedra under a constant sky",
                     "index 0.5 to 3, 32 x 32 pixels", "how far a pixel exceeds 1", 2e-6, ""});
  const char* const cube =
      "Rotate 30 1 2 3 Shape \"trianglemesh\" \"point P\" [-1 -1 -1 1 -1 -1 -1 1 -1 1 1 -1 -1 -1 1 1 -1 1 -1 1 1 1 1 "
      "1] "
      "\"integer indices\" [0 2 1 1 2 3  4 5 6 5 7 6  0 1 4 1 5 4  2 6 3 3 6 7  0 4 2 2 4 6  1 3 5 3 7 5]";
  const char* const tetrahedron =
      "Shape \"trianglemesh\" \"point P\" [1 1 1  -1 -1 1  -1 1 -1  1 -1 -1] "
      "\"integer indices\" [0 2 1  0 1 3  0 3 2  1 2 3]";
  for (const double index : {0.5, 0.9, 1.1, 1.5, 2.0, 3.0}) {
    for (const char* shape : {"Shape \"sphere\"", "Scale 1 2 -1 Shape \"sphere\"", cube, tetrahedron}) {
      const Rendered picture(
          fmt::format("Film \"image\" \"integer xresolution\" 32 \"integer yresolution\" 32\n"
                      "Sampler \"halton\" \"integer pixelsamples\" 4\nPixelFilter \"box\"\n"
                      "Integrator \"whitted\" \"integer maxdepth\" 12\nLookAt 0 1 4  0 0 0  0 1 0\n"
                      "Camera \"perspective\" \"float fov\" 30\nWorldBegin LightSource \"infinite\"\n"
                      "Material \"glass\" \"float index\" {} {}\nWorldEnd\n",
                      index, shape));
      EXPECT_GT(picture.mean(), 0.5) << index << ' ' << shape;
      for (const float v : picture.rgb()) {
        brighter.see(std::max(0.0, static_cast<double>(v) - 1), fmt::format("index {} {}", index, shape));
      }
    }
  }
}

TEST(Hard, EmitterInGlass) {
  // From outside, along a diameter: (1 - R) / n^2 of its radiance, R = ((n - 1) / (n + 1))^2. At index 1.5 that is
  // 0.96 / 2.25. What the boundary reflects shows the dark outside, and the emitter reflects nothing.
  HardCase emitter({7, "an emitter inside a ball of glass, seen from outside",
                    "index 1 to 3 (0.96 / 2.25 at 1.5), emitters of 1e-4 to 1 - 1e-6 radii, sizes 1e-4 to 1e4",
                    "relative error of its radiance", 1e-5, ""});
  for (const double index : {1.0, 1.333, 1.5, 2.4, 3.0}) {
    for (const double radius : {1e-4, 0.01, 0.5, 0.9, 0.99, 0.9999, 0.999999}) {
      for (const double size : {1e-4, 1.0, 1e4}) {
        const std::string world = fmt::format(
            "Material \"glass\" \"float index\" {} Shape \"sphere\"\n"
            "Material \"matte\" \"rgb Kd\" [0 0 0] AreaLightSource \"diffuse\" \"rgb L\" [1 1 1]\n"
            "Shape \"sphere\" \"float radius\" {}",
            index, radius);
        const double expected = (1 - reflectance(1, index)) / (index * index);
        const double seen = static_cast<double>(look_along(0, world, 12, size).pixel(0, 0).x);
        emitter.see(std::abs(seen / expected - 1), fmt::format("index {} radius {} size {}", index, radius, size));
      }
    }
  }
}

}  // namespace
}  // namespace whit
