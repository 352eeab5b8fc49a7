// Case 4: the whole scene moved, turned, mirrored and scaled, with the camera, shows the same picture. Lengths that are
// parameters (radii, the lens, a bump's height) scale with it, and the intensity of a point light by the square, for
// what arrives falls with the square of the distance; radiance stays. The rounding of transforms in double and of
// geometry in float, 6e-8 of the distance from the camera, remains: it moves a ray by 1e-5 of a pixel, so that a
// sample's brightness changes by about 1e-5 of itself, relMSE 1e-10. Only a sample on an edge changes more, and 1e-6
// leaves room for none in a picture of 3072 pixels and 8 samples: half a pixel's brightness over 8, squared, is
// 4e-3, and 4e-3 / 3072 = 1e-6.
#include <fmt/core.h>

#include <array>

#include "tests/hard/hard_case.h"
#include "tests/hard/render_text.h"

namespace whit {
namespace {

using namespace test;

/// A similarity: by the numbers of the scene (scale, then offset), and then by statements.
struct Similarity {
  double scale = 1;                      ///< All coordinates and lengths are multiplied by this.
  std::array<double, 3> offset{};        ///< Then this is added to coordinates.
  std::string statements{}, inverse{};   ///< Those of the world, and what undoes them, for the camera.
  double statements_scale = 1;           ///< How much the statements scale.
  bool mirrors = false;                  ///< The statements mirror.
  std::string fibre = "hair";            ///< The material of a curve.
  std::string light = "Shape \"disk\"";  ///< One that is sampled in its own space: turning takes the samples along.
};

class SceneText {
 public:
  explicit SceneText(const Similarity& s) : s_(s) {}

  std::string text() const {
    const double all = s_.scale * s_.statements_scale;
    return camera() + "WorldBegin\n" + s_.statements + "\nLightSource \"infinite\" \"rgb L\" [.1 .12 .15]\n" +
           placed(2, 4, 3,
                  fmt::format("LightSource \"point\" \"rgb I\" [{0:.17g} {0:.17g} {0:.17g}]", 20 * all * all)) +
           placed(-2, 3, 0,
                  "AreaLightSource \"diffuse\" \"rgb L\" [5 5 5] Rotate 180 1 0 0 " + side() + s_.light +
                      radius("radius", 1)) +
           textures() + floor() + balls() + placed_object() + "WorldEnd\n";
  }

 private:
  std::string point(double x, double y, double z) const {
    return fmt::format("{:.17g} {:.17g} {:.17g} ", x * s_.scale + s_.offset[0], y * s_.scale + s_.offset[1],
                       z * s_.scale + s_.offset[2]);
  }
  std::string radius(const char* name, double r) const {
    return fmt::format(" \"float {}\" {:.9g}\n", name, r * s_.scale);
  }
  std::string placed(double x, double y, double z, const std::string& what) const {
    return "AttributeBegin Translate " + point(x, y, z) + what + " AttributeEnd\n";
  }

  std::string camera() const {
    return "Film \"image\" \"integer xresolution\" 64 \"integer yresolution\" 48\n"
           "Sampler \"halton\" \"integer pixelsamples\" 8\n"
           "LookAt " +
           point(0, 2, 6) + point(0, 0.5, 0) + "0 1 0\n" + s_.inverse + "\nCamera \"perspective\" \"float fov\" 40" +
           lens();
  }
  /// As in pbrt-v3, the normals of analytic shapes turn round where the transform mirrors; here they shall not.
  std::string side() const { return s_.mirrors ? "ReverseOrientation " : ""; }

  /// In the camera's own space, which is larger than the world by what the statements of the world are smaller.
  std::string lens() const { return radius("lensradius", 0.03) + radius("focaldistance", 6); }

  std::string floor() const {
    return "AttributeBegin Texture \"checks\" \"spectrum\" \"checkerboard\" \"float uscale\" 8 \"float vscale\" 8\n"
           "Material \"matte\" \"texture Kd\" \"checks\"\n"
           "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"float uv\" [0 0 0 1 1 1 1 0] \"point P\" [" +
           point(-5, 0, -5) + point(-5, 0, 5) + point(5, 0, 5) + point(5, 0, -5) + "] AttributeEnd\n";
  }

