// Case 2: no light enters a closed box. Every light stands outside, every surface inside would show it, and the camera
// stands inside: each of 1e7 samples with its shadow rays, mirrored rays and rays refracted by the glass inside is
// exactly 0, so the picture is.
#include <fmt/core.h>

#include "tests/hard/hard_case.h"
#include "tests/hard/render_text.h"

namespace whit {
namespace {

using namespace test;

/// The box [-1, 1]^3 of 12 triangles, turned so that none of its faces is along an axis, around a mirror and a glass
/// ball, and the camera less than 1 from its middle; in a bright sky, between a sun, a lamp and a shape that glows, all of them near the walls.
std::string dark_box(int pixels, int samples, double scale) {
  return fmt::format(
             "Film \"image\" \"integer xresolution\" {0} \"integer yresolution\" {0}\n"
             "Sampler \"halton\" \"integer pixelsamples\" {1}\nIntegrator \"whitted\" \"integer maxdepth\" 4\n"
             "LookAt {2} {2} {3}  {3} {3} {2}  0 0 1\n"
             "Camera \"perspective\" \"float fov\" 100\nWorldBegin\nScale {4} {4} {4} Rotate 33 1 2 3\n",
             pixels, samples, -0.45 * scale, 0.4 * scale, scale) +
         "LightSource \"infinite\" \"rgb L\" [1 1 1]\n"
         "LightSource \"distant\" \"rgb L\" [9 9 9] \"point from\" [1 2 3]\n"
         "AttributeBegin Translate 1.01 1.01 1.01 LightSource \"point\" \"rgb I\" [9 9 9] AttributeEnd\n"
         "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [9 9 9] Translate 0 0 2.01\n"
         "Shape \"sphere\" AttributeEnd\n"
         "Shape \"trianglemesh\" \"integer indices\" [0 1 3 0 3 2  4 5 7 4 7 6  0 1 5 0 5 4  2 3 7 2 7 6  0 2 6 0 6 4\n"
         "1 3 7 1 7 5] \"point P\" [-1 -1 -1  1 -1 -1  -1 1 -1  1 1 -1  -1 -1 1  1 -1 1  -1 1 1  1 1 1]\n"
         "Translate 0.4 0.3 -0.2 Material \"glass\" Shape \"sphere\" \"float radius\" 0.4\n"
         "Translate -0.6 -0.1 -0.2 Material \"mirror\" Shape \"disk\" \"float radius\" 0.4\nWorldEnd\n";
}

TEST(Hard, DarkBox) {
  HardCase worst({2, "closed box lit from outside only", "1e7 camera samples; the box of size 1e-6, 1 and 1e6",
                  "brightest pixel", 0, ""});
  for (const double scale : {1e-6, 1.0, 1e6}) {
    // 3 pictures of 110 x 110 pixels, 276 samples each: 1.002e7.
    const Rendered picture(dark_box(110, 276, scale));
    for (const float v : picture.rgb()) worst.see(static_cast<double>(v), fmt::format("scale {}", scale));
  }
}

}  // namespace
}  // namespace whit
