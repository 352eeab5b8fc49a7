#include "tools/whit/bench_scenes.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

namespace whit {
namespace {

/// A unit ball with bumps as an inline trianglemesh of 2 n (n - 1) triangles around n meridians.
std::string bumpy_ball(int n) {
  std::string p, normals, indices;
  const auto out = [](std::string& s) { return std::back_inserter(s); };
  for (int j = 0; j <= n / 2; ++j) {
    for (int i = 0; i < 2 * n; ++i) {
      const double theta = M_PI * j / (n / 2), phi = M_PI * i / n;
      const double r = 1 + 0.02 * std::sin(24 * phi) * std::sin(24 * theta) * std::sin(theta);
      const double x = std::sin(theta) * std::cos(phi), y = std::sin(theta) * std::sin(phi), z = std::cos(theta);
      fmt::format_to(out(p), "{:.6f} {:.6f} {:.6f}\n", r * x, r * y, r * z);
      fmt::format_to(out(normals), "{:.5f} {:.5f} {:.5f}\n", x, y, z);
    }
  }
  for (int j = 0; j < n / 2; ++j) {
    for (int i = 0; i < 2 * n; ++i) {
      const int a = j * 2 * n + i, b = j * 2 * n + (i + 1) % (2 * n), c = a + 2 * n, d = b + 2 * n;
      if (j > 0) fmt::format_to(out(indices), "{} {} {}\n", a, c, b);
      if (j + 1 < n / 2) fmt::format_to(out(indices), "{} {} {}\n", b, c, d);
    }
  }
  return fmt::format("Shape \"trianglemesh\" \"integer indices\" [{}] \"point P\" [{}] \"normal N\" [{}]\n", indices, p,
                     normals);
}

std::string mesh_scene() {
  // 2 n (n - 2) triangles: n = 224 gives 99,456.
  return fmt::format(R"(
Film "image" "integer xresolution" 640 "integer yresolution" 480 "string filename" "bench-mesh.exr"
Sampler "halton" "integer pixelsamples" 16
Integrator "whitted"
LookAt 0 -4.2 1.6  0 0 0  0 0 1
Camera "perspective" "float fov" 38
WorldBegin
AttributeBegin
  Translate -2 -2.5 4
  AreaLightSource "diffuse" "rgb L" [60 58 52]
  Shape "sphere" "float radius" 0.5
AttributeEnd
Material "matte" "rgb Kd" [0.5 0.5 0.55]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point P" [-9 -9 -1  9 -9 -1  9 9 -1  -9 9 -1]
Material "plastic" "rgb Kd" [0.35 0.12 0.1] "rgb Ks" [0.3 0.3 0.3] "float roughness" 0.05
{}
WorldEnd
)",
                     bumpy_ball(224));
}

}  // namespace

std::vector<BenchScene> bench_scenes() {
  return {{"mesh", "100k triangles, plastic and matte, one spherical area light", mesh_scene()}};
}

}  // namespace whit
