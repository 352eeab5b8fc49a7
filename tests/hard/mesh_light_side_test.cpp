// Case 14: meshes as lights. Mirroring, ReverseOrientation and the mesh's own normals decide together which side glows;
// the side that glows to a camera must be the one that lights, and as brightly as its area says.
#include <fmt/core.h>

#include <string>
#include <vector>

#include "core/base/fastmath.h"
#include "tests/hard/hard_case.h"
#include "tests/hard/render_text.h"

namespace whit {
namespace {

using namespace test;

/// A square of side 1 in the plane z = 0, as a mesh.
struct Mesh {
  std::string name, shape;
  int front;  ///< +1: its front is +z by the rules below, -1: -z, 0: not said here, but one of the two.
};

std::vector<Mesh> meshes() {
  std::vector<Mesh> all;
  // The corners in both orders, without normals, and with such that lie along, against and aslant.
  for (const bool ccw : {true, false}) {
    const std::string mesh = fmt::format(
        "Shape \"trianglemesh\" \"integer indices\" [{}] \"point P\" "
        "[-.5 -.5 0  .5 -.5 0  .5 .5 0  -.5 .5 0] ",
        ccw ? "0 1 2 0 2 3" : "2 1 0 3 2 0");
    all.push_back({ccw ? "ccw" : "cw", mesh, ccw ? 1 : -1});
    for (const char* n : {"0 0 1", "0 0 -1", "0.6 0 0.8", "0.5 0.8 -0.3"}) {
      all.push_back({fmt::format("{} N {}", ccw ? "ccw" : "cw", n),
                     fmt::format("{}\"normal N\" [{} {} {} {}]", mesh, n, n, n, n),
                     std::string(n).find('-') == std::string::npos ? 1 : -1});
    }
    all.push_back({ccw ? "ccw S" : "cw S", mesh + "\"vector S\" [1 0 0  1 0 0  1 0 0  1 0 0]", 0});
  }
  // Shapes that become meshes: their fronts are their makers' business.
  all.push_back({"heightfield",
                 "Translate -.5 -.5 0 Shape \"heightfield\" \"integer nu\" 2 \"integer nv\" 2 \"float Pz\" [0 0 0 0]",
                 0});
  all.push_back({"nurbs",
                 "Shape \"nurbs\" \"integer nu\" 2 \"integer nv\" 2 \"integer uorder\" 2 \"integer vorder\" 2 "
                 "\"float uknots\" [0 0 1 1] \"float vknots\" [0 0 1 1] \"float u0\" 0 \"float u1\" 1 \"float v0\" 0 "
                 "\"float v1\" 1 \"point P\" [-.5 -.5 0  .5 -.5 0  -.5 .5 0  .5 .5 0]",
                 0});
  return all;
}

/// Mirrorings of x, y and z, alone and together, and one along a diagonal that leans and stretches the z axis, and with
/// it turns normals that are aslant (but none of the ones above through the plane). All take the square to itself.
struct Placement {
  std::string text;
  bool z_turned;
};
std::vector<Placement> placements() {
  std::vector<Placement> all;
  for (int k = 0; k < 8; ++k) {
    const int x = k & 1 ? -1 : 1, y = k & 2 ? -1 : 1, z = k & 4 ? -1 : 1;
    all.push_back({fmt::format("Scale {} {} {}", x, y, z), z < 0});
  }
  all.push_back({"ConcatTransform [0 1 0 0  1 0 0 0  .4 .2 2 0  0 0 0 1]", false});
  return all;
}

/// What a camera at (0, 0, z), z = +-1, sees of the light, or of a small white wall at 2 z. The whole scene is turned
/// by `angle` around (1, 2, 3).
enum class Target { Light, Wall };
double seen(double angle, const std::string& light, Target target, int z) {
  const bool wall = target == Target::Wall;
  // Fov 0.1: the middle of the target alone.
  const std::string text = fmt::format(
      "Film \"image\" \"integer xresolution\" 1 \"integer yresolution\" 1\n"
      "Sampler \"halton\" \"integer pixelsamples\" {}\nPixelFilter \"box\"\n"
      "LookAt 0 0 {}  0 0 {}  0 1 0 Rotate {} 1 2 3 Camera \"perspective\" \"float fov\" 0.1\n"
      "WorldBegin Rotate {} 1 2 3\n{}\n"
      "Material \"matte\" \"rgb Kd\" [1 1 1] Translate 0 0 {} Shape \"disk\" \"float radius\" 0.1\nWorldEnd\n",
      wall ? 256 : 1, z, wall ? 2 * z : 0, -angle, angle, light, 2 * z);
  return static_cast<double>(Rendered(text).pixel(0, 0).x);
}

/// What the wall shows of the square of radiance 1 and side 1 at distance 2, seen from its axis: the irradiance over pi.
/// That of a rectangle with a corner on the axis and sides a and b, in distances, is half of
/// a / sqrt(1 + a^2) atan(b / sqrt(1 + a^2)) + b / sqrt(1 + b^2) atan(a / sqrt(1 + b^2)); here four with a = b = 1/4.
double wall_radiance() {
  const double a = 0.25, root = std::sqrt(1 + a * a);
  return 4 * (a / root) * std::atan(a / root) / kPi;
}

/// Looks at both sides of one light. Which side is its front: without normals that of the normal that the corners make
/// in object space, carried along as a normal is and turned by ReverseOrientation. (The corners' order in the world
/// turns when one of x and y is mirrored, and a swap of handedness turns the front again: what is left is z.) Normals
/// given with the mesh say the same by themselves.
void see(const Mesh& mesh, const Placement& p, bool reverse, double angle, HardCase& sides, HardCase& brightness) {
  const std::string light = fmt::format(
      "AttributeBegin {} {} Material \"matte\" \"rgb Kd\" [0 0 0] AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] {} "
      "AttributeEnd",
      reverse ? "ReverseOrientation" : "", p.text, mesh.shape);
  const std::string at = fmt::format("{} | {} | reverse {} angle {}", mesh.name, p.text, reverse, angle);
  int glowing = 0;
  for (const int z : {1, -1}) {
    const double visible = seen(angle, light, Target::Light, z), lit = seen(angle, light, Target::Wall, z);
    const bool glows = visible > 0;
    const int front = mesh.front * (p.z_turned != reverse ? -1 : 1);
    glowing += glows;
    sides.see((glows != (lit > 0)) + (front != 0 && glows != (front == z)), at);
    if (glows) brightness.see(std::max(std::abs(visible - 1), std::abs(lit / wall_radiance() - 1)), at);
  }
  sides.see(glowing != 1, at);
}

TEST(Hard, MeshLightsLightTheSideThatGlows) {
  HardCase sides({14, "the lit side of a mesh light is the visible one",
                  "9 mirrorings and shears x ReverseOrientation x 14 meshes (normals none, along, against, aslant; "
                  "tangents; heightfield, nurbs) x 2 turns",
                  "wrong sides", 0,
                  "with normals or tangents under ReverseOrientation one side glows, the other is lit"});
  // The pixel's 256 Halton points integrate cos cos' / r^2, which varies by a factor of 0.8 over the square: a standard
  // deviation of about 5 %, of 256 random points 0.3 % of the mean; 1 % is three of these, and Halton is better.
  HardCase brightness({14, "what a mesh light gives to a wall, and shows", "the same, on the side that glows",
                       "relative error against the form factor", 0.01, ""});
  for (const Mesh& mesh : meshes()) {
    for (const Placement& p : placements()) {
      for (const bool reverse : {false, true}) {
        for (const double angle : {0.0, 77.0}) see(mesh, p, reverse, angle, sides, brightness);
      }
    }
  }
}

}  // namespace
}  // namespace whit