  /// 3D textures see world points through the transform as it is, not its inverse: the way back to where nothing moved.
  std::string textures() const {
    return fmt::format(
               "TransformBegin Identity Scale {0:.17g} {0:.17g} {0:.17g} Translate {1:.17g} {2:.17g} {3:.17g}\n",
               1 / s_.scale, -s_.offset[0], -s_.offset[1], -s_.offset[2]) +
           s_.inverse + " Texture \"f\" \"spectrum\" \"fbm\" Texture \"w\" \"float\" \"wrinkled\" TransformEnd\n";
  }

  /// The bump's height is a length of the world.
  std::string balls() const {
    return placed(-1.3, 0.5, 0,
                  fmt::format("Texture \"b\" \"float\" \"scale\" \"texture tex1\" \"w\" \"float tex2\" {:.9g}\n"
                              "Material \"plastic\" \"texture Kd\" \"f\" \"texture bumpmap\" \"b\" {}Shape \"sphere\"",
                              0.1 * s_.scale * s_.statements_scale, side()) +
                      radius("radius", 0.5)) +
           placed(0, 0.5, 0, "Material \"mirror\" " + side() + "Shape \"sphere\"" + radius("radius", 0.5)) +
           placed(1.3, 0.5, 0, "Material \"glass\" " + side() + "Shape \"sphere\"" + radius("radius", 0.5)) +
           placed(0.7, 0, 1.2,
                  "Rotate -90 1 0 0 Material \"metal\" " + side() + "Shape \"paraboloid\"" + radius("radius", 0.3) +
                      radius("zmax", 0.5));
  }

  /// An object with a mesh that has normals, and a curve. It is defined where it would stand without the statements.
  std::string placed_object() const {
    return "AttributeBegin Identity ObjectBegin \"o\" Material \"uber\" Shape \"trianglemesh\" \"integer indices\" [0 "
           "1 2]"
           " \"normal N\" [0 1 1 1 0 1 -1 0 1] \"point P\" [" +
           point(-1, 0, 1) + point(-0.2, 0, 1) + point(-0.6, 0.7, 1) + "]\nMaterial \"" + s_.fibre +
           "\" Shape \"curve\"" + radius("width", 0.1) + "\"point P\" [" + point(-0.2, 0, 1.5) + point(-0.2, 0.5, 1.4) +
           point(0.2, 0.5, 1.3) + point(0.3, 0.2, 1.6) + "] ObjectEnd AttributeEnd\nObjectInstance \"o\"\n";
  }

