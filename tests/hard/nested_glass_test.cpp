// Case 7: boundaries so close to each other that a ray's start could jump over the next one.
#include <algorithm>

#include "tests/hard/glass.h"
#include "tests/hard/hard_case.h"

namespace whit {
namespace {

using namespace test;

/// A dielectric sphere that only refracts, of index `index` over that of what is around it.
std::string boundary(double radius, double index) {
  return fmt::format(
      "Material \"perfectglass\" \"float index\" {:.9g} \"rgb Kr\" [0 0 0] "
      "Shape \"sphere\" \"float radius\" {:.9g}\n",
      index, radius);
}

/// Transmittance of spheres around an emitter for a line at offset x: at radius r in a medium of index n the angle to the
/// normal has the sine x / (n r), whatever the order of the spheres before.
double transmittance(double x, double r, double n_outside, double n_inside) {
  const double sine = x / (n_outside * r);
  return 1 - reflectance(std::sqrt((1 - sine) * (1 + sine)), n_inside / n_outside);
}

/// Calls f(gap, offset, size) over the sweep that both cases of nested spheres share.
template <class F>
void for_gaps(const F& f) {
  for (const double gap : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6}) {
    for (const double x : {0.0, 0.1, 0.3, 0.5, 0.7, 0.9}) {
      for (const double size : {1e-4, 1.0, 1e4}) f(gap, x, size);
    }
  }
}

/// How far what is seen of a world along the line at offset x is from `expected`, as a part of it.
void compare(HardCase& worst, const std::string& world, double expected, double gap, double x, double size) {
  const double seen = static_cast<double>(look_along(x, world, 8, size).pixel(0, 0).x);
  worst.see(std::abs(seen / expected - 1), fmt::format("gap {} offset {} size {}", gap, x, size));
}

TEST(Hard, ConcentricSpheres) {
  // Glass around a liquid around an emitter of radiance 1: T T' / 1.33^2, if every boundary is met once and in its order;
  // where the emitter is met first, 1, where a boundary is missed, another index. The emitter reflects nothing.
  HardCase order({7, "concentric spheres: glass, liquid, an emitter",
                  "gaps 1e-2 to 1e-6, offsets 0 to 0.9, sizes 1e-4 "
                  "to 1e4",
                  "relative error of the radiance", 1e-5, ""});
  for_gaps([&](double gap, double x, double size) {
    const std::string glass = boundary(1, 1.5), liquid = boundary(1 - gap, 1.33 / 1.5);
    const std::string emitter = fmt::format(
        "Material \"matte\" \"rgb Kd\" [0 0 0] AreaLightSource \"diffuse\" \"rgb L\" [1 1 1]\n"
        "Shape \"sphere\" \"float radius\" {:.9g}",
        1 - 2 * gap);
    const double expected = transmittance(x, 1, 1, 1.5) * transmittance(x, 1 - gap, 1.5, 1.33) / (1.33 * 1.33);
    for (const std::string& world : {glass + liquid + emitter, liquid + glass + emitter}) {
      compare(order, world, expected, gap, x, size);
    }
  });
}

TEST(Hard, ThinBubbles) {
  // Shells of glass of thickness `gap` around air, with nothing in them, under a sky of radiance 1 without reflection: in
  // through two boundaries and out through two. All indices cancel: T^2 T'^2, T outside, T' inside, each twice.
  HardCase shells({7, "a bubble: a shell of glass around air",
                   "thickness 1e-2 to 1e-6, offsets 0 to 0.9, sizes 1e-4 to "
                   "1e4",
                   "relative error of the radiance", 1e-5, ""});
  for_gaps([&](double gap, double x, double size) {
    const double t = transmittance(x, 1, 1, 1.5) * transmittance(x, 1 - gap, 1.5, 1);
    compare(shells, "LightSource \"infinite\"\n" + boundary(1, 1.5) + boundary(1 - gap, 1 / 1.5), t * t, gap, x, size);
  });
}

TEST(Hard, CoincidentBoundaries) {
  // Glass and liquid that share a boundary exactly. One of the two is met, the ray leaves beyond both, and it must be the
  // same one all over the picture. Here none reflects and an emitter of radiance 1 is behind, which shows (1 - R) / n^2 of
  // itself, n the index of the boundary that was met: tilted planes and a ball.
  HardCase same({7, "glass and liquid with a common boundary: which of them is met", "sphere, disk, mesh, both orders",
                 "spread of (1 - R) / n^2 over 1024 pixels", 1e-4, ""});
  for (const char* shape :
       {"Shape \"sphere\"", "Translate 0 0 1 Shape \"disk\" \"float radius\" 5",
        "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point P\" [-5 -5 1 5 -5 1 5 5 1 -5 5 1]"}) {
    for (const bool glass_first : {true, false}) {
      const auto boundary_of = [&](double index) {
        return fmt::format(
            "AttributeBegin Rotate 10 1 2 3 Material \"perfectglass\" \"float index\" {:.9g} "
            "\"rgb Kr\" [0 0 0] {} AttributeEnd\n",
            index, shape);
      };
      const std::string glass = boundary_of(1.5), liquid = boundary_of(1.33 / 1.5);
      const Rendered picture(
          "Film \"image\" \"integer xresolution\" 32 \"integer yresolution\" 32\n"
          "Sampler \"halton\" \"integer pixelsamples\" 4\nPixelFilter \"box\"\nLookAt 0 0.3 4  0 0 0  0 1 0\n"
          "Camera \"perspective\" \"float fov\" 2\nWorldBegin\n" +
              (glass_first ? glass + liquid : liquid + glass) +
              "Material \"matte\" \"rgb Kd\" [0 0 0] AreaLightSource \"diffuse\" \"rgb L\" [1 1 1]\n"
              "Shape \"sphere\" \"float radius\" 0.8\nWorldEnd\n",
          {}, {}, Planned::Warnings::Allowed);
      const auto [low, high] = std::minmax_element(picture.rgb().begin(), picture.rgb().end());
      EXPECT_GT(*low, 0.4f) << shape;
      same.see(static_cast<double>(*high - *low), shape);
    }
  }
}

}  // namespace
}  // namespace whit
