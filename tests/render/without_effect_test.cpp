// An effect that is switched off is off: the picture is that of a scene that never asked for it.
#include <gtest/gtest.h>

#include "tests/hard/render_text.h"

namespace whit {
namespace {

using namespace test;

/// Two worlds (and options) that show the same, once `off` is off in the first.
struct Pair {
  Effect off;
  std::string with, without;
  std::string options_with = "Camera \"perspective\"\n", options_without = "Camera \"perspective\"\n";
};

const std::string kMesh =
    "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] "
    "\"point P\" [-2 -2 1  2 -2 1  2 2 1  -2 2 1] \"float uv\" [0 0 1 0 1 1 0 1] ";
const std::string kChecks = "Texture \"c\" \"spectrum\" \"checkerboard\" \"float uscale\" 8 \"float vscale\" 8 ";
const std::string kBumps = "Texture \"b\" \"float\" \"windy\" ";
const std::string kMask = "Texture \"a\" \"float\" \"checkerboard\" \"float uscale\" 4 \"float vscale\" 4 ";
const std::string kMove = "ActiveTransform EndTime Translate 1 0 0 ActiveTransform All ";
const std::string kSky = "LightSource \"skybox\" ";
const std::string kObject = "ObjectBegin \"o\" Shape \"disk\" \"float radius\" 2 ObjectEnd ";

std::vector<Pair> pairs() {
  return {
      {Effect::Diffuse, "Material \"plastic\"", "Material \"plastic\" \"rgb Kd\" [0 0 0]"},
      {Effect::Glossy, "Material \"plastic\"", "Material \"plastic\" \"rgb Ks\" [0 0 0]"},
      {Effect::Reflection, kSky + "Material \"glass\"", kSky + "Material \"glass\" \"rgb Kr\" [0 0 0]"},
      {Effect::Refraction, kSky + "Material \"glass\"", kSky + "Material \"glass\" \"rgb Kt\" [0 0 0]"},
      {Effect::AreaLights, "AreaLightSource \"diffuse\"", ""},
      {Effect::EnvironmentLights, "LightSource \"skybox\"", ""},
      {Effect::DeltaLights, "LightSource \"spot\" \"point from\" [0 0 -3]", ""},
      {Effect::Textures, kChecks + "Material \"matte\" \"texture Kd\" \"c\"", ""},
      {Effect::TextureFiltering, kChecks + "Material \"matte\" \"texture Kd\" \"c\"",
       kChecks.substr(0, kChecks.size() - 1) + " \"string aamode\" \"none\" Material \"matte\" \"texture Kd\" \"c\""},
      {Effect::Bump, kBumps + "Material \"matte\" \"texture bumpmap\" \"b\"", ""},
      {Effect::Bump, "Material \"metallicroughness\" \"rgb normalmap\" [0.7 0.4 0.9]",
       "Material \"metallicroughness\""},
      {Effect::Alpha, kMask + kMesh + "\"texture alpha\" \"a\"", kMesh},
      // The shutter opens a quarter of the way.
      {Effect::MotionBlur, "AttributeBegin " + kMove + kMesh + " AttributeEnd",
       "AttributeBegin Translate 0.25 0 0 " + kMesh + " AttributeEnd",
       "Camera \"perspective\" \"float shutteropen\" 0.25\n", "Camera \"perspective\"\n"},
      // In focus at 1, so that the same numbers are multiplied with 1.
      {Effect::DepthOfField, "", "", "Camera \"perspective\" \"float lensradius\" 0.3 \"float focaldistance\" 1\n",
       "Camera \"perspective\"\n"},
      {Effect::Instancing, kObject + "ObjectInstance \"o\"", ""},
      {Effect::Interfaces, "AttributeBegin Material \"none\" Translate 0 0 -2.5 " + kMesh + "AttributeEnd", ""},
  };
}

std::string scene(const std::string& world, const std::string& options) {
  return "Film \"image\" \"integer xresolution\" 48 \"integer yresolution\" 48\nSampler \"halton\" \"integer "
         "pixelsamples\" 4\nTranslate 0 0 3\n" +
         options + "WorldBegin\nLightSource \"distant\" \"point from\" [1 2 -3] \"rgb L\" [1 1 1]\n" + world +
         "\nShape \"sphere\"\nWorldEnd\n";
}

std::vector<float> picture(const std::string& text, const EffectSet& off) {
  return Rendered(text, {}, {}, Planned::Warnings::Failures, {.off = off}).rgb();
}

TEST(WithoutEffect, IsTheSceneThatNeverAskedForIt) {
  EffectSet tried;
  for (const Pair& p : pairs()) {
    // The other light is a delta light, so that it goes too where these are off.
    const EffectSet off{p.off};
    const std::string with = scene(p.with, p.options_with), without = scene(p.without, p.options_without);
    const std::vector<float> expected = picture(without, p.off == Effect::DeltaLights ? off : EffectSet{});
    EXPECT_EQ(picture(with, off), expected) << effect_name(p.off);
    const PlanOptions check{.off = off, .everything_on = true};
    EXPECT_EQ(Rendered(with, {}, {}, Planned::Warnings::Failures, check).rgb(), expected) << effect_name(p.off);
    EXPECT_NE(picture(with, {}), expected) << effect_name(p.off) << " changes nothing, and shows nothing";
    tried.add(p.off);
  }
  // Shadows are below. Without indirect light, lights are sampled where sampled directions would have found them, too:
  // the same mean, in tests/integrators.
  EXPECT_EQ(EffectSet::all() - tried, (EffectSet{Effect::Shadows, Effect::Indirect}));
}

TEST(WithoutEffect, NestedTexturesAreNotFoldedIntoWhatTheyAreMadeOf) {
  const std::string scaled = kChecks +
                             "Texture \"s\" \"spectrum\" \"scale\" \"texture tex1\" \"c\" \"rgb tex2\" [1 0 0] "
                             "Material \"matte\" \"texture Kd\" \"s\"";
  const std::string pinhole = "Camera \"perspective\"\n";
  EXPECT_EQ(picture(scene(scaled, pinhole), {Effect::Textures}), picture(scene("", pinhole), {}));
}

TEST(WithoutEffect, BumpsKeepTheNormalsOwnChangeWithoutFiltering) {
  // On a sphere a displacement of 5 to 7 turns normals less than one of 0 to 2, the surface being farther out.
  const auto bumps = [](double low) {
    std::string text = "Texture \"b\" \"float\" \"bilerp\"";
    for (const char* corner : {"v00", "v01"}) text += " \"float " + std::string(corner) + "\" " + std::to_string(low);
    for (const char* corner : {"v10", "v11"})
      text += " \"float " + std::string(corner) + "\" " + std::to_string(low + 2);
    return scene(text + " Material \"matte\" \"texture bumpmap\" \"b\"", "Camera \"perspective\"\n");
  };
  EXPECT_NE(picture(bumps(0), {Effect::TextureFiltering}), picture(bumps(5), {Effect::TextureFiltering}));
}

TEST(WithoutEffect, LightPassesThroughEverythingWithoutShadows) {
  // A floor in the light of a lamp straight above that a disk, out of sight, is in the way of.
  const std::string options = "LookAt 0 0 1  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 20\n";
  const std::string floor = "LightSource \"point\" \"point from\" [0 0 4]\nShape \"disk\" \"float radius\" 3\n";
  const auto world = [&](const std::string& more) {
    return "Film \"image\" \"integer xresolution\" 16 \"integer yresolution\" 16\n" + options + "WorldBegin\n" + floor +
           more + "WorldEnd\n";
  };
  const std::string blocked = world("Translate 0 0 2 Shape \"disk\" \"float radius\" 2\n");
  EXPECT_EQ(picture(blocked, {Effect::Shadows}), picture(world(""), {}));
  const std::vector<float> dark = picture(blocked, {});
  EXPECT_EQ(*std::max_element(dark.begin(), dark.end()), 0);
}

}  // namespace
}  // namespace whit
