// Case 9: surfaces that lie in one another. Rounding would decide sample by sample which of them is seen; instead the
// later one is, and a warning names both. Both glow, so that a picture says of every sample which it met.
#include <fmt/format.h>

#include "tests/hard/hard_case.h"
#include "tests/hard/render_text.h"

namespace whit {
namespace {

using namespace test;

Rendered picture_of(const std::string& text, int threads = 0) {
  RenderOptions options;
  options.threads = threads;
  return Rendered(text, {}, options, Planned::Warnings::Allowed);
}

std::string world(const std::string& shapes) {
  return "Film \"image\" \"integer xresolution\" 120 \"integer yresolution\" 90\n"
         "Sampler \"halton\" \"integer pixelsamples\" 16\n"
         "LookAt 2 -5 7  0.2 0.1 0.1  0 0 1\nCamera \"perspective\" \"float fov\" 30\nWorldBegin\n" +
         shapes + "WorldEnd\n";
}

std::string glowing(const char* colour, const std::string& shape) {
  return fmt::format(
      "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [{}] \"bool twosided\" \"true\"\n"
      "Material \"matte\" \"rgb Kd\" [0 0 0]\n{}\nAttributeEnd\n",
      colour, shape);
}

std::string quad(const char* corners, const char* indices = "0 1 2 0 2 3") {
  return fmt::format("Shape \"trianglemesh\" \"integer indices\" [{}] \"point P\" [{}]", indices, corners);
}

struct Pair {
  const char* name;
  std::string lower, upper;
};

std::vector<Pair> pairs() {
  // The lower surfaces fill the view; in the middle, where the upper lies, the planes z = 0.1 and a tilted one.
  const std::string ground = quad("-9 -9 0.1  9.3 -9 0.1  9 9 0.1  -9 9.7 0.1");
  const std::string decal = quad("-1.3 -1.1 0.1  1.2 -1 0.1  1.1 1.4 0.1  -1 0.9 0.1");
  const std::string turned = quad("-1.3 -1.1 0.1  1.2 -1 0.1  1.1 1.4 0.1  -1 0.9 0.1", "2 1 0 3 2 0");
  const std::string tilt = "Rotate 11 1 2 3 ";
  return {{"the same quad, split along the other diagonal", ground,
           quad("-9 -9 0.1  9.3 -9 0.1  9 9 0.1  -9 9.7 0.1", "0 1 3 1 2 3")},
          {"a quad on a larger one", ground, decal},
          {"a quad facing away from it", ground, turned},
          {"the same, tilted", tilt + ground, tilt + decal},
          {"a disk on a quad", ground, "Shape \"disk\" \"float height\" 0.1 \"float radius\" 1.2"},
          {"a quad on a disk", "Shape \"disk\" \"float height\" 0.1 \"float radius\" 20", decal},
          {"a disk on a disk", tilt + "Shape \"disk\" \"float radius\" 20",
           tilt + "Translate 0.3 0.1 0 Shape \"disk\" \"float radius\" 1.1 \"float phimax\" 250"},
          {"a part of a sphere on a sphere", "Translate 0 0 -20 Shape \"sphere\" \"float radius\" 20.3",
           "Translate 0 0 -20 Rotate 4 1 1 0 Shape \"sphere\" \"float radius\" 20.3 \"float zmin\" 20.2"}};
}

TEST(Hard, CoincidentSurfaces) {
  HardCase speckle({9, "the later of two surfaces in one another is seen",
                    "quads, disks and spheres on one another, 8 pairs, 172,800 samples each",
                    "share of samples that meet the other", 5e-5, "speckle: rounding decides"});
  HardCase threads({9, "the same for any number of threads", "the same pairs, 1 and 2 threads", "pixels that differ", 0,
                    "depends on the order of the BVH"});
  HardCase warned(
      {9, "a warning names both shapes", "the same pairs", "pairs without, or without both places", 0, "says nothing"});
  for (const Pair& pair : pairs()) {
    const std::string lower = glowing("1 0 0", pair.lower), upper = glowing("0 1 0", pair.upper);
    const Rendered together = picture_of(world(lower + upper), 1), again = picture_of(world(lower + upper), 2);
    const Rendered alone = picture_of(world(upper), 1);
    // The ground fills the view and glows with 1 in red: what of a pixel's samples is not green is red. Sums of 16
    // sixteenths are exact.
    // What may go wrong is the rim of the upper, 3e-5 of a group's hundred units: where it is 10 units around and the
    // group 30 wide, that is 10 * 1e-5 of the 20 square units in view, 5e-6 of the samples.
    double off = 0;
    for (size_t i = 0; i < together.rgb().size(); i += 3) {
      off += std::abs(static_cast<double>(together.rgb()[i + 1] - alone.rgb()[i + 1]));
      EXPECT_EQ(together.rgb()[i] + together.rgb()[i + 1], 1) << pair.name;
    }
    speckle.see(off / (120 * 90), pair.name);
    threads.see(together.rgb() == again.rgb() ? 0 : 1, pair.name);
    const auto& said = together.warnings.all();
    warned.see(said.size() == 1 && said[0].where.known() && said[0].other.known() &&
                       said[0].where.offset < said[0].other.offset && alone.warnings.all().empty()
                   ? 0
                   : 1,
               pair.name);
  }
}

TEST(Hard, SolidsOnTheGround) {
  // A cube of glass on a glowing floor: its lower face lies in the floor, and is cut away there. Through it the floor is
  // seen, however the cube's statement comes: with the floor cut away instead, rays would end in the dark below.
  const std::string floor = glowing("1 1 1", quad("-9 -9 0  9 -9 0  9 9 0  -9 9 0"));
  const std::string cube = "AttributeBegin Material \"glass\"\n" +
                           quad("-1 -1 0  1 -1 0  1 1 0  -1 1 0  -1 -1 2  1 -1 2  1 1 2  -1 1 2",
                                "0 2 1 0 3 2 4 5 6 4 6 7 0 1 5 0 5 4 1 2 6 1 6 5 2 3 7 2 7 6 3 0 4 3 4 7") +
                           "\nAttributeEnd\n";
  HardCase dark({9, "a glass cube on a floor", "before and after the floor",
                 "pixels darker than a face's transmittance allows", 0, ""});
  for (const std::string& shapes : {floor + cube, cube + floor}) {
    // Straight down: the upper face lets 0.96 (1 / 1.5)^2 of the floor's radiance 1 in, and the inside face's mirror image
    // and the outside's are dark. Leaving is not part of it: the floor is met inside.
    const std::string text =
        "Film \"image\" \"integer xresolution\" 8 \"integer yresolution\" 8\n"
        "Sampler \"halton\" \"integer pixelsamples\" 4\nLookAt 0 0 9  0 0 0  0 1 0\n"
        "Camera \"perspective\" \"float fov\" 2\nWorldBegin\n" +
        shapes + "WorldEnd\n";
    const Rendered picture = picture_of(text);
    EXPECT_TRUE(picture.warnings.all().empty());
    int off = 0;
    // A camera outside sees radiance L inside the glass as 0.96 L / 1.5^2.
    for (const float v : picture.rgb()) off += std::abs(static_cast<double>(v) - 0.96 / 2.25) > 1e-3;
    dark.see(off);
  }
}

TEST(Hard, WhatIsSaidOfCoincidence) {
  const std::string floor = quad("-20 -20 0  20 -20 0  20 20 0  -20 20 0") + "\n";
  const auto apart = [](const std::string& shape) { return "AttributeBegin " + shape + " AttributeEnd\n"; };
  const auto cube_of = [](const std::string& more) {
    return "Shape \"trianglemesh\" " + more +
           " \"integer indices\" [0 2 1 0 3 2 4 5 6 4 6 7 0 1 5 0 5 4 1 2 6 1 6 5 2 3 7 2 7 6 3 0 4 3 4 7] \"point P\" "
           "[-.5 -.5 0  .5 -.5 0  .5 .5 0  -.5 .5 0  -.5 -.5 1  .5 -.5 1  .5 .5 1  -.5 .5 1]";
  };
  const std::string cube = apart(cube_of(""));
  const std::string holes = "Texture \"holes\" \"float\" \"checkerboard\" \"float tex1\" 0 \"float tex2\" 1\n";
  const std::string disk = "Shape \"disk\" \"float radius\" 20\n";
  const std::string decal = quad("-.2 -.2 0  .2 -.2 0  .2 .2 0  -.2 .2 0") + "\n";
  const std::string fine =
      "Shape \"loopsubdiv\" \"integer levels\" 5 \"integer indices\" [0 1 2 0 2 3] \"point P\" "
      "[-2 -2 0  2 -2 0  2 2 0  -2 2 0]\n";
  struct Case {
    const char* name;
    size_t warnings;
    std::string shapes;
  };
  // Seen from above.
  const Case cases[] = {
      {"a cube on a floor", 0, floor + cube},
      {"a floor under a cube", 0, cube + floor},
      {"a cube on a floor that faces down", 0, apart("Scale 1 1 -1 " + floor) + cube},
      {"a cube that faces inward", 0, floor + apart("ReverseOrientation Scale -1 1 1 " + cube_of(""))},
      {"a cube on a disk", 0, disk + cube},
      {"a disk under a cube", 0, cube + disk},
      {"cubes side by side", 0, cube + apart("Translate 1 .1 0 " + cube_of(""))},
      {"quads that share an edge", 0, floor + apart("Translate 40 0 0 " + floor)},
      {"a small square turned in a large one", 1, apart("Rotate 135 0 0 1 Scale .05 .05 1 " + floor) + floor},
      {"the same, facing down", 1, apart("Rotate 135 0 0 1 Scale -.05 .05 1 " + floor) + floor},
      {"squares that overlap", 1, floor + apart("Translate 39.9 39.8 0 " + floor)},
      {"a cube with holes on a floor", 1, holes + floor + apart(cube_of("\"texture alpha\" \"holes\""))},
      {"a cube on a floor with holes", 1,
       holes +
           "Shape \"trianglemesh\" \"texture alpha\" \"holes\" \"integer indices\" [0 1 2] \"point P\" [-20 -20 0  20 "
           "-20 0  0 20 0]\n" +
           cube},
      {"a cube sunk in a floor", 1, floor + apart("Translate 0 0 -1 " + cube_of(""))},
      {"a picture on a cube", 1, cube + apart("Translate 0 0 1 " + decal)},
      {"a picture that faces the cube", 1, apart("Translate 0 0 1 Scale 1 -1 1 " + decal) + cube},
      {"a square in a fine mesh", 1, fine + apart("Rotate 20 0 0 1 " + decal)},
      {"equal spheres", 1, "Shape \"sphere\"\n" + apart("Rotate 30 1 1 0 Shape \"sphere\" \"float zmax\" .5")},
      {"a disk and a floor that just overlap", 1, disk + apart("Translate 39 0 0 " + floor)},
      {"in an object", 1,
       "ObjectBegin \"o\"\n" + floor + apart("Rotate 20 0 0 1 " + decal) + "ObjectEnd\nObjectInstance \"o\"\n"},
  };
  for (const Case& c : cases) {
    const Rendered picture = picture_of(world(c.shapes));
    const auto& said = picture.warnings.all();
    EXPECT_EQ(said.size(), c.warnings) << c.name;
    for (const Diagnostic& d : said) EXPECT_TRUE(d.where.known() && d.other.known()) << c.name << ": " << d.message;
  }
}

}  // namespace
}  // namespace whit
