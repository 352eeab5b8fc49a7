// Case 12: what has no area, is there twice, or is no number changes nothing: the picture has the bits of the one without,
// and a warning counts what was left out.
#include <fmt/format.h>

#include <filesystem>
#include <fstream>

#include "tests/base/temp_folder.h"
#include "tests/hard/hard_case.h"
#include "tests/hard/render_text.h"

namespace whit {
namespace {

using namespace test;

Rendered picture_of(const std::string& shapes) {
  return Rendered(
      "Film \"image\" \"integer xresolution\" 48 \"integer yresolution\" 36\n"
      "Sampler \"halton\" \"integer pixelsamples\" 4\n"
      "LookAt 1 -4 2  0 0 0  0 0 1\nCamera \"perspective\" \"float fov\" 40\nWorldBegin\n"
      "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [9 8 7] Translate 2 -2 3 Shape \"sphere\" "
      "\"float radius\" 0.4 AttributeEnd\n" +
          shapes + "WorldEnd\n",
      {}, {}, Planned::Warnings::Allowed);
}

/// The messages of all warnings, a line each.
std::string said_of(const Rendered& picture) {
  std::string said;
  for (const Diagnostic& one : picture.warnings.all()) said += one.message + '\n';
  return said;
}

/// A tetrahedron on a ground quad; `more` vertices and triangles follow the nine of its own.
std::string mesh(const std::string& more_points = "", const std::string& more_indices = "") {
  return "Shape \"trianglemesh\" \"point P\" [-3 -3 -0.5  3 -3 -0.5  3 3 -0.5  -3 3 -0.5  -0.6 -0.5 -0.4  0.7 -0.4 -0.4"
         "  0 0.8 -0.4  0 0 0.9  0.1 0.1 2  " +
         more_points + "] \"integer indices\" [0 1 2 0 2 3  4 6 5  4 5 7  5 6 7  6 4 7 " + more_indices + "]\n";
}

/// A binary PLY of the same mesh, with vertices that may be no numbers.
std::string ply(const std::vector<float>& more_points, const std::vector<int32_t>& more_indices) {
  std::vector<float> p = {-3,    -3,   -0.5f, 3,     -3, -0.5f, 3,     3, -0.5f, -3,   3,    -0.5f, -0.6f, -0.5f,
                          -0.4f, 0.7f, -0.4f, -0.4f, 0,  0.8f,  -0.4f, 0, 0,     0.9f, 0.1f, 0.1f,  2};
  std::vector<int32_t> f = {0, 1, 2, 0, 2, 3, 4, 6, 5, 4, 5, 7, 5, 6, 7, 6, 4, 7};
  p.insert(p.end(), more_points.begin(), more_points.end());
  f.insert(f.end(), more_indices.begin(), more_indices.end());
  static int count = 0;
  const std::string path = temp_folder() + fmt::format("/{}.ply", count++);
  std::ofstream out(path, std::ios::binary);
  out << "ply\nformat binary_little_endian 1.0\nelement vertex " << p.size() / 3
      << "\nproperty float x\nproperty float y\nproperty float z\nelement face " << f.size() / 3
      << "\nproperty list uchar int vertex_indices\nend_header\n";
  out.write(reinterpret_cast<const char*>(p.data()), static_cast<std::streamsize>(p.size() * sizeof(float)));
  for (size_t i = 0; i < f.size(); i += 3) {
    out.put(3);
    out.write(reinterpret_cast<const char*>(&f[i]), 3 * sizeof(int32_t));
  }
  return "Shape \"plymesh\" \"string filename\" \"" + path + "\"\n";
}

constexpr const char* kGlow = "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [5 5 5]\n";

struct Input {
  const char* what;
  std::string with, without;
  std::string counted;  ///< What the warning must say.
};

std::vector<Input> inputs() {
  const std::string one = "1 degenerate triangle (no area, or repeated)", none;
  return {{"a triangle on a line", mesh("", "4 5 5"), mesh(), one},
          {"three corners in a row", mesh("9 9 0 10 10 0 11 11 0", "9 10 11"), mesh(), one},
          {"a triangle twice", mesh("", "5 7 4"), mesh(), one},
          {"three times", mesh("", "5 7 4 7 4 5"), mesh(), "2 degenerate triangles (no area, or repeated)"},
          // 1e-12 wide, 1 long: the floats of render space do not hold its width.
          {"a sliver of aspect 1e12", mesh("-1 1.5 1  -1 2.5 1  -0.999999999999 2 1", "9 10 11"), mesh(), one},
          {"a vertex far away that no triangle has", mesh("1e30 1e30 1e30"), mesh(), none},
          {"a vertex that is no number", ply({NAN, 0, 0}, {4, 5, 9}), ply({}, {}), one},
          {"an infinite vertex", ply({0, INFINITY, 0}, {4, 5, 9, 9, 6, 7}), ply({}, {}),
           "2 degenerate triangles (no area, or repeated)"},
          {"a vertex that is no number and no triangle has", ply({NAN, NAN, NAN}, {}), ply({}, {}), none},
          {"a light of no area",
           mesh() + kGlow +
               "Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point P\" "
               "[0 0 1  0 0 2  0 0 3] AttributeEnd\n",
           mesh(), one},
          {"a light twice",
           mesh() + kGlow +
               "Shape \"trianglemesh\" \"integer indices\" [0 1 2 1 2 0] \"point P\" "
               "[0 0 1  1 0 2  0 1 3] AttributeEnd\n",
           mesh() + kGlow +
               "Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point P\" [0 0 1  1 0 2  0 1 3] "
               "AttributeEnd\n",
           one},
          {"a sphere of radius 0", mesh() + "Shape \"sphere\" \"float radius\" 0\n", mesh(),
           "shape without surface: the radius is 0"},
          {"a light of radius 0", mesh() + kGlow + "Shape \"disk\" \"float radius\" 0 AttributeEnd\n", mesh(),
           "shape without surface: the radius is 0"}};
}

TEST(Hard, DegenerateInput) {
  HardCase picture({12, "degenerate input", "13 kinds of triangles, vertices, lights and shapes",
                    "values that differ from the picture without it", 0, ""});
  HardCase counted({12, "degenerate input is counted", "the same", "kinds whose warning does not say how many", 0, ""});
  for (const Input& input : inputs()) {
    const Rendered with = picture_of(input.with), without = picture_of(input.without);
    int off = 0;
    for (size_t i = 0; i < with.rgb().size(); ++i) off += with.rgb()[i] != without.rgb()[i];
    picture.see(off, input.what);
    EXPECT_EQ(said_of(without), "") << input.what;
    const std::string told = said_of(with);
    const bool said = input.counted.empty() ? told.empty() : told.rfind(input.counted, 0) == 0;
    counted.see(said ? 0 : 1, std::string(input.what) + ": " + told);
  }
}

}  // namespace
}  // namespace whit
