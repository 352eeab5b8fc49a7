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

/// The share of the pixels that differ by more than rounding can tell: 1e-3 of the ground's 0.225.
double share_off(const std::vector<float>& a, const std::vector<float>& b, double limit = 2e-4) {
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
        const auto picture = [&](const std::string& ground) {
          return Rendered(view(from, ground + thing(shape), light)).rgb();
        };
        const std::vector<float> right = picture(quad(30));
        for (const Ground& ground : kGrounds) {
          for (const double e : {1e4, 1e5, 1e6, 1e7, 1e8}) {
            const double share = share_off(picture(ground.of(e)), right);
            if (share > 0)
              printf("%s of %g, %s, %s %.10s: %g\n", ground.name, e, from, shape, light + 12, share * 4096);
            off.see(share, fmt::format("{} of {:g}, {}, {}, {}", ground.name, e, from, shape, light));
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace whit
