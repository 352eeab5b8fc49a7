#include "tools/whit/bench_scenes.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <random>

#include "core/base/vec.h"
#include "core/image/write.h"

namespace whit {
namespace {

auto to(std::string& s) { return std::back_inserter(s); }

/// A unit ball with bumps as an inline trianglemesh of 2 n (n - 2) triangles around n meridians.
std::string bumpy_ball(int n) {
  std::string p, normals, indices;
  for (int j = 0; j <= n / 2; ++j) {
    for (int i = 0; i < 2 * n; ++i) {
      const double theta = M_PI * j / (n / 2), phi = M_PI * i / n;
      const double r = 1 + 0.02 * std::sin(24 * phi) * std::sin(24 * theta) * std::sin(theta);
      const double x = std::sin(theta) * std::cos(phi), y = std::sin(theta) * std::sin(phi), z = std::cos(theta);
      fmt::format_to(to(p), "{:.6f} {:.6f} {:.6f}\n", r * x, r * y, r * z);
      fmt::format_to(to(normals), "{:.5f} {:.5f} {:.5f}\n", x, y, z);
    }
  }
  for (int j = 0; j < n / 2; ++j) {
    for (int i = 0; i < 2 * n; ++i) {
      const int a = j * 2 * n + i, b = j * 2 * n + (i + 1) % (2 * n), c = a + 2 * n, d = b + 2 * n;
      if (j > 0) fmt::format_to(to(indices), "{} {} {}\n", a, c, b);
      if (j + 1 < n / 2) fmt::format_to(to(indices), "{} {} {}\n", b, c, d);
    }
  }
  return fmt::format("Shape \"trianglemesh\" \"integer indices\" [{}] \"point P\" [{}] \"normal N\" [{}]\n", indices, p,
                     normals);
}

/// Film, camera and a spherical area light, as most of the scenes have them: 640 x 480 pixels, 8 samples each.
std::string beginning() {
  return R"(
Film "image" "integer xresolution" 640 "integer yresolution" 480 "string filename" "bench.exr"
Sampler "halton" "integer pixelsamples" 8
Integrator "whitted"
LookAt 0 -4.2 1.6  0 0 0  0 0 1
Camera "perspective" "float fov" 38
WorldBegin
AttributeBegin
  Translate -2 -2.5 4
  AreaLightSource "diffuse" "rgb L" [60 58 52]
  Shape "sphere" "float radius" 0.5
AttributeEnd
)";
}

std::string ground() {
  return R"(Material "matte" "rgb Kd" [0.5 0.5 0.55]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point P" [-9 -9 -1  9 -9 -1  9 9 -1  -9 9 -1]
)";
}

std::string mesh_scene() {
  // 2 n (n - 2) triangles: n = 708 gives 999,696.
  return beginning() + ground() +
         R"(Material "plastic" "rgb Kd" [0.35 0.12 0.1] "rgb Ks" [0.3 0.3 0.3] "float roughness" 0.05)" + "\n" +
         bumpy_ball(708) + "WorldEnd\n";
}

std::string cornell_scene() {
  const auto wall = [](const char* colour, const char* corners) {
    return fmt::format(
        "Material \"matte\" \"rgb Kd\" [{}]\nShape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point P\" "
        "[{}]\n",
        colour, corners);
  };
  return R"(
Film "image" "integer xresolution" 500 "integer yresolution" 500 "string filename" "bench.exr"
Sampler "halton" "integer pixelsamples" 8
Integrator "whitted" "integer maxdepth" 10
Scale -1 1 1
LookAt 2.5 2.5 6  2.5 2.5 0  0 1 0
Camera "perspective" "float fov" 80
WorldBegin
AttributeBegin
  Material "matte" "rgb Kd" [0 0 0]
  AreaLightSource "diffuse" "rgb L" [48 41 30]
  Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point P" [2 4.99 2  3 4.99 2  3 4.99 3  2 4.99 3]
AttributeEnd
)" + wall("0.73 0.73 0.73", "0 0 0  0 0 5  5 0 5  5 0 0") +
         wall("0.73 0.73 0.73", "0 5 0  5 5 0  5 5 5  0 5 5") + wall("0.73 0.73 0.73", "0 0 0  5 0 0  5 5 0  0 5 0") +
         wall("0.65 0.05 0.05", "0 0 0  0 5 0  0 5 5  0 0 5") + wall("0.12 0.45 0.15", "5 0 0  5 0 5  5 5 5  5 5 0") +
         R"(
AttributeBegin
  Material "mirror"
  Translate 1.6 1.1 1.6
  Shape "sphere" "float radius" 1.1
AttributeEnd
AttributeBegin
  Material "glass"
  Translate 3.5 0.95 2.8
  Shape "sphere" "float radius" 0.95
AttributeEnd
WorldEnd
)";
}

