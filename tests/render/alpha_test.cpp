// Alpha textures that live in space, not on the surface.
#include <gtest/gtest.h>

#include "core/render/render.h"
#include "tests/scene/scene_text.h"

namespace whit {
namespace {

std::vector<float> picture(const std::string& world) {
  const test::BuiltScene built(
      "Film \"image\" \"integer xresolution\" 32 \"integer yresolution\" 32\n"
      "Sampler \"halton\" \"integer pixelsamples\" 4\nCamera \"orthographic\"\nWorldBegin\n"
      "LightSource \"distant\" \"point from\" [0 0 -1] \"point to\" [0 0 0]\n" +
      world + "\nWorldEnd\n");
  return render(*built.scene, {}).picture.rgb;
}

TEST(Alpha, CutsAnObjectWhereItWasDefined) {
  // Holes of a checkerboard in world units. pbrt-v3 looks them up where the object was defined, so that all of its
  // instances have the same holes.
  const std::string texture =
      "Texture \"holes\" \"float\" \"checkerboard\" \"string mapping\" \"planar\" \"vector v1\" [3 0 0] \"vector v2\" "
      "[0 3 0]\n";
  const std::string sheet =
      "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point P\" [-.9 -.7 0  .8 -.7 0  .8 .9 0  -.9 .9 0] "
      "\"texture alpha\" \"holes\"\n";
  const std::string object = "ObjectBegin \"o\"\n" + sheet + "ObjectEnd\n";
  const auto expected = picture(texture + "Translate 0 0 5\n" + sheet);
  for (const char* placement : {"Translate 0 0 5 ", "Translate 0 0 7 Scale 1 1 3 "}) {
    const auto instance = picture(texture + object + placement + "ObjectInstance \"o\"");
    double difference = 0, sum = 0;
    for (size_t i = 0; i < expected.size(); ++i) {
      difference += std::abs(instance[i] - expected[i]);
      sum += expected[i];
    }
    // A sample or two on the rim of a hole may round to its other side.
    EXPECT_LT(difference, 0.01 * sum) << placement;
  }
}

}  // namespace
}  // namespace whit
