// How much light each kind of light sends out, as pbrt-v3's Light::Power() has it: what choosing among lights goes by.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/image/write.h"
#include "tests/base/temp_folder.h"
#include "tests/scene/scene_text.h"

namespace whit {
namespace {

constexpr double kSceneRadius = 3;  // of render space

/// The power of the only light of a world, lengths as in render space.
double power_in_render_space(const std::string& light, double& scale) {
  const test::BuiltScene built("WorldBegin\n" + light + "\nWorldEnd\n");
  scale = built.scene->space.scale;
  EXPECT_EQ(built.scene->lights.size(), 1u) << light;
  return built.scene->lights[0].light->power(kSceneRadius);
}

/// Of a light that is somewhere, lengths as in the world.
double power_of(const std::string& light) {
  double scale = 1;
  const double power = power_in_render_space(light, scale);
  return power / (scale * scale);
}

/// Of a light that is all around a disk of the scene's radius, by the area of that.
double power_per_area(const std::string& light) {
  double scale = 1;
  return power_in_render_space(light, scale) / (M_PI * kSceneRadius * kSceneRadius);
}

const std::string kSphere = "Shape \"sphere\" ";

/// A picture of 2 x 2 texels: grey, black; black, black.
std::string quarter_picture(float grey) {
  std::vector<float> pixels(12, 0.0f);
  std::fill_n(pixels.begin(), 3, grey);
  OutputImage picture;
  picture.width = picture.height = 2, picture.rgb = pixels;
  const std::string path = test::temp_folder() + "/quarter.pfm";
  EXPECT_TRUE(write_image(path, picture).ok());
  return path;
}

TEST(LightPower, PointsSendTheirIntensityEverywhere) {
  // 4 pi times the luminance of (1, 2, 3) * 2.
  const double luminance = 2 * (0.212671 + 2 * 0.715160 + 3 * 0.072169);
  EXPECT_NEAR(power_of("LightSource \"point\" \"rgb I\" [1 2 3] \"rgb scale\" [2 2 2] " + kSphere),
              4 * M_PI * luminance, 1e-4);
  EXPECT_NEAR(power_of("LightSource \"goniometric\" \"rgb I\" [1 2 3] \"rgb scale\" [2 2 2] " + kSphere),
              4 * M_PI * luminance, 1e-4);
}

TEST(LightPower, SpotsSendItIntoACone) {
  // pbrt: 2 pi (1 - (cos 25 + cos 30) / 2).
  const double mean = 0.5 * (std::cos(25 * M_PI / 180) + std::cos(30 * M_PI / 180));
  EXPECT_NEAR(power_of("LightSource \"spot\" \"rgb I\" [3 3 3] " + kSphere), 3 * 2 * M_PI * (1 - mean), 1e-5);
}

TEST(LightPower, PicturesCountByTheirMean) {
  const std::string map = "\"string mapname\" \"" + quarter_picture(0.8f) + "\" ";
  EXPECT_NEAR(power_of("LightSource \"goniometric\" " + map + kSphere), 4 * M_PI * 0.2, 1e-5);
  // A square of 90 degrees: its corners are at (1, 1, 1), the cosine of which is 1 / sqrt(3).
  EXPECT_NEAR(power_of("LightSource \"projection\" \"float fov\" 90 " + map + kSphere),
              2 * M_PI * (1 - 1 / std::sqrt(3.0)) * 0.2, 1e-5);
  // Two rows halve the sphere, and the texel is half of one.
  EXPECT_NEAR(power_per_area("LightSource \"infinite\" \"rgb L\" [2 2 2] " + map + kSphere), 2 * 0.2, 1e-5);
}

TEST(LightPower, LightsAtInfinityShineThroughADiskOfTheScene) {
  EXPECT_NEAR(power_per_area("LightSource \"distant\" \"rgb L\" [2 2 2] " + kSphere), 2, 1e-5);
  EXPECT_NEAR(power_per_area("LightSource \"infinite\" \"rgb L\" [2 2 2] " + kSphere), 2, 1e-5);
  // From 0 to 1 along each axis, for each colour.
  EXPECT_NEAR(power_per_area("LightSource \"skybox\" " + kSphere), 0.5, 1e-5);
}

TEST(LightPower, SurfacesSendTheirRadianceByArea) {
  const std::string area = "AreaLightSource \"diffuse\" \"rgb L\" [2 2 2] ";
  const std::string triangle = "Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point P\" [0 0 5  3 0 5  0 4 5] ";
  EXPECT_NEAR(power_of(area + triangle), M_PI * 6 * 2, 1e-4);
  EXPECT_NEAR(power_of("Scale 2 2 2 " + area + triangle), M_PI * 24 * 2, 1e-4);
  const std::string both = "AreaLightSource \"diffuse\" \"bool twosided\" \"true\" \"rgb L\" [2 2 2] ";
  EXPECT_NEAR(power_of(both + triangle), 2 * M_PI * 6 * 2, 1e-4);
  EXPECT_NEAR(power_of(area + kSphere), M_PI * 4 * M_PI * 2, 1e-4);
  EXPECT_NEAR(power_of("Scale 3 3 3 " + area + kSphere), M_PI * 36 * M_PI * 2, 1e-3);
  EXPECT_NEAR(power_of("Scale 3 2 1 " + area + "Shape \"disk\" "), M_PI * 6 * M_PI * 2, 1e-3);
  // A prolate spheroid of half axes 1, 1, 2: 2 pi (1 + 2 asin(e) / e), e = sqrt(3) / 2. By 64 samples.
  const double e = std::sqrt(3.0) / 2, surface = 2 * M_PI * (1 + 2 * std::asin(e) / e);
  EXPECT_NEAR(power_of("Scale 1 1 2 " + area + kSphere), M_PI * surface * 2, 0.01 * M_PI * surface * 2);
}

TEST(LightPower, ColoursOutOfGamutCountByMagnitude) {
  EXPECT_NEAR(power_of("LightSource \"point\" \"rgb I\" [-1 1 0] " + kSphere), 4 * M_PI * (0.212671 + 0.715160), 1e-5);
}

}  // namespace
}  // namespace whit
