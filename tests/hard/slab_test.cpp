// Case 8: a slab of glass under a sky of radiance 1 shows 1 everywhere, however its triangles lie. At each surface
// reflectance and transmittance add up to 1, radiance is scaled by the square of the index on the way in and back on the
// way out, and both branches are followed: with n surfaces met, what is missing is the part that is still inside after
// maxdepth rounds. At normal incidence R = 0.04, so that after 12 rounds less than 0.04^11 of the light is left; the
// bound 1e-3 also covers 60 degrees (R = 0.089). A ray that slips through one face between its triangles meets the other
// one from the wrong side and is scaled twice: 1 / 2.25^2.
#include <fmt/core.h>

#include "tests/hard/hard_case.h"
#include "tests/hard/render_text.h"

namespace whit {
namespace {

using namespace test;

/// The slab [-1, 1]^2 x [-0.1, 0.1], closed, its large faces of n x n squares with their diagonals, seen by rays through
/// the middle of pixels: `view` says how the camera stands.
std::string slab(int n, int pixels, const std::string& view) {
  std::string points, indices;
  const int side = n + 1, faces = side * side;
  const auto quad = [&](int a, int b, int c, int d) { indices += fmt::format("{} {} {} {} {} {} ", a, b, c, a, c, d); };
  for (const double z : {-0.1, 0.1}) {
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) points += fmt::format("{:.17g} {:.17g} {} ", 2.0 * x / n - 1, 2.0 * y / n - 1, z);
    }
  }
  for (int y = 0; y < n; ++y) {
    for (int x = 0; x < n; ++x) {
      const int a = y * side + x;
      quad(a, a + side, a + side + 1, a + 1);
      quad(faces + a, faces + a + 1, faces + a + side + 1, faces + a + side);
    }
  }
  for (int k = 0; k < n; ++k) {
    const int top = n * side + k, left = k * side, right = left + n;
    quad(k, k + 1, faces + k + 1, faces + k);
    quad(top, faces + top, faces + top + 1, top + 1);
    quad(left, faces + left, faces + left + side, left + side);
    quad(right, right + side, faces + right + side, faces + right);
  }
  return fmt::format(
             "Film \"image\" \"integer xresolution\" {0} \"integer yresolution\" {0}\nPixelFilter \"box\"\n"
             "Sampler \"stratified\" \"integer xsamples\" 1 \"integer ysamples\" 1 \"bool jitter\" \"false\"\n"
             "Integrator \"whitted\" \"integer maxdepth\" 12\n{1}\nWorldBegin\n"
             "LightSource \"infinite\" \"rgb L\" [1 1 1]\nMaterial \"glass\"\n",
             pixels, view) +
         "Shape \"trianglemesh\" \"integer indices\" [" + indices + "] \"point P\" [" + points + "]\nWorldEnd\n";
}

TEST(Hard, GlassSlab) {
  HardCase worst({8, "glass slab under a constant sky, rays along diagonals and through vertices",
                  "1 to 32 squares a side, from above and at an angle, parallel rays and not", "error of a pixel", 1e-3,
                  ""});
  // None sees the slab's sides: light that enters there is led along by total reflection, for more than 12 rounds.
  const std::string views[] = {
      // The picture's 63 x 63 pixels over [-63/64, 63/64] have their centres at multiples of 1 / 32: the vertices inside
      // of 32 squares a side, and points of all diagonals.
      "LookAt 0 0 4  0 0 0  0 1 0 Camera \"orthographic\" \"float screenwindow\" [-0.984375 0.984375 -0.984375 "
      "0.984375]",
      "LookAt 0 2 2  0 0 0  0 1 0 Camera \"orthographic\" \"float screenwindow\" [-0.6 0.6 -0.6 0.6]",
      "LookAt 0 0 4  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 24",
      "LookAt 0.3 -3 2  0 0 0  0 0 1 Camera \"perspective\" \"float fov\" 10",
  };
  for (const int n : {1, 2, 16, 32}) {
    for (const std::string& view : views) {
      const Rendered picture(slab(n, 63, view));
      for (size_t i = 0; i < picture.rgb().size(); ++i) {
        const float v = picture.rgb()[i];
        worst.see(std::abs(static_cast<double>(v) - 1), fmt::format("{} squares, pixel {}, {}", n, i / 3, view));
      }
    }
  }
}

}  // namespace
}  // namespace whit
