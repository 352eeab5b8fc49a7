// Behind an interface (a surface of material "none") rays have no differentials: textures are looked up at points there,
// noise has all its octaves, and bump maps take a step of 0.0005.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/channels.h"
#include "tests/hard/render_text.h"

namespace whit {
namespace {

using namespace test;

const std::string kCamera = R"(
LookAt 0 -5 2  0 0 .8  0 0 1
Camera "perspective" "float fov" 30
Film "image" "integer xresolution" 60 "integer yresolution" 60
)";
const std::string kRoom = R"(
LightSource "point" "rgb I" [34 40 44] "point from" [3 -4.5 5]
LightSource "distant" "rgb L" [.7 .55 .4] "point from" [-4 -2 3.5] "point to" [0 0 0]
Material "matte" "rgb Kd" [.6 .6 .65]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point P" [-3 3 0 3 3 0 3 3 5 -3 3 5]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point P" [-6 -6 0 6 -6 0 6 6 0 -6 6 0]
)";
const std::string kTextures = R"(
Texture "w" "float" "wrinkled" "integer octaves" 4
Texture "f" "float" "fbm" "integer octaves" 4
Texture "wind" "float" "windy"
Texture "checks" "float" "checkerboard" "float uscale" 16 "float vscale" 8 "float tex1" 0 "float tex2" .2
Texture "b" "float" "scale" "texture tex1" "w" "float tex2" .12
Texture "bf" "float" "scale" "texture tex1" "f" "float tex2" .12
Texture "bw" "float" "scale" "texture tex1" "wind" "float tex2" .05
Texture "wc" "spectrum" "wrinkled"
Texture "fc" "spectrum" "fbm"
Texture "m" "spectrum" "marble"
)";
// Just before the camera: it covers the view, and no shadow of it falls on what is seen.
const std::string kInterface = R"(
AttributeBegin
  Material "none"
  Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point P" [-.2 -4.7 1.7 .2 -4.7 1.7 .2 -4.7 2.1 -.2 -4.7 2.1]
AttributeEnd
)";
const std::string kBall = "Translate 0 0 1 Shape \"sphere\"\n";

TEST(Interface, BumpsBehindItAreAsThoseOfPbrt) {
  // pbrt-v3, mean of four samplers at 64 samples: rows and columns 15 to 44 have 0.0446 0.0450 0.0477, within 0.2 %. One
  // sampler's own mean deviates from that by 0.4 % at most.
  const Rendered r(kCamera +
                   "Sampler \"halton\" \"integer pixelsamples\" 64 "
                   "Integrator \"whitted\" \"integer maxdepth\" 4 WorldBegin" +
                   kRoom + kTextures + R"(
    Material "none"
    Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point P" [-3 -2 0.2 3 -2 0.2 3 -2 3.5 -3 -2 3.5]
    Material "mirror" "texture bumpmap" "b"
    Translate 0 0 1 Shape "sphere" WorldEnd)");
  Vec3d sum(0.0);
  for (int y = 15; y < 45; ++y) {
    for (int x = 15; x < 45; ++x) sum += channels(r.pixel(x, y));
  }
  const Vec3d expected(0.0446, 0.0450, 0.0477);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c] / 900 / expected[c], 1, 4e-3) << c;
}

TEST(Interface, BehindItNothingHasAFootprint) {
  // The same picture as without the interface and without differentials anywhere. The hit points differ by roundings of
  // 1e-7, which a step of 0.0005 makes 2e-4 of a slope; what bumpy glass refracts moves by more.
  const std::vector<std::string> balls = {
      "Material \"mirror\" \"texture bumpmap\" \"b\"" + kBall, "Material \"mirror\" \"texture bumpmap\" \"bf\"" + kBall,
      "Material \"glass\" \"texture bumpmap\" \"b\"" + kBall,
      "Material \"perfectglass\" \"texture bumpmap\" \"bf\"" + kBall,
      "Material \"matte\" \"texture Kd\" \"wc\" \"texture bumpmap\" \"bf\"" + kBall,
      "Material \"matte\" \"texture Kd\" \"fc\" \"texture bumpmap\" \"bw\"" + kBall,
      "Material \"matte\" \"texture Kd\" \"m\" \"texture bumpmap\" \"checks\"" + kBall,
      "Material \"mirror\" \"texture bumpmap\" \"b\" ObjectBegin \"ball\" Shape \"sphere\" ObjectEnd\n"
      "Translate 0 0 1 Scale 1 .8 1.1 Rotate 30 1 2 3 ObjectInstance \"ball\"\n",
      // What is seen through glass has differentials, but not where the glass is behind an interface.
      "Material \"perfectglass\" AttributeBegin Translate 0 -1.5 1.1 Shape \"sphere\" \"float radius\" .6 "
      "AttributeEnd\n"
      "Material \"matte\" \"texture Kd\" \"wc\" \"texture bumpmap\" \"b\"" +
          kBall};
  const std::string head = kCamera + "Sampler \"halton\" \"integer pixelsamples\" 16 WorldBegin" + kRoom + kTextures;
  PlanOptions no_differentials;
  no_differentials.off = {Effect::TextureFiltering};
  for (const std::string& ball : balls) {
    const Rendered behind(head + kInterface + ball + " WorldEnd");
    const Rendered bare(head + ball + " WorldEnd", {}, {}, Planned::Warnings::Failures, no_differentials);
    EXPECT_LT(relative_mse(behind.rgb(), bare.rgb()), 1e-4) << ball;
  }
}

}  // namespace
}  // namespace whit