/// A closed room with a lamp below the ceiling, a bumpy ball of plastic and a block: light comes by way of the walls.
std::string path_scene() {
  const auto quad = [](const char* material, const char* corners) {
    return fmt::format("Material {}\nShape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point P\" [{}]\n",
                       material, corners);
  };
  const char* const white = "\"matte\" \"rgb Kd\" [0.73 0.73 0.73]";
  return R"(
Film "image" "integer xresolution" 400 "integer yresolution" 400 "string filename" "bench.exr"
Sampler "halton" "integer pixelsamples" 8
Integrator "path" "integer maxdepth" 5
LookAt 0 -3.6 1.6  0 0 1.3  0 0 1
Camera "perspective" "float fov" 60
WorldBegin
AttributeBegin
  Material "matte" "rgb Kd" [0 0 0]
  AreaLightSource "diffuse" "rgb L" [17 14 11]
  Shape "trianglemesh" "integer indices" [0 2 1 0 3 2] "point P" [-0.6 -0.6 3.98  0.6 -0.6 3.98  0.6 0.6 3.98  -0.6 0.6 3.98]
AttributeEnd
)" + quad(white, "-2 -4 0  2 -4 0  2 2 0  -2 2 0") +
         quad(white, "-2 -4 4  2 -4 4  2 2 4  -2 2 4") + quad(white, "-2 2 0  2 2 0  2 2 4  -2 2 4") +
         quad(white, "-2 -4 0  2 -4 0  2 -4 4  -2 -4 4") +
         quad("\"matte\" \"rgb Kd\" [0.65 0.05 0.05]", "-2 -4 0  -2 2 0  -2 2 4  -2 -4 4") +
         quad("\"matte\" \"rgb Kd\" [0.12 0.45 0.15]", "2 -4 0  2 2 0  2 2 4  2 -4 4") +
         R"(
AttributeBegin
  Material "matte" "rgb Kd" [0.6 0.6 0.6]
  Translate -0.9 0.9 0
  Rotate 20 0 0 1
  Scale 0.5 0.5 2.2
  Shape "trianglemesh"
    "integer indices" [0 2 3  0 3 1   4 5 7  4 7 6   0 1 5  0 5 4   2 6 7  2 7 3   1 3 7  1 7 5   0 4 6  0 6 2]
    "point P" [-1 -1 0  1 -1 0  -1 1 0  1 1 0  -1 -1 1  1 -1 1  -1 1 1  1 1 1]
AttributeEnd
AttributeBegin
  Material "plastic" "rgb Kd" [0.2 0.25 0.5] "rgb Ks" [0.3 0.3 0.3] "float roughness" 0.1
  Translate 0.7 -0.3 0.9
  Scale 0.8 0.8 0.8
)" + bumpy_ball(224) +
         "AttributeEnd\nWorldEnd\n";
}

/// Writes the floor's texture: 1024 x 1024 texels of tiles with a little noise, display-encoded as textures are.
void write_tiles(const std::string& path) {
  constexpr int kSize = 1024, kTile = 64;
  std::mt19937 random(1);
  std::vector<float> rgb;
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const bool light = (x / kTile + y / kTile) % 2 == 0;
      const float v = (light ? 0.8f : 0.3f) + 0.1f * static_cast<float>(random() & 0xffff) / 0xffff;
      rgb.insert(rgb.end(), {v, 0.9f * v, 0.8f * v});
    }
  }
  const WriteResult result = write_image(path, {.width = kSize, .height = kSize, .rgb = rgb});
  if (!result.ok()) throw std::runtime_error(result.error);
}

/// Gently rolling ground of a million triangles to the horizon, one texture all over it.
std::string floor_scene(const std::string& texture) {
  constexpr int kColumns = 700, kRows = 715;
  std::string p, uv, indices;
  for (int j = 0; j <= kRows; ++j) {
    // Rows are spaced as the picture's are, so that triangles are of like size on the screen.
    const double y = -4 + 600 * std::pow(static_cast<double>(j) / kRows, 2);
    for (int i = 0; i <= kColumns; ++i) {
      const double x = (2.0 * i / kColumns - 1) * (4 + y + 4);
      const double z = -1 + 0.05 * std::sin(2 * x) * std::cos(1.5 * y);
      fmt::format_to(to(p), "{:.5f} {:.5f} {:.5f}\n", x, y, z);
      fmt::format_to(to(uv), "{:.5f} {:.5f}\n", x / 4, y / 4);
    }
  }
  for (int j = 0; j < kRows; ++j) {
    for (int i = 0; i < kColumns; ++i) {
      const int a = j * (kColumns + 1) + i, b = a + 1, c = a + kColumns + 1, d = c + 1;
      fmt::format_to(to(indices), "{} {} {} {} {} {}\n", a, b, d, a, d, c);
    }
  }
  return beginning() + fmt::format(R"(Texture "tiles" "spectrum" "imagemap" "string filename" "{}"
Material "matte" "texture Kd" "tiles"
Shape "trianglemesh" "integer indices" [{}] "point P" [{}] "float uv" [{}]
WorldEnd
)",
                                   texture, indices, p, uv);
}

