// What the tests of glass share: Fresnel's equations in double precision, and a camera that looks along one line.
#pragma once

#include <fmt/core.h>

#include <cmath>
#include <string>

#include "tests/hard/render_text.h"

namespace whit::test {

/// Unpolarised reflectance of a boundary of relative index n (far over near) at cosine c, as the textbooks have it.
inline double reflectance(double c, double n) {
  const double k = n * n - 1 + c * c;
  if (k <= 0) return 1;
  const double g = std::sqrt(k), s = (c - g) / (c + g), p = (n * n * c - g) / (n * n * c + g);
  return (s * s + p * p) / 2;
}

/// What is seen along one line: from (x, 0, 4), towards -z, through a pixel of width 2e-9; all of it, the world too, at
/// another size.
inline Rendered look_along(double x, const std::string& world, int maxdepth, double size = 1) {
  return Rendered(
      fmt::format("Film \"image\" \"integer xresolution\" 1 \"integer yresolution\" 1\n"
                  "Sampler \"halton\" \"integer pixelsamples\" 1\nPixelFilter \"box\"\n"
                  "Integrator \"whitted\" \"integer maxdepth\" {0}\n"
                  "LookAt {1:.17g} 0 {2:.17g}  {1:.17g} 0 0  0 1 0\n"
                  "Camera \"orthographic\" \"float screenwindow\" [-{3:.17g} {3:.17g} -{3:.17g} {3:.17g}]\n"
                  "WorldBegin Scale {4} {4} {4}\n{5}\nWorldEnd\n",
                  maxdepth, x * size, 4 * size, 1e-9 * size, size, world));
}

}  // namespace whit::test