  const Similarity& s_;
};

std::vector<float> picture(const Similarity& s) { return Rendered(SceneText(s).text()).rgb(); }

/// What is compared with: nothing was done to it.
std::vector<float> reference(const Similarity& none = {}) {
  const std::vector<float> rgb = picture(none);
  double sum = 0;
  for (const float v : rgb) sum += static_cast<double>(v);
  EXPECT_GT(sum / static_cast<double>(rgb.size()), 0.1);
  return rgb;
}

/// Scaled by a statement, the camera's own space stays of ordinary size; by numbers, the camera stands in the world.
Similarity scaled_by_statement(double s) {
  Similarity out;
  out.statements = fmt::format("Scale {0:.17g} {0:.17g} {0:.17g}", s);
  out.inverse = fmt::format("Scale {0:.17g} {0:.17g} {0:.17g}", 1 / s);
  out.statements_scale = s;
  return out;
}

void see_scales(HardCase& worst, const std::vector<double>& scales) {
  for (const std::string light : {"Shape \"disk\"", "Shape \"sphere\""}) {
    Similarity none;
    none.light = light;
    const std::vector<float> as_is = reference(none);
    for (const double s : scales) {
      Similarity numbers;
      numbers.scale = s, numbers.light = light;
      worst.see(relative_mse(picture(numbers), as_is), fmt::format("{} in numbers, {}", s, light));
      Similarity statement = scaled_by_statement(s);
      statement.light = light;
      worst.see(relative_mse(picture(statement), as_is), fmt::format("{} by Scale, {}", s, light));
    }
  }
}

TEST(Hard, ScaledScenes) {
  HardCase worst({4, "a scene scaled, in its numbers and by Scale", "1e-6 to 1e6; light of a disk and of a sphere",
                  "relMSE", 1e-6, ""});
  see_scales(worst, {1e-6, 1.3e-5, 1e-4, 1.7e-3, 1e-2, 0.31, 3, 10, 700, 1e3, 1.9e4, 1e5, 1e6});
}

TEST(Hard, ScenesOfExtremeScale) {
  HardCase worst({4, "the same far beyond", "1e-12 to 1e-7 and 1e7 to 1e12", "relMSE", 1e-6, ""});
  see_scales(worst, {1e-12, 1.3e-11, 1e-10, 1.7e-8, 1e-7, 1e7, 1.9e8, 1e10, 3e11, 1e12});
}

/// Moved by a statement, or in the numbers.
void see_moves(HardCase& worst, const std::vector<double>& distances) {
  const std::vector<float> as_is = reference();
  for (const double by : distances) {
    // The statement's numbers are those the other way has, of different size and sign in each coordinate.
    Similarity numbers, statement;
    numbers.offset = {by, -0.37 * by, 0.61 * by};
    statement.statements = fmt::format("Translate {:.17g} {:.17g} {:.17g}", by, -0.37 * by, 0.61 * by);
    statement.inverse = fmt::format("Translate {:.17g} {:.17g} {:.17g}", -by, 0.37 * by, -0.61 * by);
    worst.see(relative_mse(picture(numbers), as_is), fmt::format("{} in numbers", by));
    worst.see(relative_mse(picture(statement), as_is), fmt::format("{} by Translate", by));
  }
}

TEST(Hard, MovedScenes) {
  HardCase worst(
      {4, "a scene moved, in its numbers and by Translate", "by 1 to 1e7", "relMSE", 1e-6, "relMSE 1e-2 at 1e6"});
  see_moves(worst, {1, -33, 1e3, 1e4, -1e5, 1e6, -3e6, 1e7});
}

TEST(Hard, ScenesMovedFar) {
  HardCase worst({4, "the same far beyond", "by 1e8 to 1e12", "relMSE", 1e-6, ""});
  see_moves(worst, {1e8, -1e9, 1e10, -1e11, 1e12});
}

/// Degrees about an axis, mirrored in some axes first, scaled and moved last.
Similarity turned(double degrees, const std::string& axis, int mirrored, double scale, double by) {
  const std::string mirror =
      fmt::format("Scale {} {} {}", mirrored & 1 ? -1 : 1, mirrored & 2 ? -1 : 1, mirrored & 4 ? -1 : 1);
  Similarity out;
  out.statements =
      fmt::format("Translate {0:.17g} {0:.17g} {0:.17g} Scale {1:.17g} {1:.17g} {1:.17g} Rotate {2} {3} {4}", by, scale,
                  degrees, axis, mirror);
  out.inverse = fmt::format("{4} Rotate {2} {3} Scale {1:.17g} {1:.17g} {1:.17g} Translate {0:.17g} {0:.17g} {0:.17g}",
                            -by, 1 / scale, -degrees, axis, mirror);
  out.statements_scale = scale;
  out.mirrors = (mirrored ^ mirrored >> 1 ^ mirrored >> 2) & 1;
  return out;
}

TEST(Hard, TurnedScenes) {
  HardCase worst({4, "a scene turned about two axes", "1 to 359 degrees", "relMSE", 1e-6, ""});
  const std::vector<float> as_is = reference();
  for (const double degrees : {1.0, 37.0, 90.0, 123.0, 180.0, 251.0, 359.0}) {
    for (const std::string axis : {"0 1 0", "1 2 -3"}) {
      worst.see(relative_mse(picture(turned(degrees, axis, 0, 1, 0)), as_is),
                fmt::format("{} about {}", degrees, axis));
    }
  }
}

TEST(Hard, MirroredScenes) {
  // Without hair: its scattering knows left from right by the curve's v, which pbrt-v3 does not mirror.
  HardCase worst({4, "a scene mirrored; and that turned, scaled and moved as well",
                  "in all 8 ways; 123 degrees, scale 3e-4 and 2e3, by 1e5 of the scene's units", "relMSE", 1e-6, ""});
  const auto mirrored_picture = [](int axes, double degrees, double scale, double by) {
    Similarity s = turned(degrees, "1 2 -3", axes, scale, by * scale);
    s.fibre = "plastic";
    return picture(s);
  };
  const std::vector<float> as_is = mirrored_picture(0, 0, 1, 0);
  for (int axes = 0; axes < 8; ++axes) {
    worst.see(relative_mse(mirrored_picture(axes, 0, 1, 0), as_is), fmt::format("axes {}", axes));
    for (const double scale : {3e-4, 2e3}) {
      worst.see(relative_mse(mirrored_picture(axes, 123, scale, 1e5), as_is),
                fmt::format("axes {} scale {}", axes, scale));
    }
  }
}

}  // namespace
}  // namespace whit