/// Ten thousand balls of 10,080 triangles each under a sky.
std::string instances_scene() {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> u;
  std::string text = beginning();
  text += R"(LightSource "infinite" "rgb L" [0.5 0.6 0.8]
ObjectBegin "ball"
  Material "plastic" "rgb Kd" [0.35 0.12 0.1]
)";
  text += bumpy_ball(72);
  text += "ObjectEnd\n";
  for (int i = 0; i < 10000; ++i) {
    const double x = 4 * u(random) - 2, y = 6 * u(random) - 2, z = 1.5 * u(random) - 1;
    fmt::format_to(to(text),
                   "AttributeBegin Translate {:.4f} {:.4f} {:.4f} Scale 0.03 0.03 0.03 ObjectInstance \"ball\" "
                   "AttributeEnd\n",
                   x, y, z);
  }
  return text + "WorldEnd\n";
}

/// Three hundred balls of 1,104 triangles, each with a material of its own, of ten kinds.
std::string materials_scene() {
  const char* const kinds[] = {"\"matte\" \"rgb Kd\"",
                               "\"plastic\" \"float roughness\" 0.1 \"rgb Kd\"",
                               "\"metal\" \"float roughness\" 0.05 \"rgb k\"",
                               "\"substrate\" \"rgb Kd\"",
                               "\"uber\" \"rgb Kd\"",
                               "\"translucent\" \"rgb Kd\"",
                               "\"disney\" \"float metallic\" 0.3 \"rgb color\"",
                               "\"mirror\" \"rgb Kr\"",
                               "\"glass\" \"rgb Kr\"",
                               "\"matte\" \"float sigma\" 20 \"rgb Kd\""};
  std::mt19937 random(1);
  std::uniform_real_distribution<double> u;
  const std::string ball = bumpy_ball(24);
  std::string text = beginning() + ground();
  for (int i = 0; i < 300; ++i) {
    const double r = u(random), g = u(random), b = u(random);
    fmt::format_to(to(text),
                   "AttributeBegin\nMaterial {} [{:.3f} {:.3f} {:.3f}]\nTranslate {:.3f} {:.3f} -0.9\n"
                   "Scale 0.09 0.09 0.09\n{}AttributeEnd\n",
                   kinds[i % 10], r, g, b, -1.9 + 3.8 * (i % 20) / 19.0, -1.6 + 3.4 * (i / 20) / 14.0, ball);
  }
  return text + "WorldEnd\n";
}

/// Twenty thousand hairs around a ball, each a curve of one segment.
std::string hair_scene() {
  std::mt19937 random(1);
  std::normal_distribution<double> gauss;
  std::string text = beginning() + ground() + "Material \"hair\"\n";
  for (int i = 0; i < 20000; ++i) {
    Vec3d root(gauss(random), gauss(random), gauss(random));
    root.normalize();
    const Vec3d wind = 0.05 * Vec3d(gauss(random), gauss(random), gauss(random));
    const Vec3d b = 1.25 * root + wind, c = b + 0.1 * root - Vec3d(0, 0, 0.2), d = c - Vec3d(0, 0, 0.3);
    text += "Shape \"curve\" \"string type\" \"cylinder\" \"float width0\" 0.006 \"float width1\" 0.002 \"point P\" [";
    for (const Vec3d& p : {root, b, c, d}) fmt::format_to(to(text), "{:.4f} {:.4f} {:.4f} ", p.x, p.y, p.z);
    text += "]\n";
  }
  return text + "WorldEnd\n";
}

}  // namespace

std::vector<BenchScene> bench_scenes() {
  return {
      {"mesh", "a million triangles, plastic and matte, a spherical area light",
       [](const auto&) { return mesh_scene(); }},
      {"cornell", "a box with a mirror and a glass ball, depth 10", [](const auto&) { return cornell_scene(); }},
      {"floor", "rolling ground to the horizon, anisotropically filtered texture",
       [](const std::string& folder) {
         write_tiles(folder + "/tiles.png");
         return floor_scene(folder + "/tiles.png");
       }},
      {"instances", "ten thousand instances of 10,080 triangles, a sky and an area light",
       [](const auto&) { return instances_scene(); }},
      {"materials", "three hundred materials of ten kinds in one view", [](const auto&) { return materials_scene(); }},
      {"hair", "twenty thousand hairs", [](const auto&) { return hair_scene(); }},
      {"path", "a closed room with 99,468 triangles, path at depth 5", [](const auto&) { return path_scene(); }}};
}

}  // namespace whit
