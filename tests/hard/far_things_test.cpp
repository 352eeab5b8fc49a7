// Things too far away for floats, or for any number, beside the rest of a scene.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/render/render.h"
#include "core/scene/far.h"
#include "tests/scene/scene_text.h"

namespace whit {
namespace {

struct Outcome {
  std::vector<float> rgb;
  std::string said;
};

/// A ball over a floor, with something else in the world before them.
Outcome picture_with(const std::string& far) {
  test::Planned planned(
      "LookAt 0 0 5  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 40\n"
      "Film \"image\" \"integer xresolution\" 24 \"integer yresolution\" 24\n"
      "Sampler \"halton\" \"integer pixelsamples\" 4\nWorldBegin\n" +
      far +
      "\nLightSource \"point\" \"point from\" [1 2 5] \"rgb I\" [25 25 25]\nShape \"sphere\"\n"
      "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point P\" [-2 -1.1 -2 2 -1.1 -2 2 -1.1 2 -2 -1.1 2]\n"
      "WorldEnd\n");
  const BuiltWorld built = build_world(std::move(planned.world));
  Outcome out;
  for (const Diagnostic& d : built.said.all()) out.said += planned.sources.render_diagnostic(d, false);
  if (built.scene) out.rgb = render_world(built).result.picture.rgb;
  return out;
}

/// Nothing of these is seen where the camera looks: they are to the right of it, or behind all and black.
const std::vector<std::string> kOutOfView{
    "Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point P\" [{0} -1 0  {0} 1 0  {0} 1 1]",
    "Shape \"trianglemesh\" \"integer indices\" [0 1 2 3 4 5] \"point P\" [9 0 0 9 1 0 9 1 1  9 0 0 9 0 1 {0} 0 0]",
    "AttributeBegin Translate {0} 0 0 Shape \"sphere\" AttributeEnd",
    "AttributeBegin Translate {0} 0 0 Shape \"disk\" AttributeEnd",
    "AttributeBegin Material \"matte\" \"rgb Kd\" [0 0 0] Shape \"sphere\" \"float radius\" {0} AttributeEnd",
    "ObjectBegin \"o\" Shape \"sphere\" ObjectEnd AttributeBegin Translate {0} 0 0 ObjectInstance \"o\" AttributeEnd",
    "ObjectBegin \"o\" Translate {0} 0 0 Shape \"sphere\" ObjectEnd ObjectInstance \"o\"",
    "AttributeBegin AreaLightSource \"diffuse\" Translate {0} 0 0 Shape \"sphere\" AttributeEnd",
    "LightSource \"point\" \"point from\" [{0} 0 0] \"rgb I\" [1 1 1]",
    "Shape \"curve\" \"point P\" [9 0 0  9 1 0  9 2 0  {0} 0 0]"};

/// The largest difference; infinity when there is no picture.
double worst_difference(const std::vector<float>& found, const std::vector<float>& right) {
  double worst = found.size() == right.size() ? 0 : INFINITY;
  for (size_t i = 0; i < std::min(found.size(), right.size()); ++i) {
    const double off = std::abs(static_cast<double>(found[i]) - static_cast<double>(right[i]));
    worst = off <= worst ? worst : std::isnan(off) ? INFINITY : off;
  }
  return worst;
}

TEST(Far, TheRestKeepsItsPicture) {
  // To the rounding of floats; what the far lights give at a distance of 1e6 and more is below 1e-11.
  const Outcome without = picture_with("");
  for (const std::string& thing : kOutOfView) {
    for (const char* far : {"1e6", "1e9", "1e12", "1e14", "1e16", "1e20", "1e30"}) {
      const Outcome with = picture_with(fmt::format(fmt::runtime(thing), far));
      EXPECT_LE(worst_difference(with.rgb, without.rgb), 1e-7) << thing << " at " << far << '\n' << with.said;
    }
  }
}

TEST(Far, WhatIsLeftOutIsSaidAtItsPlace) {
  for (const std::string& thing : kOutOfView) {
    const std::string said = picture_with(fmt::format(fmt::runtime(thing), "1e20")).said;
    EXPECT_EQ(said.find("test.pbrt:6:"), 0u) << thing << '\n' << said;
    EXPECT_NE(said.find("1e+20 units away"), std::string::npos) << thing << '\n' << said;
    EXPECT_NE(said.find("left out"), std::string::npos) << thing << '\n' << said;
  }
}

TEST(Far, ATriangleThatIsSeenIsRightWithACornerAnywhere) {
  // Corners at 1e5 and 1e14 in one direction: on the film their edges differ by less than 1e-4 pixels.
  const auto with = [](const char* far) {
    return picture_with(fmt::format(
        "Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point P\" [.5 .5 -3  1 .5 -3  {0} {0} -3]", far));
  };
  const Outcome near = with("1e5"), without = picture_with("");
  EXPECT_GT(worst_difference(near.rgb, without.rgb), 1e-3);
  for (const char* far : {"1e8", "1e12", "1e14"}) { EXPECT_LE(worst_difference(with(far).rgb, near.rgb), 1e-3) << far; }
}

TEST(Far, WhereAllIsFarAllIsKept) {
  // The same world, larger.
  Horizon horizon;
  for (const double extent : {1e20, 3e20, 1e30}) horizon.add(extent);
  EXPECT_EQ(horizon.limit(), 1e35);
  // Something at the camera is no reason to leave out a world of ordinary size.
  horizon.add(1e-30);
  EXPECT_EQ(horizon.limit(), 1e15);
}

}  // namespace
}  // namespace whit
