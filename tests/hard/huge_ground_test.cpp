// Case 18: a ground that is huge beside what stands on it. Everybody has one. The picture is that of a ground that just
// fills the view, whatever the ground's size and form.
#include <fmt/format.h>

#include "tests/hard/hard_case.h"
#include "tests/hard/render_text.h"

namespace whit {
namespace {

using namespace test;

constexpr const char* kFrom[] = {
    // Straight down and from the side, at unit things.
    "LookAt 0 0 5  0 0 0  0 1 0 Camera \"orthographic\" \"float screenwindow\" [-2 2 -2 2]",
    "LookAt 0 0 5  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 40",
    "LookAt 1 -4 2.5  0 0 .4  0 0 1 Camera \"perspective\" \"float fov\" 40",
    "LookAt 300 -1200 700  0 0 .4  0 0 1 Camera \"perspective\" \"float fov\" .15"};

constexpr const char* kCube =
    "Shape \"trianglemesh\" \"integer indices\" [0 2 1 0 3 2 4 5 6 4 6 7 0 1 5 0 5 4 1 2 6 1 6 5 2 3 7 2 7 6 3 0 4 3 4 "
    "7] "
    "\"point P\" [-.5 -.5 0  .5 -.5 0  .5 .5 0  -.5 .5 0  -.5 -.5 1  .5 -.5 1  .5 .5 1  -.5 .5 1]";
constexpr const char* kBall = "Translate 0 0 .5 Shape \"sphere\" \"float radius\" .5";

std::string view(const std::string& from, const std::string& world, const std::string& light) {
  return "Film \"image\" \"integer xresolution\" 64 \"integer yresolution\" 64\n"
         "Sampler \"stratified\" \"integer xsamples\" [1] \"integer ysamples\" [1] \"bool jitter\" \"false\"\n"
         "PixelFilter \"box\"\n" +
         from + "\nWorldBegin\n" + light + "Material \"matte\" \"rgb Kd\" [.5 .5 .5]\n" + world + "\nWorldEnd\n";
}

constexpr const char* kSun =
    "LightSource \"distant\" \"point from\" [1 0.01 1] \"point to\" [0 0 0] \"rgb L\" [2 2 2]\n";
constexpr const char* kLamp = "LightSource \"point\" \"point from\" [3 1.02 4] \"rgb I\" [40 40 40]\n";

std::string thing(const char* shape) {
  return fmt::format("AttributeBegin Material \"matte\" \"rgb Kd\" [.5 0 0] {} AttributeEnd\n", shape);
}

/// A ground in z = 0 that reaches `e` to each side.
std::string triangle(double e) {
  return fmt::format("Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point P\" [{0} {0} 0  {1} {0} 0  0 {1} 0]\n",
                     -e, e);
}
/// Two triangles with an edge between them under the things.
std::string quad(double e) {
  return fmt::format(
      "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point P\" [{0} {0} 0  {1} {0} 0  {1} {1} "
      "0  {0} {1} 0] \"normal N\" [0 0 1 0 0 1 0 0 1 0 0 1]\n",
      -e, e);
}
/// Far off its own middle.
std::string strip(double e) {
  return fmt::format(
      "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point P\" [{0} -7.25 0  7.3 -9 0  5.2 {1} "
      "0  {0} {1} 0]\n",
      -e, e);
}
std::string disk(double e) { return fmt::format("Shape \"disk\" \"float radius\" {}\n", e); }
std::string field(double e) {
  return fmt::format(
      "AttributeBegin Translate {0} {0} 0 Scale {1} {1} 1 Shape \"heightfield\" \"integer nu\" 3 \"integer "
      "nv\" 3 \"float Pz\" [0 0 0 0 0 0 0 0 0] AttributeEnd\n",
      -e, 2 * e);
}
std::string instanced(double e) {
  return "ObjectBegin \"ground\"\n" + quad(e) +
         "ObjectEnd\nAttributeBegin Translate .3 -.2 0 ObjectInstance \"ground\" "
         "AttributeEnd\n";
}
std::string moving(double e) {
  return "AttributeBegin ActiveTransform EndTime Translate 1 2 0 ActiveTransform All\n" + quad(e) + "AttributeEnd\n";
}

struct Ground {
  const char* name;
  std::string (*of)(double);
};
constexpr Ground kGrounds[] = {{"a triangle", triangle}, {"a quad with normals", quad}, {"two long triangles", strip},
                               {"a disk", disk},         {"a heightfield", field},      {"an instance", instanced},
                               {"a moving quad", moving}};

/// The ground and the cube in one mesh.
std::string with_cube(double e) {
  return fmt::format(
      "Shape \"trianglemesh\" \"integer indices\" [0 2 1 0 3 2 4 5 6 4 6 7 0 1 5 0 5 4 1 2 6 1 6 5 2 3 7 2 7 6 3 0 4 3 "
      "4 7 "
      "8 9 10] \"point P\" [-.5 -.5 0  .5 -.5 0  .5 .5 0  -.5 .5 0  -.5 -.5 1  .5 -.5 1  .5 .5 1  -.5 .5 1  {0} {0} 0  "
      "{1} "
      "{0} 0  0 {1} 0]\n",
      -e, e);
}
std::string planet(double e) {
  return fmt::format("AttributeBegin Translate 0 0 {} Shape \"sphere\" \"float radius\" {} AttributeEnd\n", -e, e);
}
/// With texture coordinates that are the place.
std::string mapped(double e, const std::string& more = "") {
  return fmt::format(
      "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point P\" [{0} {0} 0  {1} {0} 0  {1} {1} "
      "0  {0} {1} 0] \"float uv\" [{0} {0}  {1} {0}  {1} {1}  {0} {1}] {2}\n",
      -e, e, more);
}
/// Squares whose edges are on no pixel's centre.
constexpr const char* kSquares =
    "\"checkerboard\" \"float uscale\" .913 \"float vscale\" 1.17 \"float udelta\" .31 \"float vdelta\" .27 "
    "\"string aamode\" \"none\"";
std::string textured(double e) {
  return fmt::format("Texture \"squares\" \"color\" {} Material \"matte\" \"texture Kd\" \"squares\"\n", kSquares) +
         mapped(e);
}
/// Its shadow falls on a floor below.
std::string cut_out(double e) {
  return fmt::format("Texture \"squares\" \"float\" {} \"float tex1\" 0 \"float tex2\" 1\n", kSquares) +
         mapped(e, "\"texture alpha\" \"squares\"") + "AttributeBegin Translate 0 0 -1.13 " + mapped(30) +
         "AttributeEnd\n";
}
std::string mirror(double e) { return "Material \"mirror\"\n" + mapped(e); }
std::string tilted(double e) { return "Rotate 33 1 2 3\n" + quad(e); }

/// The share of the pixels that differ by more than that: 0.1 % of the ground's 0.225 unless given.
double share_off(const std::vector<float>& a, const std::vector<float>& b, double limit = 2.25e-4) {
  int off = 0;
  for (size_t i = 0; i < b.size(); i += 3) {
    double most = 0;
    for (size_t c = 0; c < 3; ++c) {
      most = std::max(most, std::abs(static_cast<double>(a[i + c]) - static_cast<double>(b[i + c])));
    }
    off += !(most <= limit);
  }
  return off / static_cast<double>(b.size() / 3);
}

TEST(Hard, HugeGround) {
  // Rounding decides in whose shadow a pixel is whose centre is nearer than 1e-6 to its edge: none here.
  HardCase off({18, "the picture is that of a small ground",
                "7 forms of grounds of 1e4 to 1e8 units under a unit cube and ball, 4 cameras, sun and lamp",
                "share of pixels off by more than 0.1 %", 0, "offsets grow with the ground"});
  for (const char* from : kFrom) {
    for (const char* shape : {kBall, kCube}) {
      for (const char* light : {kSun, kLamp}) {
        const std::vector<float> right = Rendered(view(from, quad(30) + thing(shape), light)).rgb();
        for (const Ground& ground : kGrounds) {
          for (const double e : {1e4, 1e5, 1e6, 1e7, 1e8}) {
            const Rendered picture(view(from, ground.of(e) + thing(shape), light));
            off.see(share_off(picture.rgb(), right),
                    fmt::format("{} of {:g}, {}, {}, {}", ground.name, e, from, shape, light));
          }
        }
      }
    }
  }
}

TEST(Hard, HugeGroundOfEveryKind) {
  // As above, each beside itself with 100 units, which fill the view. What a mirror shows is off by 6e-8 of the way from the camera, 1400 units,
  // magnified by the ball; and two pixels may be on an edge. The cube stands in its own mesh, the planet is as flat as 4^2 / 2e6.
  HardCase off({18, "the same for textures, alpha, mirrors, tilted grounds, a mesh that holds both, a planet",
                "grounds of 1e5 to 1e8 units, 4 cameras, sun and lamp", "share of pixels off by more than 1 %", 5e-4,
                ""});
  struct Kind {
    const char* name;
    std::string (*of)(double);
    const char* thing;
    std::string (*right)(double);
    double smallest;
  };
  const Kind kinds[] = {{"textured", textured, kBall, textured, 1e5},   {"cut out", cut_out, kBall, cut_out, 1e5},
                        {"a mirror", mirror, kBall, mirror, 1e5},       {"tilted", tilted, kBall, tilted, 1e5},
                        {"with a cube", with_cube, "", with_cube, 1e5}, {"a planet", planet, kBall, quad, 1e7}};
  for (const char* from : kFrom) {
    for (const char* light : {kSun, kLamp}) {
      for (const Kind& kind : kinds) {
        const std::vector<float> right = Rendered(view(from, kind.right(100) + thing(kind.thing), light)).rgb();
        for (const double e : {1e5, 1e6, 1e7, 1e8}) {
          if (e < kind.smallest) continue;
          const Rendered picture(view(from, kind.of(e) + thing(kind.thing), light));
          off.see(share_off(picture.rgb(), right, 2e-3), fmt::format("{} of {:g}, {}, {}", kind.name, e, from, light));
        }
      }
    }
  }
}

TEST(Hard, HugeGroundInNumbers) {
  // Light along (-1, 0, -1) / sqrt 2 of radiance 2 on a ground of reflectance 1/2: 2 cos(45) 0.5 / pi = 0.22508. A ball of
  // radius 0.5 and reflectance (0.5, 0, 0) has the same in red at its highest point. Its shadow reaches from x = -1.2 to -0.8
  // at least, for |y| < 0.2.
  const std::string sun = "LightSource \"distant\" \"point from\" [1 0 1] \"point to\" [0 0 0] \"rgb L\" [2 2 2]\n";
  const float lit = static_cast<float>(std::sqrt(2.0) * 0.5 / M_PI);
  for (const double e : {1e4, 1e5, 1e6, 1e7, 1e8, 1e10}) {
    const Rendered picture(view(kFrom[0], triangle(e) + thing(kBall), sun));
    EXPECT_NEAR(picture.pixel(60, 32).x, lit, 1e-5f) << e;
    EXPECT_NEAR(picture.pixel(60, 32).z, lit, 1e-5f) << e;
    // The pixel's centre is 1/32 off the highest point in x and y, where the normal is (-1/16, -1/16, 0.99609).
    EXPECT_NEAR(picture.pixel(32, 32).x, lit * (0.99609f - 0.0625f), 1e-5f) << e;
    EXPECT_EQ(picture.pixel(32, 32).y, 0) << e;
    for (int y = 29; y <= 34; ++y) {  // Pixels of 1/16 unit; x, to the left, of -0.8 to -1.2 is pixels 45 to 50.
      for (int x = 45; x <= 50; ++x) EXPECT_EQ(picture.pixel(x, y), RGB(0.0f)) << e << ": " << x << ' ' << y;
    }
  }
}

/// A square of two units whose edges go through the centres of pixels, within eight triangles that reach far.
std::string framed(double e) {
  return fmt::format(
      "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3  0 4 1 1 4 5 1 5 2 2 5 6 2 6 3 3 6 7 3 7 0 0 7 4] "
      "\"point P\" "
      "[-.96875 -.96875 0  .96875 -.96875 0  .96875 .96875 0  -.96875 .96875 0  {0} {0} 0  {1} {0} 0  {1} {1} 0  {0} "
      "{1} "
      "0]\n",
      -e, e);
}

TEST(Hard, HugeLampShines) {
  // A ground that glows shows its own radiance everywhere, and no ray is lost: neither between huge triangles nor between
  // huge and small ones, also where both are tilted.
  for (const double e : {1e4, 1e6, 1e8}) {
    const Rendered picture(
        view(kFrom[2],
             "AreaLightSource \"diffuse\" \"rgb L\" [3 2 1]\nMaterial \"matte\" \"rgb Kd\" [0 0 0]\n" + quad(e), ""));
    for (int y = 40; y < 64; ++y) EXPECT_EQ(picture.pixel(32, y), RGB(3, 2, 1)) << e;
    for (const char* tilt : {"", "Rotate 17 1 2 .5 "}) {
      for (int from = 0; from < 2; ++from) {
        const Rendered from_above(
            view(kFrom[from],
                 "AreaLightSource \"diffuse\" \"rgb L\" [3 2 1] \"bool twosided\" \"true\"\nMaterial "
                 "\"matte\" \"rgb Kd\" [0 0 0]\n" +
                     std::string(tilt) + framed(e),
                 ""));
        for (int i = 0; i < 64 * 64; ++i) EXPECT_EQ(from_above.pixel(i % 64, i / 64), RGB(3, 2, 1)) << e << tilt << i;
      }
    }
  }
}

}  // namespace
}  // namespace whit
