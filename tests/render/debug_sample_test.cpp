// The account of one sample: its numbers are the render's, and it names what the rays met.
#include "core/render/debug_sample.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/render/render.h"
#include "tests/scene/scene_text.h"

namespace whit {
namespace {

constexpr const char* kScene = R"(
Film "image" "integer xresolution" 16 "integer yresolution" 12
Sampler "halton" "integer pixelsamples" 1
Integrator "whitted" "integer maxdepth" 4
LookAt 0 -4 1.5  0 0 0  0 0 1
Camera "perspective" "float fov" 40 "float lensradius" 0.05 "float focaldistance" 4
WorldBegin
LightSource "infinite" "rgb L" [.2 .2 .2]
AttributeBegin
  Translate -2 -2.5 4
  AreaLightSource "diffuse" "rgb L" [60 58 52]
  Shape "sphere" "float radius" 0.5
AttributeEnd
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point P" [-9 -9 -1  9 -9 -1  9 9 -1  -9 9 -1]
Material "glass"
Shape "sphere" "float radius" 0.9
WorldEnd
)";

std::string place(SourcePos where) { return fmt::format("@{}", where.offset); }

TEST(DebugSample, RadianceIsThePicturesPixel) {
  // One sample a pixel and a box filter: the pixel is the sample, to the bit, and nine digits tell floats apart.
  const test::BuiltScene built(kScene);
  const RenderResult picture = render(*built.scene, {});
  for (int y = 0; y < 12; ++y) {
    for (int x = 0; x < 16; ++x) {
      const float* p = &picture.picture.rgb[3 * static_cast<size_t>(16 * y + x)];
      const std::string wanted = fmt::format("radiance [{:.9g} {:.9g} {:.9g}]", p[0], p[1], p[2]);
      const std::string account = debug_sample(*built.scene, {x, y}, 0, place);
      EXPECT_NE(account.find(wanted), std::string::npos) << wanted << " in\n" << account;
    }
  }
}

TEST(DebugSample, NamesWhatARayMeets) {
  const test::BuiltScene built(kScene);
  const std::string text = kScene, account = debug_sample(*built.scene, {8, 6}, 0, place);
  const auto at = [&](const char* statement) { return fmt::format("@{}", text.rfind(statement)); };
  for (const std::string& part :
       {"meets the shape of " + at("Shape \"sphere\""), "material of " + at("Material"),
        std::string("specular reflection, specular transmission"), std::string("sends a refracted ray"),
        std::string("the sky gives [0.2 0.2 0.2]"), "meets the shape of " + at("Shape \"trianglemesh\"")}) {
    EXPECT_NE(account.find(part), std::string::npos) << part << " in\n" << account;
  }
}

TEST(DebugSample, TheOddOneIsTheInvalidOneOrTheBrightest) {
  const auto odd_of = [](const std::string& light) {
    const test::BuiltScene built(
        "Film \"image\" \"integer xresolution\" 1 \"integer yresolution\" 1\n"
        "Sampler \"halton\" \"integer pixelsamples\" 8\nCamera \"orthographic\"\nWorldBegin\n" +
        light + "WorldEnd\n");
    return odd_sample(*built.scene, {0, 0});
  };
  // A sky of negative luminance makes every sample invalid: the first is told.
  EXPECT_EQ(odd_of("LightSource \"infinite\" \"rgb L\" [-9 1 1]\n"), 0u);
  // A glowing disk over the picture's right half, at half the picture's width: the first sample there is the brightest.
  const test::BuiltScene built(
      "Film \"image\" \"integer xresolution\" 1 \"integer yresolution\" 1\n"
      "Sampler \"halton\" \"integer pixelsamples\" 8\nCamera \"orthographic\"\nWorldBegin\n"
      "AreaLightSource \"diffuse\" \"bool twosided\" \"true\" Translate 1 0 1 Shape \"disk\"\nWorldEnd\n");
  const uint32_t odd = odd_sample(*built.scene, {0, 0});
  for (uint32_t i = 0; i <= odd; ++i) {
    const bool bright = debug_sample(*built.scene, {0, 0}, i, place).find("radiance [1 1 1]") != std::string::npos;
    EXPECT_EQ(bright, i == odd) << i;
  }
}

}  // namespace
}  // namespace whit
