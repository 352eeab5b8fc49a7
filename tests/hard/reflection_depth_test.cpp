// Case 15: two mirrors that face each other. Each bounce multiplies what is seen by the mirrors' reflectance, so that
// with an emitter's radiance at every bounce the picture is a geometric sum; and rounds, not recursion, carry it.
#include <fmt/core.h>

#include "tests/hard/hard_case.h"
#include "tests/hard/render_text.h"

namespace whit {
namespace {

using namespace test;

TEST(Hard, FacingMirrors) {
  HardCase worst({15, "two facing mirrors that glow", "maxdepth 1 to 1000, reflectance 0.5 and 0.99",
                  "relative error of a pixel against the geometric sum", 1e-3,
                  "recursion: the stack grows with maxdepth"});
  for (const double rho : {0.5, 0.99}) {
    for (const int depth : {1, 2, 3, 10, 100, 1000}) {
      // The camera stands between disks of radius 5 at z = -1 and z = 1, looking along z: all rays stay on the axis to
      // within the pixel's 0.1 degrees (1000 bounces: 2000 x 0.0017 = 3.5 < 5). Both emit 1 and reflect rho, so the
      // sum over the bounces k = 0 .. depth - 1 of rho^k is seen.
      const std::string mirror = fmt::format(
          "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] \"bool twosided\" \"true\"\n"
          "Material \"mirror\" \"rgb Kr\" [{0} {0} {0}]\n",
          rho);
      const std::string text = fmt::format(
          "Film \"image\" \"integer xresolution\" 2 \"integer yresolution\" 2\n"
          "Sampler \"halton\" \"integer pixelsamples\" 4\n"
          "Integrator \"whitted\" \"integer maxdepth\" {}\n"
          "LookAt 0 0 0  0 0 1  0 1 0\nCamera \"perspective\" \"float fov\" 0.1\nWorldBegin\n"
          "{}Shape \"disk\" \"float radius\" 5 \"float height\" -1 AttributeEnd\n"
          "{}Shape \"disk\" \"float radius\" 5 \"float height\" 1 AttributeEnd\nWorldEnd\n",
          depth, mirror, mirror);
      const Rendered picture(text);
      const double expected = (1 - std::pow(rho, depth)) / (1 - rho);
      for (const float v : picture.rgb()) {
        worst.see(std::abs(static_cast<double>(v) / expected - 1), fmt::format("rho {} depth {}", rho, depth));
      }
    }
  }
}

}  // namespace
}  // namespace whit
