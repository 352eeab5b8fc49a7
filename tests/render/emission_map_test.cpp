// Emission that a texture says: what is seen of it, what it lights, and that all ways to find its light agree.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "core/render/render.h"
#include "tests/base/temp_folder.h"
#include "tests/scene/scene_text.h"

namespace whit {
namespace {

using Warnings = test::Planned::Warnings;

struct Rendered {
  test::BuiltScene built;
  RenderResult result;
  explicit Rendered(const std::string& text) : built(text, {}, Warnings::Allowed), result(render(*built.scene, {})) {
    EXPECT_EQ(result.statistics.invalid_samples, 0);
  }
  RGB mean() const {
    const std::vector<float>& rgb = result.picture.rgb;
    Vec3d sum(0, 0, 0);
    for (size_t i = 0; i < rgb.size(); i += 3) sum += Vec3d(rgb[i], rgb[i + 1], rgb[i + 2]);
    sum /= static_cast<double>(rgb.size() / 3);
    return {static_cast<float>(sum.x), static_cast<float>(sum.y), static_cast<float>(sum.z)};
  }
};

std::string scene(const std::string& world, const std::string& integrator = "whitted", int samples = 64,
                  const std::string& view = "LookAt 0 0 1  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 1\n") {
  return fmt::format(
      "Film \"image\" \"integer xresolution\" 16 \"integer yresolution\" 16\nSampler \"halton\" \"integer "
      "pixelsamples\" {}\n"
      "Integrator \"{}\" {}\n{}WorldBegin\n{}\nWorldEnd\n",
      samples, integrator, integrator == "path" ? "\"integer maxdepth\" 1" : "", view, world);
}

/// Half of a sphere of directions around the origin, as far as (u, v) go: where u, the angle around z, is below 0.5.
const std::string kHalf =
    "Texture \"half\" \"spectrum\" \"checkerboard\" \"float uscale\" 2 \"string aamode\" \"none\" \"rgb "
    "tex1\" [1 0.5 0.25] \"rgb tex2\" [0 0 0]\n";
const std::string kFloor =
    "AttributeBegin Material \"matte\" \"rgb Kd\" [1 1 1] Shape \"disk\" \"float radius\" 0.02 "
    "AttributeEnd\n";

TEST(EmissionMap, HalfASphereLightsHalf) {
  // White matte under a sphere of radiance L shows L; where half of the sphere is dark, L/2. The camera is in the sphere and
  // sees a hundredth of a unit of the floor in its middle.
  const std::string light = kHalf +
                            "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [2 2 2] \"bool twosided\" \"true\" "
                            "\"texture map\" \"half\" {} Shape \"sphere\" \"float radius\" 5 AttributeEnd\n";
  struct Way {
    const char *integrator, *parameters;
  };
  // Light sampling alone, light and lobe sampling together, lobe sampling alone.
  for (const Way& way :
       {Way{"whitted", ""}, {"path", ""}, {"directlighting", ""}, {"path", "\"bool lights\" \"false\""}}) {
    const Rendered r(scene(kFloor + fmt::format(fmt::runtime(light), way.parameters), way.integrator, 256));
    const RGB mean = r.mean();
    // 65536 samples of at most 4: the standard deviation is below 4 / 256 of a half.
    EXPECT_NEAR(mean.x, 1, 0.02) << way.integrator << way.parameters;
    EXPECT_NEAR(mean.y, 0.5, 0.01) << way.integrator << way.parameters;
    EXPECT_NEAR(mean.z, 0.25, 0.005) << way.integrator << way.parameters;
  }
}

/// A square of n x n squares in z = 2 over (-1..1)^2, facing down, in a PLY file with u = (x + 1) / 2, v = (y + 1) / 2 and
/// the red of each vertex.
template <class Red>
std::string grid(int n, const Red& red) {
  const std::string path = fmt::format("{}/emission_grid.ply", test::temp_folder());
  std::ofstream file(path);
  file << "ply\nformat ascii 1.0\nelement vertex " << (n + 1) * (n + 1) << "\n";
  for (const char* p : {"x", "y", "z", "u", "v", "red", "green", "blue"}) file << "property float " << p << "\n";
  file << "element face " << n * n << "\nproperty list uchar int vertex_indices\nend_header\n";
  for (int y = 0; y <= n; ++y)
    for (int x = 0; x <= n; ++x) {
      const double u = double(x) / n, v = double(y) / n;
      file << fmt::format("{} {} 2 {} {} {} 0 0\n", 2 * u - 1, 2 * v - 1, u, v, red(x, y));
    }
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      const int a = y * (n + 1) + x, b = a + n + 1;
      file << fmt::format("4 {} {} {} {}\n", a, b, b + 1, a + 1);
    }
  return "Shape \"plymesh\" \"string filename\" \"" + path + "\"\n";
}

std::string lit(const std::string& map, const std::string& shape, const std::string& more = "") {
  return "AttributeBegin Material \"matte\" \"rgb Kd\" [0 0 0] AreaLightSource \"diffuse\" \"rgb L\" [3 3 3] " +
         (map.empty() ? "" : "\"texture map\" \"" + map + "\" ") + more + shape + "AttributeEnd\n";
}

const std::string kGround =
    "Material \"matte\" \"rgb Kd\" [0.5 0.5 0.5] Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 "
    "3] \"point P\" [-3 -3 0  3 -3 0  3 3 0  -3 3 0]\n";
const std::string kAbove = "LookAt 0 0 1.9  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 80\n";

TEST(EmissionMap, AMapThatIsHalfDarkIsHalfASquare) {
  // u < 0.5 of the square emits: as the half square alone does.
  const std::string half =
      "Shape \"trianglemesh\" \"integer indices\" [0 2 1 0 3 2] \"point P\" [-1 -1 2  0 -1 2  0 1 2  -1 1 2]\n";
  const std::string whole = grid(2, [](int, int) { return 1; });
  for (const char* integrator : {"whitted", "path", "directlighting"}) {
    const Rendered expected(scene(kGround + lit("", half), integrator, 64, kAbove));
    const Rendered mapped(scene(kHalf + kGround + lit("half", whole), integrator, 64, kAbove));
    EXPECT_EQ(mapped.built.scene->lights.size(), 4u);  // four of eight triangles are dark
    const RGB a = expected.mean(), b = mapped.mean();
    EXPECT_GT(a.x, 0.05f);
    EXPECT_NEAR(b.x, a.x, 0.01 * a.x) << integrator;
    EXPECT_NEAR(b.y, 0.5 * a.x, 0.005 * a.x) << integrator;
    EXPECT_NEAR(b.z, 0.25 * a.x, 0.0025 * a.x) << integrator;
  }
}

TEST(EmissionMap, DarkTrianglesAreSeenButNotSampled) {
  // Vertex (4, 4) alone is bright: six triangles of the 128 have it as a corner.
  const std::string map = "Texture \"c\" \"spectrum\" \"vertexcolor\"\n";
  const std::string one = grid(8, [](int x, int y) { return x == 4 && y == 4 ? 1 : 0; });
  const Rendered r(scene(map + kGround + lit("c", one), "path", 64, kAbove));
  EXPECT_EQ(r.built.scene->lights.size(), 6u);
  EXPECT_GT(r.mean().x, 0);
  EXPECT_EQ(r.mean().y, 0);
  // All ways to find its light have the same mean, and as a light it has the power of its mean: of the six triangles a third
  // each. Their area is 6 / 2 / 16, so that it is pi * 3 * (1/3 * 0.212671) * 6/32.
  const Rendered direct(scene(map + kGround + lit("c", one), "directlighting", 64, kAbove));
  const Rendered chance(scene(map + kGround + lit("c", one, "\"bool lights\" \"false\" "), "path", 4096, kAbove));
  EXPECT_NEAR(direct.mean().x, r.mean().x, 0.02 * r.mean().x);
  EXPECT_NEAR(chance.mean().x, r.mean().x, 0.05 * r.mean().x);
  EXPECT_TRUE(chance.built.scene->lights.empty());
  double power = 0;
  const double scale = r.built.scene->space.scale;
  for (const SceneLight& l : r.built.scene->lights) power += l.light->power(1) / (scale * scale);
  EXPECT_NEAR(power, 3.14159265 * 0.212671 * 6 / 32, 1e-5);
  // A map that is black all over leaves a surface that is seen, and black.
  const Rendered black(scene(map + kGround + lit("c", grid(2, [](int, int) { return 0; })), "whitted", 4, kAbove));
  EXPECT_TRUE(black.built.scene->lights.empty());
  EXPECT_EQ(black.mean().x, 0);
}

TEST(EmissionMap, IsSeenAsItIs) {
  // The map's own colour times L fills the picture, on shapes that light, that do not, in objects and on curves.
  const std::string map =
      "Texture \"half\" \"spectrum\" \"checkerboard\" \"float uscale\" 1000 \"rgb tex1\" [0.5 0.25 1] \"rgb "
      "tex2\" [0.5 0.25 1]\n";
  const std::string area = "AreaLightSource \"diffuse\" \"rgb L\" [2 2 2] \"texture map\" \"half\" ";
  const std::string square =
      "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point P\" [-1 -1 0  1 -1 0  1 1 0  -1 1 0]\n";
  for (const std::string& world :
       {area + square, area + "Shape \"disk\" \"float radius\" 1\n", area + "\"bool lights\" \"false\" " + square,
        "ObjectBegin \"o\"\n" + area + square + "ObjectEnd\nObjectInstance \"o\"\n",
        area + "Shape \"curve\" \"point P\" [-1 0 0 -0.3 0 0 0.3 0 0 1 0 0] \"float width\" 0.5\n"}) {
    const RGB mean = Rendered(scene(map + world, "whitted", 4)).mean();
    EXPECT_NEAR(mean.x, 1, 1e-5) << world;
    EXPECT_NEAR(mean.y, 0.5, 1e-5) << world;
    EXPECT_NEAR(mean.z, 2, 1e-5) << world;
  }
}

TEST(EmissionMap, ConstantsFoldAndWhatIsOnlySeenCallsForNoShadows) {
  const std::string plain = lit("", grid(2, [](int, int) { return 1; }));
  const test::BuiltScene none(scene(kGround + plain)),
      constant(scene("Texture \"c\" \"spectrum\" \"constant\" \"rgb value\" [1 1 1]\n" + kGround +
                     lit("c", grid(2, [](int, int) { return 1; }))));
  EXPECT_FALSE(none.scene->has_emission_maps || constant.scene->has_emission_maps);
  EXPECT_EQ(render(*none.scene, {}).picture.rgb, render(*constant.scene, {}).picture.rgb);
  const test::BuiltScene seen(
      scene(kGround + lit("", grid(2, [](int, int) { return 1; }), "\"bool lights\" \"false\" ")));
  EXPECT_FALSE(seen.scene->plan.needed.has(Effect::Shadows));
  EXPECT_TRUE(seen.scene->plan.needed.has(Effect::AreaLights));
  // A map in a file that cannot be read is an error of its own.
  const std::string text_file = fmt::format("{}/no_picture.png", test::temp_folder());
  std::ofstream(text_file) << "no picture";
  const auto bad = scene("Texture \"m\" \"spectrum\" \"imagemap\" \"string filename\" \"" + text_file + "\"\n" +
                         kGround + lit("m", grid(2, [](int, int) { return 1; })));
  EXPECT_THROW(test::BuiltScene(bad, {}, Warnings::Allowed), std::runtime_error);
}

}  // namespace
}  // namespace whit
